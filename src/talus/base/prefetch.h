#pragma once
// Asking for memory before it is needed.

namespace talus {

/// Asks for the cache line at `there`, which is going to be read, and may be written.
inline void prefetch(const void* there) {
  __builtin_prefetch(there);
  // gcc takes a function that does nothing but this for one without effect, and drops every call of it
  asm volatile("");
}

/// The lines of an object, which need not begin where one does.
template <class T>
void prefetch_all(const T& object) {
  constexpr unsigned kLine = 64;
  const char* there = reinterpret_cast<const char*>(&object);
  for (unsigned at = 0; at < sizeof(T); at += kLine) prefetch(there + at);
  prefetch(there + sizeof(T) - 1);
}

}  // namespace talus
