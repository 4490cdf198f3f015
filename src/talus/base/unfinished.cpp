#include "talus/base/unfinished.h"

#include <unistd.h>

#include <array>
#include <atomic>
#include <climits>
#include <cstring>

#include "talus/base/index.h"

namespace talus {

namespace {

enum Use : int { kFree, kFilling, kNoted };

struct Slot {
  std::atomic<int> use{kFree};
  char path[PATH_MAX] = {};
};

std::array<Slot, 8> slots;  // NOLINT: a signal handler finds nothing else
static_assert(std::atomic<int>::is_always_lock_free);

}  // namespace

Unfinished::Unfinished(const std::string& path) {
  if (path.size() >= PATH_MAX) return;
  for (int i = 0; i < count_of(slots); ++i) {
    int free = kFree;
    if (!slots[i].use.compare_exchange_strong(free, kFilling)) continue;
    std::memcpy(slots[i].path, path.c_str(), path.size() + 1);
    slots[i].use = kNoted;
    slot_ = i;
    return;
  }
}

Unfinished::~Unfinished() {
  if (slot_ >= 0) slots[slot_].use = kFree;
}

void remove_unfinished() noexcept {
  for (Slot& slot : slots)
    if (slot.use == kNoted) unlink(slot.path);
}

}  // namespace talus
