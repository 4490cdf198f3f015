// Preloaded into the program by tests/command/test_faults.cpp: lets the n-th call of one kind fail, as a full disk, a
// lost network drive or a machine without memory would. TALUS_FAULT is KIND:N; what was done is told in the file
// TALUS_FAULT_TOLD. With TALUS_FAULT_COUNT, a file of eight bytes, all processes count together, and of kind "every" each n-th
// write fails, as on a disk that is full now and then. Of the kind "moved" the n-th rename finds the folder out/ moved away.

#include <dlfcn.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <stdarg.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>

namespace {

struct Fault {
  char kind[16] = "";
  long n = 0;
  const char* told = nullptr;
  std::atomic<long>* shared = nullptr;  // count of all processes

  Fault() {
    const char* text = std::getenv("TALUS_FAULT");
    if (text) std::sscanf(text, "%15[a-z]:%ld", kind, &n);
    told = std::getenv("TALUS_FAULT_TOLD");
    if (const char* count = std::getenv("TALUS_FAULT_COUNT")) {
      const auto file = static_cast<int>(syscall(SYS_openat, AT_FDCWD, count, O_RDWR));
      void* place = mmap(nullptr, sizeof(long), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
      if (place != MAP_FAILED) shared = static_cast<std::atomic<long>*>(place);
      syscall(SYS_close, file);
    }
  }
};

const Fault& fault() {
  static const Fault one;
  return one;
}

// Whether this call of the kind is the one that fails.
bool fails(const char* kind, std::atomic<long>& count) {
  const Fault& f = fault();
  const bool every = std::strcmp(f.kind, "every") == 0 && std::strcmp(kind, "write") == 0;
  if (std::strcmp(f.kind, kind) != 0 && !every) return false;
  const long number = f.shared ? ++*f.shared : ++count;
  if (every ? number % f.n != 0 : number != f.n) return false;
  if (f.told) {
    const auto file =
        static_cast<int>(syscall(SYS_openat, AT_FDCWD, f.told, O_WRONLY | O_CREAT | O_TRUNC, 0666));
    syscall(SYS_write, file, kind, std::strlen(kind));
    syscall(SYS_close, file);
  }
  return true;
}

// From mallopt() on, which main() calls first: what fails before there is nobody to tell of.
std::atomic<bool> begun{false};
std::atomic<long> writes{0}, renames{0}, syncs{0}, opens{0}, allocations{0}, bare_allocations{0}, threads{0};

template <class F>
F next(const char* name) {
  return reinterpret_cast<F>(dlsym(RTLD_NEXT, name));
}

int no(int error) {
  errno = error;
  return -1;
}

}  // namespace

extern "C" {

ssize_t write(int file, const void* bytes, size_t size) {
  if (file > 2 && fails("kill", writes)) {  // a process that is killed there
    if (size > 1) syscall(SYS_write, file, bytes, size / 2);
    syscall(SYS_kill, getpid(), SIGKILL);
  }
  if (file > 2 && fails("write", writes)) {
    // half of it arrives, as on a disk that fills; then nothing
    if (size > 1) return syscall(SYS_write, file, bytes, size / 2), no(ENOSPC);
    return no(ENOSPC);
  }
  return syscall(SYS_write, file, bytes, size);
}

ssize_t pwrite64(int file, const void* bytes, size_t size, off64_t at) {
  if (fails("write", writes)) return no(ENOSPC);
  return syscall(SYS_pwrite64, file, bytes, size, at);
}
ssize_t pwrite(int file, const void* bytes, size_t size, off_t at) { return pwrite64(file, bytes, size, at); }

int mallopt(int, int) noexcept {
  begun = true;
  return 1;
}

int rename(const char* from, const char* to) noexcept {
  if (fails("rename", renames)) return no(EIO);
  if (fails("moved", renames)) syscall(SYS_rename, "out", "moved");
  return static_cast<int>(syscall(SYS_rename, from, to));
}

int fsync(int file) {
  if (fails("sync", syncs)) return no(EIO);
  return static_cast<int>(syscall(SYS_fsync, file));
}

int syncfs(int file) noexcept {
  if (fails("sync", syncs)) return no(EIO);
  return static_cast<int>(syscall(SYS_syncfs, file));
}

// only files that are to be written: what libraries read for themselves is theirs
int open64(const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = (flags & O_CREAT) != 0 ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  if ((flags & O_ACCMODE) != O_RDONLY && fails("open", opens)) return no(EMFILE);
  return static_cast<int>(syscall(SYS_openat, AT_FDCWD, path, flags, mode));
}
int open(const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = (flags & O_CREAT) != 0 ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  return open64(path, flags, mode);
}

int pthread_create(pthread_t* thread, const pthread_attr_t* how, void* (*start)(void*),
                   void* given) noexcept {
  if (fails("thread", threads)) return EAGAIN;
  static const auto create = next<decltype(&pthread_create)>("pthread_create");
  return create(thread, how, start, given);
}

}  // extern "C"

void* operator new(size_t size) {
  // as the language has it: who keeps memory back gives it now; "bare": as if nobody did
  if (begun && fails("new", allocations)) {
    const std::new_handler handler = std::get_new_handler();
    if (!handler) throw std::bad_alloc();
    handler();
  }
  if (begun && fails("bare", bare_allocations)) throw std::bad_alloc();
  if (void* p = std::malloc(size == 0 ? 1 : size)) return p;
  throw std::bad_alloc();
}
void* operator new[](size_t size) { return operator new(size); }
void operator delete(void* p) noexcept { std::free(p); }
void operator delete[](void* p) noexcept { std::free(p); }
void operator delete(void* p, size_t) noexcept { std::free(p); }
void operator delete[](void* p, size_t) noexcept { std::free(p); }
