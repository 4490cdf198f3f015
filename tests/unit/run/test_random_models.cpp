// Small models of any kind, run for some steps with the audit on: refused, run, or failed with a reason; never a
// signal, an assertion, or a number that is none. (Assertions and memory are watched in the sanitizer build.)

#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>

#include "support/random_model.h"
#include "talus/results/auditor.h"
#include "talus/talus.h"

namespace test_random_models {

using namespace talus;
using namespace talus::test;

namespace {

class Audited : public Observer {
 public:
  Audited(const Scene& scene, int steps) : auditor_(scene), left_(steps) {}
  void at(const Instant& i) override {
    auditor_.at(i, i.stage_start || i.last || left_ % 10 == 0);
    for (const Vec2& d : i.state.displacement) finite = finite && is_finite(d);
  }
  bool stop() override { return left_-- <= 0; }
  audit::Report report() const { return auditor_.report(); }
  bool finite = true;

 private:
  Auditor auditor_;
  int left_;
};

struct Count {
  int refused = 0, run = 0, failed = 0, not_valid = 0;
};

void try_model(uint64_t seed, Count& count) {
  const std::string text = RandomModel(test::Choices::from_seed(seed)).text();
  INFO("seed ", seed, "\n", text);
  try {
    Findings findings("m.toml", text);
    PreparedRun p = prepare_run("m.toml", text, {}, findings);
    State state = start_state(p.scene);
    Audited observer(p.scene, 50);
    const RunResult r = run_stages(p.scene, p.plans, state, observer);
    CHECK((observer.finite || !r.failure.empty()));
    count.failed += !r.failure.empty();
    count.run += r.failure.empty();
    const bool invalid = !observer.report().valid();
    if (invalid && r.failure.empty() && std::getenv("TALUS_SHOW_INVALID"))
      for (const std::string& line : observer.report().lines(p.scene.blocks.name)) MESSAGE(seed, ": ", line);
    count.not_valid += invalid && r.failure.empty();
  } catch (const InputError& e) {
    ++count.refused;
    if (std::getenv("TALUS_SHOW_REFUSED")) MESSAGE(seed, ": ", std::string(e.what()).substr(0, 300));
  }
}

void try_models(uint64_t first, int models) {
  Count count;
  for (int i = 0; i < models; ++i) CHECK_NOTHROW(try_model(first + static_cast<uint64_t>(i), count));
  MESSAGE(models, " models: ", count.refused, " refused, ", count.run, " run, ", count.failed,
          " failed with a reason, ", count.not_valid, " of those run not valid");
  CHECK(count.run > models / 3);
}

}  // namespace

TEST_CASE("random models run or say why not") { try_models(1, 60); }

TEST_SUITE("long: models") {
  TEST_CASE("random models: ten thousand") { try_models(100000, 10000); }
}

}  // namespace test_random_models
