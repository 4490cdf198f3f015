// Runs a model and reports, at the end of every tenth of it, the largest overlap between two blocks: whether
// anything has passed through anything. Usage: overlaps MODEL [PATH=VALUE ...]     overrides as with talus
// run --set

#include <fmt/format.h>

#include "support/overlap.h"
#include "talus/schema/toml_source.h"

namespace {

class OverlapWatch : public talus::Observer {
 public:
  void at(const talus::Instant& now) override {
    const auto tenth = std::max<int64_t>(1, now.plan.steps / 10);
    if (!now.last && now.state.step % tenth != 0) return;
    const auto largest = talus::test::largest_overlap(now.scene.blocks, now.state);
    fmt::print("t = {:8.5f} s   largest overlap {:.3e} of the smaller block ({})\n", now.state.time,
               largest.share, largest.between);
    std::fflush(stdout);
  }
};

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    fmt::print(stderr, "usage: overlaps MODEL [PATH=VALUE ...]\n");
    return 2;
  }
  try {
    const std::string text = talus::read_text_file(argv[1]);
    talus::Findings findings(argv[1], text);
    talus::PreparedRun run =
        talus::prepare_run(argv[1], text, std::vector<std::string>(argv + 2, argv + argc), findings);
    talus::State state = talus::start_state(run.scene);
    OverlapWatch watch;
    const talus::RunResult result = talus::run_stages(run.scene, run.plans, state, watch);
    fmt::print(
        "{} blocks, {} steps, {:.1f} s, {} failed steps, {} loose, energy left over {:.1e} of the largest term\n",
        run.scene.blocks.count, result.steps, result.wall_seconds, result.failed_steps, result.loose_steps,
        result.closure());
    return result.failure.empty() ? 0 : 1;
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 1;
  }
}
