#include "talus/solve/block_factor.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "talus/base/error.h"
#include "talus/base/index.h"

namespace talus {

namespace {

// Sets of so few blocks are not dissected.
constexpr size_t kLeaf = 16;

// Directions across which a set of blocks is tried to be cut in two.
constexpr int kDirections = 6;

// Two blocks to a strip of rows; strips of one panel are eliminated together.
constexpr size_t kStrip = wide::kStripRows, kPanel = 4;

// Columns that a strip is updated by at a time: two strips of them stay in the nearest memory.
constexpr size_t kDepth = 96;

// Fronts with more strips are worked at by all threads.
constexpr size_t kManyStrips = 32;

// Strips of a front that a thread takes at a time when it is solved with.
constexpr size_t kSolvedTogether = 8;

// A subtree of less than this share of all operations is not parted further.
constexpr double kSmallShare = 1.0 / 24;

// Where strips begin. A strip is twelve rows, column by column: those of own blocks have the columns up to their
// diagonal, those of the boundary all own ones; what is left of the boundary has the boundary's own.
size_t own_strip(size_t s) { return kStrip * kStrip * s * (s + 1) / 2; }
size_t boundary_strip(size_t own, size_t s) { return own_strip(own) + kStrip * kStrip * own * s; }

}  // namespace

double BlockFactor::Front::operations() const {
  // sum over own columns of the squares of what stands below
  const double p = 6.0 * static_cast<double>(own.size()), n = p + 6.0 * static_cast<double>(boundary.size());
  const double m = n - p;
  return (n * (n + 1) * (2 * n + 1) - m * (m + 1) * (2 * m + 1)) / 6;
}

// Cuts the blocks in two, along the line that the fewest must be taken out for, and goes on with the halves.
class BlockFactor::Dissection {
 public:
  Dissection(const std::vector<std::array<int, 2>>& pairs, const std::vector<Vec2>& place)
      : place_(place), side_(place.size(), kOutside), mate_(place.size(), -1), seen_(place.size(), 0) {
    begin_.assign(place.size() + 1, 0);
    for (const auto& [a, b] : pairs) ++begin_[a + 1], ++begin_[b + 1];
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    near_.resize(2 * pairs.size());
    std::vector<size_t> next(begin_.begin(), begin_.end() - 1);
    for (const auto& [a, b] : pairs) near_[next[a]++] = b, near_[next[b]++] = a;
  }

  std::vector<Front> fronts() {
    std::vector<int> all(place_.size());
    std::iota(all.begin(), all.end(), 0);
    dissect(std::move(all));
    return std::move(fronts_);
  }

 private:
  enum Side : char { kOutside, kFirst, kSecond };

  // Returns the fronts on top: one, or several that have nothing to do with each other.
  std::vector<int> dissect(std::vector<int> blocks) {
    if (blocks.empty()) return {};
    std::vector<int> own, first, second;
    if (blocks.size() <= kLeaf)
      own = std::move(blocks);
    else
      part(blocks, own, first, second);
    blocks = {};
    std::vector<int> below = dissect(std::move(first));
    const std::vector<int> more = dissect(std::move(second));
    below.insert(below.end(), more.begin(), more.end());
    if (own.empty()) return below;
    const int me = count_of(fronts_);
    for (const int child : below) fronts_[child].parent = me;
    Front front;
    front.children = std::move(below), front.own = std::move(own);
    fronts_.push_back(std::move(front));
    return {me};
  }

  void part(const std::vector<int>& blocks, std::vector<int>& cut, std::vector<int>& first,
            std::vector<int>& second) {
    std::vector<int> order = blocks, best;
    size_t fewest = blocks.size() + 1;
    std::vector<char> best_side;
    const size_t half = blocks.size() / 2;
    for (int d = 0; d < kDirections; ++d) {
      const double angle = std::numbers::pi * d / kDirections;
      const Vec2 along{std::cos(angle), std::sin(angle)};
      const auto before = [&](int a, int b) {
        const double x = dot(along, place_[a]), y = dot(along, place_[b]);
        return x != y ? x < y : a < b;
      };
      std::nth_element(order.begin(), order.begin() + half, order.end(), before);
      for (size_t i = 0; i < order.size(); ++i) side_[order[i]] = i < half ? kFirst : kSecond;
      std::vector<int> cover = smallest_cover({order.begin(), order.begin() + half});
      if (cover.size() >= fewest) continue;
      fewest = cover.size(), best = std::move(cover);
      best_side.clear();
      for (const int b : blocks) best_side.push_back(side_[b]);
    }
    for (const int b : best) side_[b] = kOutside;
    for (size_t i = 0; i < blocks.size(); ++i) {
      const int b = blocks[i];
      if (std::binary_search(best.begin(), best.end(), blocks[i])) continue;
      (best_side[i] == kFirst ? first : second).push_back(blocks[i]);
      side_[b] = kOutside;
    }
    cut = std::move(best);
  }

  // The fewest blocks without which no pair joins the two sides (Koenig: as many as a largest matching has), in
  // rising order.
  std::vector<int> smallest_cover(const std::vector<int>& first) {
    std::vector<int> rim;  // of the first side
    for (const int a : first)
      if (has_other_side(a)) rim.push_back(a);
    std::vector<int> matched;
    for (const int a : rim) {
      ++turn_;
      if (augment(a)) matched.push_back(a);
    }
    // what alternating paths from unmatched blocks of the first side reach
    ++turn_;
    std::vector<int> reached_second;
    for (const int a : rim)
      if (mate_[a] < 0) reach(a, reached_second);
    std::vector<int> cover = reached_second;
    for (const int a : rim)
      if (seen_[a] != turn_) cover.push_back(a);
    for (const int a : rim) {
      const int b = mate_[a];
      if (b >= 0) mate_[b] = -1;
      mate_[a] = -1;
    }
    std::sort(cover.begin(), cover.end());
    return cover;
  }

  template <class F>
  void others(int a, F f) const {
    for (size_t i = begin_[a]; i < begin_[a + 1]; ++i)
      if (side_[near_[i]] == kSecond && !f(near_[i])) return;
  }
  bool has_other_side(int a) const {
    bool found = false;
    others(a, [&](int) { return found = true, false; });
    return found;
  }
  bool augment(int a) {
    bool done = false;
    others(a, [&](int b) {
      if (seen_[b] == turn_) return true;
      seen_[b] = turn_;
      int& mate = mate_[b];
      if (mate >= 0 && !augment(mate)) return true;
      mate = a, mate_[a] = b;
      done = true;
      return false;
    });
    return done;
  }
  void reach(int a, std::vector<int>& second) {
    seen_[a] = turn_;
    others(a, [&](int b) {
      if (seen_[b] == turn_) return true;
      seen_[b] = turn_;
      second.push_back(b);
      reach(mate_[b], second);
      return true;
    });
  }

  const std::vector<Vec2>& place_;
  std::vector<size_t> begin_;
  std::vector<int> near_;  // neighbours of each block
  std::vector<char> side_;
  std::vector<int> mate_, seen_;
  int turn_ = 0;
  std::vector<Front> fronts_;
};

void BlockFactor::analyse(const std::vector<std::array<int, 2>>& pairs, const std::vector<Vec2>& place) {
  fronts_ = Dissection(pairs, place).fronts();
  pairs_ = pairs;
  front_of_.assign(place.size(), -1), place_in_front_.assign(place.size(), -1);
  for (int f = 0; f < count_of(fronts_); ++f)
    for (int i = 0; i < count_of(fronts_[f].own); ++i) {
      const int b = fronts_[f].own[i];
      front_of_[b] = f, place_in_front_[b] = i;
    }
  join_fronts(pairs);
  cost_ = {};
  for (const Front& f : fronts_) {
    const size_t own = f.own_strips();
    cost_.entries += static_cast<double>(boundary_strip(own, f.boundary_strips()));
    cost_.operations += f.operations();
    cost_.largest_front =
        std::max(cost_.largest_front, static_cast<int>(6 * (f.own.size() + f.boundary.size())));
  }
  share_out();
}

bool BlockFactor::goes_before(int a, int b) const {
  return front_of_[a] != front_of_[b] ? front_of_[a] < front_of_[b] : place_in_front_[a] < place_in_front_[b];
}

// Boundaries, from the leaves upwards.
void BlockFactor::join_fronts(const std::vector<std::array<int, 2>>& pairs) {
  for (int k = 0; k < count_of(pairs); ++k) {
    const auto [a, b] = pairs[k];
    const int first = goes_before(a, b) ? a : b;
    fronts_[front_of_[first]].pairs.push_back(k);
  }
  for (int f = 0; f < count_of(fronts_); ++f) {
    Front& front = fronts_[f];
    std::vector<int>& rim = front.boundary;
    const auto take = [&](int b) {
      if (front_of_[b] != f) rim.push_back(b);
    };
    for (const int k : front.pairs)
      for (const int b : pairs[k]) take(b);
    for (const int c : front.children)
      for (const int b : fronts_[c].boundary) take(b);
    std::sort(rim.begin(), rim.end(), [this](int a, int b) { return goes_before(a, b); });
    rim.erase(std::unique(rim.begin(), rim.end()), rim.end());
    for (const int c : front.children) {
      Front& child = fronts_[c];
      size_t at = 0;  // both lists rise
      for (const int b : child.boundary) {
        if (front_of_[b] == f) {
          child.in_parent.push_back(place_in_front_[b]);
          continue;
        }
        while (rim[at] != b) ++at;
        child.in_parent.push_back(static_cast<int>(2 * front.own_strips() + at));
      }
    }
  }
}

// Subtrees for single threads; the fronts above them are worked at one after the other, by all.
void BlockFactor::share_out() {
  subtrees_.clear(), rest_.clear();
  std::vector<double> below(fronts_.size());
  double all = 0;
  for (size_t f = 0; f < fronts_.size(); ++f) {
    below[f] += fronts_[f].operations();
    all += fronts_[f].operations();
    if (fronts_[f].parent >= 0) below[fronts_[f].parent] += below[f];
  }
  // children come before parents: from the top down, a front is its parent's subtree or the root of one
  std::vector<int> root(fronts_.size(), -1), list(fronts_.size(), -1);
  for (size_t f = fronts_.size(); f-- > 0;) {
    const int parent = fronts_[f].parent;
    if (parent >= 0 && root[parent] >= 0)
      root[f] = root[parent];
    else if (below[f] <= kSmallShare * all || fronts_[f].children.empty())
      root[f] = static_cast<int>(f);
  }
  for (int f = 0; f < count_of(fronts_); ++f) {
    if (root[f] < 0) {
      rest_.push_back(f);
      continue;
    }
    int& l = list[root[f]];
    if (l < 0) l = count_of(subtrees_), subtrees_.emplace_back();
    subtrees_[l].push_back(f);
  }
  place_boundaries();
}

// What the fronts of a subtree leave of blocks outside of it belongs to the boundary of its root.
void BlockFactor::place_boundaries() {
  outside_ = {6 * front_of_.size()};
  for (const int f : rest_) {
    Front& front = fronts_[f];
    front.at.clear();
    for (const int b : front.boundary) front.at.push_back(6 * b);
  }
  for (const std::vector<int>& subtree : subtrees_) {
    const int top = subtree.back();
    const std::vector<int>& rim = fronts_[top].boundary;
    for (const int f : subtree) {
      Front& front = fronts_[f];
      front.at.clear();
      for (const int b : front.boundary) {
        if (front_of_[b] <= top) {
          front.at.push_back(6 * b);
          continue;
        }
        const auto place =
            std::lower_bound(rim.begin(), rim.end(), b, [this](int x, int y) { return goes_before(x, y); });
        front.at.push_back(outside_.back() + 6 * (place - rim.begin()));
      }
    }
    outside_.push_back(outside_.back() + 6 * rim.size());
  }
}

namespace {

// The place of the first number of a tile, block i by block j of a front: in the own columns, or in what is left
// of the boundary. Numbers of a column lie side by side, columns kStrip apart.
struct Places {
  size_t own;  // strips
  double *columns, *left;
  double* operator()(size_t i, size_t j) const {
    const size_t s = i / 2, row = 6 * (i % 2);
    if (s < own) return columns + own_strip(s) + kStrip * 6 * j + row;
    if (j / 2 < own) return columns + boundary_strip(own, s - own) + kStrip * 6 * j + row;
    return left + own_strip(s - own) + kStrip * 6 * (j - 2 * own) + row;
  }
};

}  // namespace

// The tiles of the matrix that belong to the front, and what its children have left.
void BlockFactor::gather(Front& front, const std::vector<Tile>& diagonal, const std::vector<Tile>& beside) {
  const size_t own = front.own_strips(), rim = front.boundary_strips();
  front.columns.assign(boundary_strip(own, rim), 0);
  front.left.assign(own_strip(rim), 0);
  const Places at{own, front.columns.data(), front.left.data()};
  for (size_t i = 0; i < front.own.size(); ++i) {
    const Tile& tile = diagonal[front.own[i]];
    double* to = at(i, i);
    for (size_t c = 0; c < 6; ++c)
      for (size_t r = 0; r < 6; ++r) to[kStrip * c + r] = tile[6 * r + c];
  }
  if (front.own.size() % 2 == 1)  // a block that is none
    for (size_t r = 0; r < 6; ++r) at(front.own.size(), front.own.size())[(kStrip + 1) * r] = 1;
  const auto local = [&](int block) -> size_t {
    if (&fronts_[front_of_[block]] == &front) return place_in_front_[block];
    const auto it = std::lower_bound(front.boundary.begin(), front.boundary.end(), block,
                                     [this](int x, int y) { return goes_before(x, y); });
    return 2 * own + (it - front.boundary.begin());
  };
  for (const int k : front.pairs) {
    const auto [a, b] = pairs_[k];
    const size_t i = local(a), j = local(b);
    const Tile& tile = beside[k];
    double* to = i > j ? at(i, j) : at(j, i);
    for (size_t c = 0; c < 6; ++c)
      for (size_t r = 0; r < 6; ++r) to[kStrip * c + r] = i > j ? tile[6 * r + c] : tile[6 * c + r];
  }
  for (const int c : front.children) {
    Front& child = fronts_[c];
    const Places from{0, nullptr, child.left.data()};
    for (size_t i = 0; i < child.in_parent.size(); ++i)
      for (size_t j = 0; j <= i; ++j) {
        const double* tile = from(i, j);
        double* to = at(child.in_parent[i], static_cast<size_t>(child.in_parent[j]));
        for (size_t k = 0; k < 6; ++k)
          for (size_t r = 0; r < 6; ++r) to[kStrip * k + r] += tile[kStrip * k + r];
      }
    std::vector<double>().swap(child.left);
  }
}

namespace {

// Cholesky's factor of twelve rows and columns, in place; reciprocals on the diagonal. False when it has none.
bool factor_diagonal(double* c) {
  for (size_t j = 0; j < kStrip; ++j) {
    double d = c[kStrip * j + j];
    for (size_t k = 0; k < j; ++k) d -= c[kStrip * k + j] * c[kStrip * k + j];
    if (!(d > 0) || !std::isfinite(d)) return false;
    const double reciprocal = 1 / std::sqrt(d);
    c[kStrip * j + j] = reciprocal;
    for (size_t i = j + 1; i < kStrip; ++i) {
      double s = c[kStrip * j + i];
      for (size_t k = 0; k < j; ++k) s -= c[kStrip * k + i] * c[kStrip * k + j];
      c[kStrip * j + i] = s * reciprocal;
    }
  }
  return true;
}

}  // namespace

bool BlockFactor::eliminate(Front& front, const Workers& workers) const {
  const size_t own = front.own_strips(), rim = front.boundary_strips(), all = own + rim;
  double* columns = front.columns.data();
  const auto strip = [&](size_t s) {
    return columns + (s < own ? own_strip(s) : boundary_strip(own, s - own));
  };
  const auto rows = [&](size_t begin, const std::function<void(size_t, size_t)>& f) {
    if (all > kManyStrips)
      workers.for_chunks(all - begin, 4, [&](size_t b, size_t e) { f(begin + b, begin + e); });
    else if (begin < all)
      f(begin, all);
  };
  for (size_t panel = 0; panel < own; panel += kPanel) {
    const size_t last = std::min(panel + kPanel, own);
    // all panels before
    rows(panel, [&](size_t begin, size_t end) {
      for (size_t k = 0; k < kStrip * panel; k += kDepth) {
        const size_t depth = std::min(kDepth, kStrip * panel - k);
        for (size_t i = begin; i < end; ++i)
          for (size_t j = panel; j < std::min(last, i + 1); ++j)
            kernels_->subtract_products(strip(i) + kStrip * k, strip(j) + kStrip * k, depth,
                                        strip(i) + kStrip * kStrip * j);
      }
    });
    // the panel itself: its own rows, then those below
    for (size_t j = panel; j < last; ++j) {
      for (size_t i = j; i < last; ++i)
        kernels_->subtract_products(strip(i) + kStrip * kStrip * panel, strip(j) + kStrip * kStrip * panel,
                                    kStrip * (j - panel), strip(i) + kStrip * kStrip * j);
      if (!factor_diagonal(strip(j) + kStrip * kStrip * j)) return false;
      for (size_t i = j + 1; i < last; ++i)
        kernels_->divide_strip(strip(j) + kStrip * kStrip * j, strip(i) + kStrip * kStrip * j);
    }
    rows(last, [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i)
        for (size_t j = panel; j < last; ++j) {
          kernels_->subtract_products(strip(i) + kStrip * kStrip * panel, strip(j) + kStrip * kStrip * panel,
                                      kStrip * (j - panel), strip(i) + kStrip * kStrip * j);
          kernels_->divide_strip(strip(j) + kStrip * kStrip * j, strip(i) + kStrip * kStrip * j);
        }
    });
  }
  // what is left of the boundary
  double* left = front.left.data();
  rows(own, [&](size_t begin, size_t end) {
    for (size_t k = 0; k < kStrip * own; k += kDepth) {
      const size_t depth = std::min(kDepth, kStrip * own - k);
      for (size_t from = own; from < end; from += kPanel)
        for (size_t i = std::max(begin, from); i < end; ++i)
          for (size_t j = from; j < std::min(from + kPanel, i + 1); ++j)
            kernels_->subtract_products(strip(i) + kStrip * k, strip(j) + kStrip * k, depth,
                                        left + own_strip(i - own) + kStrip * kStrip * (j - own));
    }
  });
  return true;
}

bool BlockFactor::factorize(const std::vector<Tile>& diagonal, const std::vector<Tile>& beside,
                            const Workers& workers) {
  TALUS_ASSERT(diagonal.size() == front_of_.size() && beside.size() == pairs_.size());
  std::atomic<bool> good = true;
  const Workers alone;
  const auto work = [&](int f, const Workers& by) {
    Front& front = fronts_[f];
    gather(front, diagonal, beside);
    if (!eliminate(front, by)) good = false;
  };
  workers.run(subtrees_.size(), [&](size_t t) {
    for (const int f : subtrees_[t])
      if (good) work(f, alone);
  });
  for (const int f : rest_)
    if (good) work(f, workers);
  for (Front& front : fronts_)
    if (front.parent < 0 || !good) std::vector<double>().swap(front.left);
  return good;
}

double BlockFactor::pivot_ratio() const {
  double least = std::numeric_limits<double>::infinity(), most = 0;  // of reciprocals
  for (const Front& front : fronts_)
    for (size_t i = 0; i < front.own.size(); ++i) {
      const double* strip = front.columns.data() + own_strip(i / 2) + kStrip * kStrip * (i / 2);
      for (size_t k = 6 * (i % 2); k < 6 * (i % 2) + 6; ++k)
        least = std::min(least, strip[kStrip * k + k]), most = std::max(most, strip[kStrip * k + k]);
    }
  return most > 0 ? (most / least) * (most / least) : 1;
}

// Numbers of own blocks and of the boundary, side by side.
void BlockFactor::fetch(const Front& front, const double* x, std::vector<double>& y) {
  const size_t own = front.own_strips();
  y.assign(kStrip * (own + front.boundary_strips()), 0);
  for (size_t i = 0; i < front.own.size(); ++i) std::copy_n(x + 6 * front.own[i], 6, &y[6 * i]);
  for (size_t i = 0; i < front.at.size(); ++i) std::copy_n(x + front.at[i], 6, &y[kStrip * own + 6 * i]);
}

void BlockFactor::forward(const Front& front, const Workers& workers, double* x,
                          std::vector<double>& y) const {
  const size_t own = front.own_strips(), rim = front.boundary_strips();
  fetch(front, x, y);
  for (size_t s = 0; s < own; ++s) {
    const double* a = front.columns.data() + own_strip(s);
    double* here = &y[kStrip * s];
    kernels_->subtract_columns(a, y.data(), kStrip * s, here);
    const double* d = a + kStrip * kStrip * s;
    for (size_t j = 0; j < kStrip; ++j) {
      here[j] *= d[kStrip * j + j];
      for (size_t i = j + 1; i < kStrip; ++i) here[i] -= d[kStrip * j + i] * here[j];
    }
  }
  workers.for_chunks(rim, kSolvedTogether, [&](size_t begin, size_t end) {
    for (size_t s = begin; s < end; ++s)
      kernels_->subtract_columns(front.columns.data() + boundary_strip(own, s), y.data(), kStrip * own,
                                 &y[kStrip * (own + s)]);
  });
  for (size_t i = 0; i < front.own.size(); ++i) std::copy_n(&y[6 * i], 6, x + 6 * front.own[i]);
  for (size_t i = 0; i < front.at.size(); ++i) std::copy_n(&y[kStrip * own + 6 * i], 6, x + front.at[i]);
}

void BlockFactor::backward(const Front& front, const Workers& workers, double* x,
                           std::vector<double>& y) const {
  const size_t own = front.own_strips(), rim = front.boundary_strips();
  fetch(front, x, y);
  workers.for_chunks(own, kSolvedTogether, [&](size_t begin, size_t end) {
    for (size_t s = 0; s < rim; ++s)
      kernels_->subtract_rows(front.columns.data() + boundary_strip(own, s) + kStrip * kStrip * begin,
                              &y[kStrip * (own + s)], kStrip * (end - begin), &y[kStrip * begin]);
  });
  for (size_t s = own; s-- > 0;) {
    const double* a = front.columns.data() + own_strip(s);
    double* here = &y[kStrip * s];
    const double* d = a + kStrip * kStrip * s;
    for (size_t j = kStrip; j-- > 0;) {
      for (size_t i = j + 1; i < kStrip; ++i) here[j] -= d[kStrip * j + i] * here[i];
      here[j] *= d[kStrip * j + j];
    }
    kernels_->subtract_rows(a, here, kStrip * s, y.data());
  }
  for (size_t i = 0; i < front.own.size(); ++i) std::copy_n(&y[6 * i], 6, x + 6 * front.own[i]);
}

void BlockFactor::solve(std::vector<double>& x, const Workers& workers) const {
  const size_t size = 6 * front_of_.size();
  TALUS_ASSERT(x.size() == size);
  x.resize(outside_.back(), 0);
  const Workers alone;
  const auto root = [&](size_t t) -> const Front& { return fronts_[subtrees_[t].back()]; };
  workers.run(subtrees_.size(), [&](size_t t) {
    std::vector<double> y;
    for (const int f : subtrees_[t]) forward(fronts_[f], alone, x.data(), y);
  });
  for (size_t t = 0; t < subtrees_.size(); ++t) {
    const std::vector<int>& rim = root(t).boundary;
    for (size_t i = 0; i < rim.size(); ++i)
      for (size_t k = 0; k < 6; ++k) x[6 * rim[i] + k] += x[outside_[t] + 6 * i + k];
  }
  std::vector<double> y;
  for (const int f : rest_) forward(fronts_[f], workers, x.data(), y);
  for (auto f = rest_.rbegin(); f != rest_.rend(); ++f) backward(fronts_[*f], workers, x.data(), y);
  workers.run(subtrees_.size(), [&](size_t t) {
    const std::vector<int>& rim = root(t).boundary;
    for (size_t i = 0; i < rim.size(); ++i) std::copy_n(&x[6 * rim[i]], 6, &x[outside_[t] + 6 * i]);
    std::vector<double> mine;
    for (auto f = subtrees_[t].rbegin(); f != subtrees_[t].rend(); ++f)
      backward(fronts_[*f], alone, x.data(), mine);
  });
  x.resize(size);
}

}  // namespace talus
