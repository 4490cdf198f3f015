#include "talus/base/random.h"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <vector>

namespace test_random {

using namespace talus;

namespace {

constexpr int kDraws = 200000;

// Bounds are this many standard errors wide: chance exceeds one of them in 2 of a million tries, and the
// seeds are fixed.
constexpr double kErrors = 4.8;

struct Sample {
  std::vector<double> x;

  double mean(const std::function<double(double)>& of) const {
    double sum = 0;
    for (const double v : x) sum += of(v);
    return sum / static_cast<double>(x.size());
  }
};

Sample sample(const std::function<double()>& draw) {
  Sample s;
  for (int i = 0; i < kDraws; ++i) s.x.push_back(draw());
  return s;
}

// The mean of `of` is `exact` within the error that its variance allows.
void check_mean(const Sample& s, const std::function<double(double)>& of, double exact, double variance) {
  CHECK(std::abs(s.mean(of) - exact) < kErrors * std::sqrt(variance / kDraws));
}

// Numbers in [0, 1) fill a hundred bins evenly: the squared deviations sum to 99 with variance 2 x 99.
void check_even(const std::vector<double>& x) {
  std::vector<int> count(100, 0);
  for (const double v : x) {
    REQUIRE(v >= 0);
    REQUIRE(v < 1);
    ++count[static_cast<size_t>(v * 100)];
  }
  const double expected = static_cast<double>(x.size()) / 100;
  double sum = 0;
  for (const int n : count) sum += (n - expected) * (n - expected) / expected;
  CHECK(std::abs(sum - 99) < kErrors * std::sqrt(2.0 * 99));
}

// The mean product of two series of variance 1/12 about 1/2 is zero, with variance 1/144 per term.
void check_unrelated(const std::vector<double>& a, const std::vector<double>& b) {
  const size_t n = std::min(a.size(), b.size());
  double sum = 0;
  for (size_t i = 0; i < n; ++i) sum += (a[i] - 0.5) * (b[i] - 0.5);
  CHECK(std::abs(sum) < kErrors / 12 * std::sqrt(static_cast<double>(n)));
}

std::vector<double> uniforms(uint64_t seed, int n = kDraws) {
  Random random(seed);
  std::vector<double> out;
  for (int i = 0; i < n; ++i) out.push_back(random.uniform());
  return out;
}

}  // namespace

TEST_CASE("random: the numbers are those of splitmix64") {
  Random random(1234567);
  for (const uint64_t value : {6457827717110365317u, 3203168211198807973u, 9817491932198370423u,
                               4593380528125082431u, 16408922859458223821u})
    CHECK(random.next() == value);
}

TEST_CASE("random: uniform numbers are even, unrelated to the next, and multiples of 2^-53") {
  const std::vector<double> x = uniforms(1);
  check_even(x);
  for (size_t lag : {1u, 2u, 7u})
    check_unrelated(x, std::vector<double>(x.begin() + static_cast<int>(lag), x.end()));
  for (const double v : x) CHECK(std::fmod(v * 0x1p53, 1.0) == 0);
  const Sample s{x};
  check_mean(
      s, [](double v) { return v; }, 0.5, 1.0 / 12);
  check_mean(
      s, [](double v) { return (v - 0.5) * (v - 0.5); }, 1.0 / 12, 1.0 / 180);
}

TEST_CASE("random: normal numbers have the moments of the normal distribution") {
  Random random(2);
  const Sample s = sample([&] { return random.normal(); });
  check_mean(
      s, [](double v) { return v; }, 0, 1);
  check_mean(
      s, [](double v) { return v * v; }, 1, 2);  // E v^4 - 1
  check_mean(
      s, [](double v) { return v * v * v; }, 0, 15);  // E v^6
  check_mean(
      s, [](double v) { return v * v * v * v; }, 3, 96);  // E v^8 - 9
  const double p = std::erf(1 / std::sqrt(2.0));
  check_mean(
      s, [](double v) { return std::abs(v) < 1; }, p, p * (1 - p));
}

TEST_CASE("random: exponential numbers have mean and deviation 1") {
  Random random(3);
  const Sample s = sample([&] { return random.exponential(); });
  for (const double v : s.x) REQUIRE(v >= 0);
  check_mean(
      s, [](double v) { return v; }, 1, 1);
  check_mean(
      s, [](double v) { return v * v; }, 2, 20);  // E v^4 - 4
  const double p = std::exp(-2.0);
  check_mean(
      s, [](double v) { return v > 2; }, p, p * (1 - p));
}

TEST_CASE("random: streams of other seeds, names and numbers are unrelated") {
  const uint64_t seeds[] = {stream_seed(1, "set-a"),     stream_seed(1, "set-b"),
                            stream_seed(2, "set-a"),     stream_seed(1, "set-a", 1),
                            stream_seed(1, "set-a", -1), stream_seed(1, "set-a", 2),
                            stream_seed(1, "set-a#"),    stream_seed(1, "")};
  std::vector<std::vector<double>> streams;
  for (const uint64_t seed : seeds) streams.push_back(uniforms(seed, kDraws / 10));
  for (size_t i = 0; i < streams.size(); ++i) {
    check_even(streams[i]);
    for (size_t j = 0; j < i; ++j) {
      CHECK(streams[i][0] != streams[j][0]);
      check_unrelated(streams[i], streams[j]);
    }
  }
  CHECK(stream_seed(7, "rock", 3) == stream_seed(7, "rock", 3));
}

TEST_CASE("random: the first numbers of the streams of neighbouring lines are even and unrelated") {
  std::vector<double> first, second, next;
  for (int k = -kDraws / 20; k < kDraws / 20; ++k) {
    Random random(stream_seed(1, "set#", k));
    first.push_back(random.uniform());
    second.push_back(random.uniform());
  }
  check_even(first);
  check_even(second);
  check_unrelated(first, second);
  check_unrelated(first, std::vector<double>(first.begin() + 1, first.end()));
}

}  // namespace test_random
