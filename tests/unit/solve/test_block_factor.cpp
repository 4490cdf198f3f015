#include "support/relative.h"
#include "talus/base/index.h"
#include "talus/solve/block_factor.h"

#include <doctest/doctest.h>

#include <Eigen/Sparse>
#include <Eigen/SparseCholesky>
#include <map>
#include <random>

namespace test_block_factor {

using namespace talus;

namespace {

struct Matrix {
  std::vector<std::array<int, 2>> pairs;
  std::vector<Vec2> place;
  std::vector<Tile> diagonal, beside;
};

// A sheet of n x m blocks, each joined with its neighbours, some of them also with one far away; and as many that
// are joined with nothing.
Matrix sheet(int n, int m, int far, int alone, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> number(-1, 1);
  Matrix a;
  const int count = n * m + alone;
  std::vector<int> name(count);
  for (int i = 0; i < count; ++i) name[i] = i;
  std::shuffle(name.begin(), name.end(), random);
  a.place.resize(count);
  std::map<std::array<int, 2>, Tile> tiles;
  const auto join = [&](int i, int j) {
    if (i == j) return;
    i = name[i], j = name[j];
    Tile t;
    for (double& x : t) x = number(random);
    tiles.emplace(std::array{std::min(i, j), std::max(i, j)}, t);
  };
  for (int y = 0; y < m; ++y)
    for (int x = 0; x < n; ++x) {
      const int i = y * n + x;
      a.place[name[i]] = {x + 0.3 * number(random), 2.0 * y};
      if (x + 1 < n) join(i, i + 1);
      if (y + 1 < m) join(i, i + n);
      if (x + 1 < n && y + 1 < m && number(random) > 0) join(i, i + n + 1);
    }
  for (int k = 0; k < far; ++k)
    join(static_cast<int>(random() % static_cast<unsigned>(n * m)),
         static_cast<int>(random() % static_cast<unsigned>(n * m)));
  a.diagonal.assign(count, Tile{});
  for (const auto& [pair, tile] : tiles) a.pairs.push_back(pair), a.beside.push_back(tile);
  for (Tile& t : a.diagonal)
    for (size_t r = 0; r < 6; ++r)
      for (size_t c = 0; c <= r; ++c)
        t[6 * r + c] = t[6 * c + r] = r == c ? 40 + 10 * number(random) : number(random);
  return a;
}

Eigen::SparseMatrix<double> sparse(const Matrix& a) {
  std::vector<Eigen::Triplet<double>> all;
  const auto put = [&](int i, int j, const Tile& t, bool turned) {
    for (int r = 0; r < 6; ++r)
      for (int c = 0; c < 6; ++c)
        all.emplace_back(6 * i + (turned ? c : r), 6 * j + (turned ? r : c), t[6 * r + c]);
  };
  for (int i = 0; i < count_of(a.diagonal); ++i) put(i, i, a.diagonal[i], false);
  for (size_t k = 0; k < a.pairs.size(); ++k) {
    put(a.pairs[k][0], a.pairs[k][1], a.beside[k], false);
    put(a.pairs[k][1], a.pairs[k][0], a.beside[k], true);
  }
  const auto n = static_cast<Eigen::Index>(6 * a.diagonal.size());
  Eigen::SparseMatrix<double> m(n, n);
  m.setFromTriplets(all.begin(), all.end());
  return m;
}

std::vector<double> numbers(size_t n) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> number(-1, 1);
  std::vector<double> x(n);
  for (double& v : x) v = number(random);
  return x;
}

std::vector<double> solved(const Matrix& a, int threads,
                           const wide::Kernels& kernels = wide::best_kernels()) {
  BlockFactor factor(kernels);
  factor.analyse(a.pairs, a.place);
  const Workers workers(threads);
  REQUIRE(factor.factorize(a.diagonal, a.beside, workers));
  std::vector<double> x = numbers(6 * a.diagonal.size());
  factor.solve(x, workers);
  return x;
}

}  // namespace

TEST_CASE("block factor: the solutions of Eigen's simplicial one") {
  const int shapes[][4] = {{1, 1, 0, 0}, {2, 1, 0, 0},    {3, 5, 0, 1},  {17, 1, 0, 0},
                           {9, 7, 4, 3}, {40, 33, 20, 5}, {200, 3, 0, 0}};
  unsigned seed = 1;
  for (const auto& s : shapes) {
    CAPTURE(s[0]);
    const Matrix a = sheet(s[0], s[1], s[2], s[3], seed++);
    const std::vector<double> x = solved(a, 1), b = numbers(x.size());
    const Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> eigen(sparse(a));
    REQUIRE(eigen.info() == Eigen::Success);
    const Eigen::VectorXd y =
        eigen.solve(Eigen::Map<const Eigen::VectorXd>(b.data(), static_cast<Eigen::Index>(b.size())));
    double most = 0;
    for (size_t i = 0; i < x.size(); ++i)
      most = std::max(most, std::abs(x[i] - y[static_cast<Eigen::Index>(i)]));
    // both are round-off away from the answer; diagonals outweigh their rows, so that it is not magnified
    CHECK(most < 1e-12 * y.lpNorm<Eigen::Infinity>());
  }
}

TEST_CASE("block factor: the same bits for any number of threads, any kernels, and when used again" *
          doctest::test_suite("optimised")) {
  const Matrix a = sheet(60, 50, 10, 3, 11);
  const std::vector<double> one = solved(a, 1);
  for (const int threads : {2, 3, 4}) CHECK(solved(a, threads) == one);
  CHECK(solved(a, 1, wide::plain_kernels()) == one);
  BlockFactor factor;
  factor.analyse(a.pairs, a.place);
  std::vector<Tile> other = a.diagonal;
  for (Tile& t : other)
    for (size_t r = 0; r < 6; ++r) t[7 * r] += 3;
  REQUIRE(factor.factorize(other, a.beside, Workers(2)));
  REQUIRE(factor.factorize(a.diagonal, a.beside, Workers(2)));
  std::vector<double> x = numbers(one.size());
  factor.solve(x, Workers(2));
  CHECK(x == one);
}

TEST_CASE("block factor: what is not positive definite is told, whoever finds it") {
  Matrix a = sheet(30, 30, 0, 0, 5);
  for (const size_t where : {size_t{0}, size_t{450}, size_t{899}}) {
    for (const double bad : {-1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
      Matrix b = a;
      b.diagonal[where][14] = bad;
      BlockFactor factor;
      factor.analyse(b.pairs, b.place);
      CHECK_FALSE(factor.factorize(b.diagonal, b.beside, Workers(2)));
      CHECK(factor.factorize(a.diagonal, a.beside, Workers(1)));
    }
  }
}

TEST_CASE("block factor: fill grows hardly more than the sheet") {
  double before = 0;
  for (const int n : {25, 50, 100, 200}) {
    const Matrix a = sheet(n, n, 0, 0, 3);
    BlockFactor factor;
    factor.analyse(a.pairs, a.place);
    const double per_block = factor.cost().entries / static_cast<double>(a.place.size());
    MESSAGE(n * n, " blocks: ", per_block, " entries, ", factor.cost().operations / (n * n),
            " operations a block, front ", factor.cost().largest_front);
    if (before > 0) CHECK(per_block < 1.4 * before);  // n log n
    before = per_block;
  }
}

TEST_CASE("block factor: the ratio of its pivots") {
  // of a diagonal matrix these are its numbers; an odd count of blocks leaves half a strip of padding
  for (const int count : {1, 4, 7}) {
    std::vector<Tile> diagonal(count);
    for (int i = 0; i < count; ++i)
      for (size_t k = 0; k < 6; ++k) diagonal[i][7 * k] = 20 + i + 0.1 * static_cast<double>(k);
    BlockFactor factor;
    factor.analyse({}, std::vector<Vec2>(count));
    REQUIRE(factor.factorize(diagonal, {}, Workers()));
    CHECK(factor.pivot_ratio() == test::approx((19.5 + count) / 20).epsilon(1e-12));
  }
}

}  // namespace test_block_factor
