// What rows of hard contacts ask for where nothing gives: overlaps and places within half the slop are left.

#include "support/relative.h"
#include "talus/contact/hard_contact.h"

#include <doctest/doctest.h>

namespace test_hard_contact {

using namespace talus;

TEST_CASE("hard contact: a gap may close and no more, an overlap is left at half the slop") {
  const double slop = 1e-6, dt = 1e-3;
  CHECK(hard_gap_bias(2e-6, slop, dt) == test::approx(2e-3));
  CHECK(hard_gap_bias(-0.4e-6, slop, dt) == 0);  // it stays closed, so that it goes on bearing
  CHECK(hard_gap_bias(-2e-6, slop, dt) == test::approx(-1.5e-3));
}

TEST_CASE("hard contact: of two places that stick at one, the half slop between them is nobody's") {
  const double slop = 1e-6;
  // two corners at one place, off by rounding to either side: no motion brings both home
  CHECK(beyond_slop(0.3e-6, slop) == 0);
  CHECK(beyond_slop(-0.3e-6, slop) == 0);
  // what slides on is followed without a jump
  CHECK(beyond_slop(0.5e-6 + 1e-12, slop) == test::approx(1e-12).epsilon(1e-3));
  CHECK(beyond_slop(-2e-6, slop) == test::approx(-1.5e-6));
}

}  // namespace test_hard_contact
