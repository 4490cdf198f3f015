#include "talus/base/memory_reserve.h"

#include <atomic>
#include <cstdlib>
#include <new>

namespace talus {

namespace {

std::atomic<void*> kept{nullptr};  // NOLINT: a new-handler finds nothing else
std::atomic<bool> used{false};     // NOLINT

void give_back() {
  void* reserve = kept.exchange(nullptr);
  if (!reserve) throw std::bad_alloc();
  used = true;
  std::free(reserve);
}

}  // namespace

void keep_memory_reserve(size_t bytes) {
  void* reserve = std::malloc(bytes);
  if (!reserve) throw std::bad_alloc();
  std::free(kept.exchange(reserve));
  std::set_new_handler(give_back);
}

bool memory_is_short() noexcept { return used; }

}  // namespace talus
