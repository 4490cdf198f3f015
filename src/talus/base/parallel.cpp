#include "talus/base/parallel.h"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace talus {

struct Workers::Team {
  // the library starts no more threads than the machine has processors unless it is told to: a run asked for
  // four threads on two processors gets four
  explicit Team(int threads)
      : limit(tbb::global_control::max_allowed_parallelism, static_cast<size_t>(threads)), arena(threads) {}

  tbb::global_control limit;
  tbb::task_arena arena;
};

Workers::Workers(int threads) {
  if (threads == 0) threads = tbb::info::default_concurrency();
  if (threads > 1) team_ = std::make_shared<Team>(threads);
}

int Workers::threads() const { return team_ ? team_->arena.max_concurrency() : 1; }

void Workers::run(size_t count, const std::function<void(size_t)>& task) const {
  if (!team_ || count <= 1) {
    for (size_t i = 0; i < count; ++i) task(i);
    return;
  }
  team_->arena.execute([&] { tbb::parallel_for(size_t{0}, count, task); });
}

}  // namespace talus
