#include <talus/talus.h>

#include <cstdio>
#include <fstream>
#include <iterator>

// Steps of a model, and how far its last block has come: fall MODEL
struct Nobody : talus::Observer {
  void at(const talus::Instant&) override {}
};

int main(int, char** arguments) {
  try {
    std::ifstream file(arguments[1]);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    talus::Findings findings(arguments[1], text);
    talus::PreparedRun run = talus::prepare_run(arguments[1], text, {}, findings);
    talus::State state = talus::start_state(run.scene);
    Nobody nobody;
    const talus::RunResult result = talus::run_stages(run.scene, run.plans, state, nobody);
    std::printf("%lld steps, %.17g m\n", static_cast<long long>(result.steps),
                norm(state.displacement.back()));
  } catch (const talus::Error& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return e.code();
  }
}
