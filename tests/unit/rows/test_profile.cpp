// Parts of a profile: every moment belongs to one of them.

#include <doctest/doctest.h>

#include <chrono>
#include <thread>

#include "talus/rows/profile.h"

namespace test_profile {

using namespace talus;

namespace {

constexpr double kNap = 0.005;  // [s]; a nap never ends early

void nap() { std::this_thread::sleep_for(std::chrono::duration<double>(kNap)); }

}  // namespace

TEST_CASE("profile: a part within a part has its own time, and all sum to the whole") {
  Profile p;
  nap();  // before: nobody's
  const double begin = wall_now();
  {
    const InPart rest(p, Profile::kRest);
    nap();
    {
      const InPart rows(p, Profile::kRows);
      nap();
      p.go_on_with(Profile::kBolts);
      nap(), nap();
    }
    nap();
  }
  const double whole = wall_now() - begin;
  nap();  // after: nobody's
  CHECK(p.seconds[Profile::kRest] >= 2 * kNap);
  CHECK(p.seconds[Profile::kRows] >= kNap);
  CHECK(p.seconds[Profile::kBolts] >= 2 * kNap);
  CHECK(p.seconds[Profile::kRest] + p.seconds[Profile::kRows] + p.seconds[Profile::kBolts] == p.total());
  CHECK(p.total() <= whole);
  CHECK(p.total() >= 5 * kNap);
  p.move(Profile::kRest, Profile::kSearch, kNap);
  CHECK(p.seconds[Profile::kSearch] == kNap);
  CHECK(p.total() <= whole + 1e-15);
}

}  // namespace test_profile
