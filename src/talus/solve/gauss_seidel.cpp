#include "talus/solve/gauss_seidel.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <utility>

#include "talus/base/index.h"
#include "talus/base/prefetch.h"
#include "talus/solve/contact_error.h"

namespace talus {

namespace {

using wide::kEndless;
using wide::kLanes;

// Sweeps that a sharper goal may take beyond as many again as the first one took.
constexpr int kSweepsMore = 20;

// Colours before couples are solved one after the other: as many as a word has bits.
constexpr int kMostColours = 63;

// Sweeps before the second phase: most steps end within them.
constexpr int kPlainSweeps = 30;

// Sweeps from one look at how far they have come to the next; the second tells how many are still to be
// expected.
constexpr int kBetweenLooks = 40;

// The judge finds about so many times the change that the next sweep would make, where sweeps are slow; as much
// as the last one made at least, where they are fast. Measured on shaken rock and walls.
constexpr double kErrorOfNext = 1.3;

// A judge who was mistaken for content is not asked again before so many sweeps, or a fifth of those so far.
constexpr int kSweepsBetween = 2;

// Growth of the change from sweep to sweep at which the second phase starts afresh. Forces that move at a
// steady rate along redundant rows, until one of them lets go, have a ratio of one and some round-off.
constexpr double kStillGood = 1.2;

// The same against the least change since it last started: slow growth over many sweeps is divergence too.
constexpr double kMostGrowth = 16;

bool is_tie(const PointRows& p) { return p.lower != 0 || std::isfinite(p.upper) || p.cohesion != 0; }

// The point as its couple sees it: blocks exchanged where it names them the other way round.
struct Seen {
  Vec2 normal, arm_a, arm_b;
};
Seen seen_from(const PointRows& p, int block_a) {
  if (p.block_a == block_a) return {p.normal, p.arm_a, p.arm_b};
  return {-p.normal, p.arm_b, p.arm_a};
}

// Whether a lane is written to a line that nobody reads.
template <class Record>
bool has_still(const Record& r) {
  const auto negative = [](int line) { return line < 0; };
  return std::any_of(r.into_a, r.into_a + kLanes, negative) ||
         std::any_of(r.into_b, r.into_b + kLanes, negative);
}

template <class Record>
void write_empty(Record& r, wide::Give& give, int lane, int point) {
  auto& p = r.point[point];
  // no direction: whatever the blocks do, its residual is the bias and no impulse comes of it
  p.nx[lane] = p.ny[lane] = 0;
  p.ax[lane] = p.ay[lane] = p.bx[lane] = p.by[lane] = 0;
  p.bias_n[lane] = 1, p.bias_t[lane] = 0;
  p.p_n[lane] = p.p_t[lane] = 0;
  give.n[point][lane] = give.t[point][lane] = 1;
  p.mu[lane] = 0;
}

void write_bounds(wide::ContactLanes&, int, const PointRows*) {}
void write_bounds(wide::TieLanes& p, int lane, const PointRows* rows) {
  const auto clip = [](double v) { return std::clamp(v, -kEndless, kEndless); };
  p.lower_n[lane] = rows ? clip(rows->lower) : 0, p.upper_n[lane] = rows ? clip(rows->upper) : 0;
  p.cohesion[lane] = rows ? clip(rows->cohesion) : 0;
}

template <class Record>
void write_point(const std::vector<Mobility>& mobility, const PointRows& rows, const Impulse& impulse,
                 Record& r, wide::Give& give, int lane, int point, int block_a) {
  auto& p = r.point[point];
  const Seen s = seen_from(rows, block_a);
  const int block_b = rows.block_a == block_a ? rows.block_b : rows.block_a;
  const Vec2 a = block_a >= 0 ? turned_back(mobility[block_a].right, s.arm_a) : Vec2{};
  const Vec2 b = block_b >= 0 ? turned_back(mobility[block_b].right, s.arm_b) : Vec2{};
  p.nx[lane] = s.normal.x, p.ny[lane] = s.normal.y;
  p.ax[lane] = a.x, p.ay[lane] = a.y, p.bx[lane] = b.x, p.by[lane] = b.y;
  p.bias_n[lane] = rows.row[0].bias, p.bias_t[lane] = rows.row[1].bias;
  p.p_n[lane] = impulse[0], p.p_t[lane] = impulse[1];
  give.n[point][lane] = rows.row[0].compliance, give.t[point][lane] = rows.row[1].compliance;
  p.mu[lane] = rows.friction;
}

}  // namespace

bool GaussSeidel::layout_holds(const RowSet& set, const Workers& workers) {
  std::atomic<bool> same{seen_.size() == set.points.size()};
  resize_sparingly(seen_, set.points.size());
  workers.for_chunks(seen_.size(), 4096, [&](size_t begin, size_t end) {
    bool here = true;
    for (size_t i = begin; i < end; ++i) {
      const PointRows& p = set.points[i];
      const Point now{std::min(p.block_a, p.block_b), std::max(p.block_a, p.block_b),
                      2 * static_cast<unsigned>(p.partner + 1) + is_tie(p)};
      here = here && seen_[i] == now;
      seen_[i] = now;
    }
    if (!here) same = false;
  });
  return same;
}

// A layout in the making. Groups are the tiles, then the couples between them.
struct GaussSeidel::Plan {
  std::vector<Rows> couples;
  size_t tiles = 0;
  std::vector<size_t> group_begin;  // [groups + 1] in `in_group`
  std::vector<size_t> in_group;     // couples group by group, each in the order of the list
  std::vector<int> colour;          // of each couple
  struct PerColour {
    std::array<size_t, kMostColours + 1> contacts{}, ties{};
  };
  std::vector<PerColour> count;    // couples of each colour [groups]
  std::vector<PerColour> free_at;  // where their next one goes, in lanes [groups]
};

// The two ends of a face, else neighbours in the list with the same two blocks.
std::vector<GaussSeidel::Rows> GaussSeidel::couples() const {
  std::vector<Rows> couples;
  const auto n = count_of(seen_);
  const auto same_blocks = [&](int i, int j) {
    const Point &p = at(i), &q = at(j);
    return p.tie() == q.tie() && p.block_a == q.block_a && p.block_b == q.block_b;
  };
  for (int i = 0; i < n; ++i) {
    const int partner = at(i).partner();
    if (partner > i) couples.push_back({{i, partner}});
    if (partner >= 0) continue;
    if (i + 1 < n && at(i + 1).partner() < 0 && same_blocks(i, i + 1)) {
      couples.push_back({{i, i + 1}});
      ++i;
    } else {
      couples.push_back({{i, -1}});
    }
  }
  return couples;
}

// One end of a face may have strength left when the other has none: records of ties hold both kinds.
bool GaussSeidel::has_tie(const Rows& c) const {
  return at(c.row[0]).tie() || (c.row[1] >= 0 && at(c.row[1]).tie());
}

void GaussSeidel::part_couples(const std::vector<Mobility>& mobility, std::span<const int> tile,
                               Plan& plan) const {
  if (!tile.empty()) plan.tiles = 1 + *std::max_element(tile.begin(), tile.end());
  const auto tile_of = [&](int block) { return !tile.empty() && moves(mobility, block) ? tile[block] : -1; };
  const auto group_of = [&](const Rows& c) {
    const int a = tile_of(at(c.row[0]).block_a), b = tile_of(at(c.row[0]).block_b);
    const int only = a < 0 ? b : b < 0 || a == b ? a : -1;
    return only < 0 ? plan.tiles : only;
  };
  std::vector<size_t> group(plan.couples.size());
  plan.group_begin.assign(plan.tiles + 2, 0);
  for (size_t c = 0; c < group.size(); ++c) ++plan.group_begin[1 + (group[c] = group_of(plan.couples[c]))];
  for (size_t g = 0; g <= plan.tiles; ++g) plan.group_begin[g + 1] += plan.group_begin[g];
  std::vector<size_t> place(plan.group_begin.begin(), plan.group_begin.end() - 1);
  plan.in_group.resize(group.size());
  for (size_t c = 0; c < group.size(); ++c) plan.in_group[place[group[c]]++] = c;
}

// The lowest colour that neither block has in the group.
void GaussSeidel::give_colours(const std::vector<Mobility>& mobility, const Workers& workers,
                               Plan& plan) const {
  std::vector<uint64_t> used(mobility.size(), 0);
  plan.colour.resize(plan.couples.size());
  plan.count.resize(plan.tiles + 1);
  const auto colour_group = [&](size_t g) {
    for (size_t i = plan.group_begin[g]; i < plan.group_begin[g + 1]; ++i) {
      const size_t c = plan.in_group[i];
      const Point& p = at(plan.couples[c].row[0]);
      uint64_t taken = 0;
      if (moves(mobility, p.block_a)) taken |= used[p.block_a];
      if (moves(mobility, p.block_b)) taken |= used[p.block_b];
      const int colour = std::min(__builtin_ctzll(~taken | (1ULL << kMostColours)), kMostColours);
      plan.colour[c] = colour;
      Plan::PerColour& count = plan.count[g];
      ++(has_tie(plan.couples[c]) ? count.ties : count.contacts)[colour];
      if (colour == kMostColours) continue;
      if (moves(mobility, p.block_a)) used[p.block_a] |= 1ULL << colour;
      if (moves(mobility, p.block_b)) used[p.block_b] |= 1ULL << colour;
    }
  };
  // tiles share no moving block
  workers.for_chunks(plan.tiles, 1, [&](size_t g, size_t) { colour_group(g); });
  if (plan.tiles > 0) used.assign(used.size(), 0);
  colour_group(plan.tiles);
}

// By group and colour, in the order of the list; couples without a colour one to a record.
void GaussSeidel::place_rows(const Workers& workers, Plan& plan) {
  colour_.clear(), tile_colours_.clear();
  size_t contact_at = 0, tie_at = 0;
  plan.free_at.resize(plan.tiles + 1);
  for (size_t g = 0; g <= plan.tiles; ++g) {
    tile_colours_.push_back(colour_.size());
    for (size_t k = 0; k <= kMostColours; ++k) {
      const bool in_order = k == kMostColours;
      const auto records = [&](size_t count) { return in_order ? count : (count + kLanes - 1) / kLanes; };
      plan.free_at[g].contacts[k] = contact_at * kLanes, plan.free_at[g].ties[k] = tie_at * kLanes;
      const size_t contacts = plan.count[g].contacts[k], ties = plan.count[g].ties[k];
      if (contacts + ties == 0) continue;
      Colour colour{contact_at, contact_at + records(contacts), tie_at, tie_at + records(ties), in_order};
      contact_at = colour.contact_end, tie_at = colour.tie_end;
      colour_.push_back(colour);
    }
  }
  contact_rows_.assign(contact_at * kLanes, {{-1, -1}});
  tie_rows_.assign(tie_at * kLanes, {{-1, -1}});
  workers.for_chunks(plan.tiles + 1, 1, [&](size_t g, size_t) {
    for (size_t i = plan.group_begin[g]; i < plan.group_begin[g + 1]; ++i) {
      const size_t c = plan.in_group[i];
      const int k = plan.colour[c];
      const bool tie = has_tie(plan.couples[c]);
      size_t& place = (tie ? plan.free_at[g].ties : plan.free_at[g].contacts)[k];
      (tie ? tie_rows_ : contact_rows_)[place] = plan.couples[c];
      place += k == kMostColours ? kLanes : 1;
    }
  });
  resize_sparingly(contacts_, contact_at), resize_sparingly(contact_give_, contact_at);
  resize_sparingly(ties_, tie_at), resize_sparingly(tie_give_, tie_at);
}

// Blocks that do not move are written to lines that nobody reads, one for each record that has any.
void GaussSeidel::place_blocks(const std::vector<Mobility>& mobility, const Workers& workers) {
  const auto line_of = [&](int block) { return block < 0 ? ground_ : line_[block]; };
  int line = ground_ + 1;
  const auto set_blocks = [&](auto& records, const std::vector<Rows>& rows) {
    constexpr size_t kChunk = 1024;
    std::vector<int> still((records.size() + kChunk - 1) / kChunk);
    workers.for_chunks(records.size(), kChunk, [&](size_t begin, size_t end) {
      for (size_t r = begin; r < end; ++r) {
        auto& record = records[r];
        for (size_t l = 0; l < kLanes; ++l) {
          const int row = rows[r * kLanes + l].row[0];
          const int a = row < 0 ? -1 : at(row).block_a, b = row < 0 ? -1 : at(row).block_b;
          record.a[l] = line_of(a), record.b[l] = line_of(b);
          record.into_a[l] = moves(mobility, a) ? line_of(a) : -1,
          record.into_b[l] = moves(mobility, b) ? line_of(b) : -1;
        }
        still[begin / kChunk] += has_still(record);
      }
    });
    for (int& first : still) line += std::exchange(first, line);
    workers.for_chunks(records.size(), kChunk, [&](size_t begin, size_t end) {
      int next = still[begin / kChunk];
      for (size_t r = begin; r < end; ++r) {
        if (!has_still(records[r])) continue;
        for (size_t l = 0; l < kLanes; ++l) {
          if (records[r].into_a[l] < 0) records[r].into_a[l] = next;
          if (records[r].into_b[l] < 0) records[r].into_b[l] = next;
        }
        ++next;
      }
    });
  };
  set_blocks(contacts_, contact_rows_);
  set_blocks(ties_, tie_rows_);
  resize_sparingly(lines_, line);
  lines_[ground_] = {};
}

// Theory 5.5.
void GaussSeidel::lay_out(const std::vector<Mobility>& mobility, std::span<const int> tile,
                          const Workers& workers) {
  TALUS_ASSERT(tile.empty() || tile.size() == mobility.size());
  Plan plan;
  plan.couples = couples();
  part_couples(mobility, tile, plan);
  give_colours(mobility, workers, plan);
  place_rows(workers, plan);
  ground_ = count_of(mobility);
  order_lines(tile, plan.tiles);
  place_blocks(mobility, workers);
}

// Of the group that needs the most.
int GaussSeidel::most_colours() const {
  size_t most = 0;
  for (size_t g = 0; g < tile_colours_.size(); ++g)
    most = std::max(
        most, (g + 1 < tile_colours_.size() ? tile_colours_[g + 1] : colour_.size()) - tile_colours_[g]);
  return static_cast<int>(most);
}

// Blocks of a tile have their lines side by side: they are fetched as one piece.
void GaussSeidel::order_lines(std::span<const int> tile, size_t tiles) {
  line_.resize(ground_);
  std::vector<int> next(tiles + 1);
  for (const int t : tile) ++next[t + 1];
  for (size_t t = 0; t < tiles; ++t) next[t + 1] += next[t];
  for (int i = 0; i < count_of(line_); ++i) line_[i] = tile.empty() ? i : next[tile[i]]++;
}

void GaussSeidel::write_lines(const std::vector<Mobility>& mobility, const std::vector<BlockRate>& rate,
                              const Workers& workers) {
  workers.for_chunks(mobility.size(), 1024, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const Mobility& m = mobility[i];
      wide::BlockLine& line = lines_[line_[i]];
      const Mat2 g = transpose(rotation(m.left)) * rate[i].G * rotation(m.right);
      const double values[] = {rate[i].a.x, rate[i].a.y, g.xx, g.xy, g.yx, g.yy, m.mass, 0};
      const double answer[] = {m.stretch[0], m.stretch[1], m.stretch[2], m.shear[0],
                               m.shear[1],   m.shear[2],   m.left.x,     m.left.y};
      std::copy(values, values + 8, line.rate);
      std::copy(answer, answer + 8, line.answer);
    }
  });
}

void GaussSeidel::read_lines(const StepProblem& problem, const Workers& workers) const {
  std::vector<BlockRate>& rate = problem.rate;
  rate.resize(problem.rate_free.size());
  workers.for_chunks(rate.size(), 1024, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const Mobility& m = problem.mobility[i];
      if (!m.moves()) {
        rate[i] = problem.rate_free[i];
        continue;
      }
      const double* v = lines_[line_[i]].rate;
      rate[i] = {{v[0], v[1]},
                 rotation(m.left) * Mat2{v[2], v[3], v[4], v[5]} * transpose(rotation(m.right))};
    }
  });
}

namespace {

// Records that are written before they are prepared.
constexpr size_t kNear = 16;

// So many records before it is due a row is asked for, and the record to be written.
constexpr size_t kRowAhead = 2, kRecordAhead = 1;

// Records of one colour to a thread: enough for the work to outweigh the handing over.
size_t grain(size_t records, int threads) {
  return std::max<size_t>(
      48, (records + 4 * static_cast<size_t>(threads) - 1) / (4 * static_cast<size_t>(threads)));
}

// Largest of all: the order does not matter.
struct Largest {
  double value = 0;
  Largest& operator+=(const Largest& o) {
    value = std::max(value, o.value);
    return *this;
  }
};

}  // namespace

template <class F, class G>
double GaussSeidel::in_colours(const Workers& workers, F contact, G tie) const {
  const size_t tiles = tile_colours_.size() - 1;
  Largest all = workers.sum_chunks<Largest>(tiles, 1, [&](size_t g, size_t, Largest& most) {
    for (size_t k = tile_colours_[g]; k < tile_colours_[g + 1]; ++k) {
      const Colour& c = colour_[k];
      contact(c.contact_begin, c.contact_end, most.value);
      tie(c.tie_begin, c.tie_end, most.value);
    }
  });
  for (size_t k = tile_colours_[tiles]; k < colour_.size(); ++k) {
    const Colour& c = colour_[k];
    const auto of = [&](size_t n) { return c.in_order ? n : grain(n, workers.threads()); };
    const size_t contacts = c.contact_end - c.contact_begin, ties = c.tie_end - c.tie_begin;
    if (contacts > 0)
      all +=
          workers.sum_chunks<Largest>(contacts, of(contacts), [&](size_t begin, size_t end, Largest& most) {
            contact(c.contact_begin + begin, c.contact_begin + end, most.value);
          });
    if (ties > 0)
      all += workers.sum_chunks<Largest>(ties, of(ties), [&](size_t begin, size_t end, Largest& most) {
        tie(c.tie_begin + begin, c.tie_begin + end, most.value);
      });
  }
  return all.value;
}

void GaussSeidel::write_records(const std::vector<Mobility>& mobility, const RowSet& set,
                                const Workers& workers) {
  const auto write = [&](auto& record, wide::Give& give, const Rows* rows) {
    for (int l = 0; l < kLanes; ++l) {
      const Rows& couple = rows[l];
      const int a = couple.row[0] < 0 ? -1 : seen_[couple.row[0]].block_a;
      record.cross_n[l] = record.cross_t[l] = 0;
      for (int k = 0; k < 2; ++k) {
        const int row = couple.row[k];
        if (row < 0) {
          write_empty(record, give, l, k);
          write_bounds(record.point[k], l, nullptr);
          continue;
        }
        const PointRows& p = set.points[row];
        write_point(mobility, p, set.impulse[row], record, give, l, k, a);
        write_bounds(record.point[k], l, &p);
        if (p.partner < 0) continue;
        record.cross_n[l] = p.cross(0), record.cross_t[l] = p.cross(1);
      }
    }
  };
  // rows lie in the order of the list, which is not that of the sweeps
  const auto fetch = [&](const Rows* rows) {
    for (int l = 0; l < kLanes; ++l)
      for (const int row : rows[l].row) {
        if (row < 0) continue;
        prefetch_all(set.points[row]);
        prefetch(&set.impulse[row]);
      }
  };
  const auto write_all = [&](auto& records, std::vector<wide::Give>& give, const std::vector<Rows>& rows,
                             auto prepare) {
    return [&, prepare](size_t begin, size_t end, double&) {
      // a few at a time: what is written is still near when it is prepared
      for (size_t next, r = begin; r < end; r = next) {
        next = std::min(r + kNear, end);
        for (size_t i = r; i < next; ++i) {
          if (i + kRowAhead < records.size()) fetch(&rows[(i + kRowAhead) * kLanes]);
          if (i + kRecordAhead < records.size())
            prefetch_all(records[i + kRecordAhead]), prefetch_all(give[i + kRecordAhead]);
          write(records[i], give[i], &rows[i * kLanes]);
        }
        prepare(lines_.data(), give.data() + r, records.data() + r, next - r);
      }
    };
  };
  in_colours(workers, write_all(contacts_, contact_give_, contact_rows_, kernels_->prepare_contacts),
             write_all(ties_, tie_give_, tie_rows_, kernels_->prepare_ties));
}

void GaussSeidel::read_records(const Workers& workers, RowSet& set) const {
  const auto read = [&](const auto& records, const std::vector<Rows>& rows) {
    workers.for_chunks(records.size(), 256, [&](size_t begin, size_t end) {
      for (size_t r = begin; r < end; ++r)
        for (size_t l = 0; l < kLanes; ++l)
          for (size_t k = 0; k < 2; ++k) {
            const int row = rows[r * kLanes + l].row[k];
            if (row < 0) continue;
            const auto& p = records[r].point[k];
            set.impulse[row] = {p.p_n[l], p.p_t[l]};
          }
    });
  };
  read(contacts_, contact_rows_);
  read(ties_, tie_rows_);
}

// Largest change of an impulse times the influence of its point on itself [m/s] (theory 5.5).
double GaussSeidel::sweep(const Workers& workers) {
  const auto sweep_records = [&](auto& records, auto kernel) {
    return [&, kernel](size_t begin, size_t end, double& largest) {
      if (begin < end) kernel(lines_.data(), records.data() + begin, end - begin, largest);
    };
  };
  return in_colours(workers, sweep_records(contacts_, kernels_->sweep_contacts),
                    sweep_records(ties_, kernels_->sweep_ties));
}

ContactError GaussSeidel::judge(const Workers& workers) const {
  const auto worst_of = [&](const auto& records, const std::vector<wide::Give>& give,
                            const std::vector<Rows>& rows, auto kernel) {
    return workers.sum_chunks<wide::Worst>(
        records.size(), 256, [&](size_t begin, size_t end, wide::Worst& worst) {
          kernel(lines_.data(), records.data() + begin, give.data() + begin, rows[begin * kLanes].row,
                 end - begin, worst);
        });
  };
  wide::Worst worst = worst_of(contacts_, contact_give_, contact_rows_, kernels_->judge_contacts);
  worst += worst_of(ties_, tie_give_, tie_rows_, kernels_->judge_ties);
  return {worst.error, worst.row};
}

namespace {

// Work of the second phase goes in chunks of fixed size: its sums decide how it goes on.
constexpr size_t kRecords = 64, kLines = 512;

double sum_of(wide::Lanes x) { return (x[0] + x[1]) + (x[2] + x[3]); }

}  // namespace

void GaussSeidel::keep(const Workers& workers) {
  const auto keep_impulses = [&](const auto& records, std::vector<Direction>& direction) {
    direction.resize(2 * records.size());
    workers.for_chunks(records.size(), kRecords, [&](size_t begin, size_t end) {
      for (size_t i = 2 * begin; i < 2 * end; ++i) {
        const auto& p = records[i / 2].point[i % 2];
        direction[i].old_n = p.p_n, direction[i].old_t = p.p_t;
      }
    });
  };
  keep_impulses(contacts_, contact_direction_);
  keep_impulses(ties_, tie_direction_);
  rate_direction_.resize(ground_);
  workers.for_chunks(rate_direction_.size(), kLines, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i)
      std::copy(lines_[i].rate, lines_[i].rate + 6, rate_direction_[i].old.begin());
  });
}

// Nonlinear conjugate gradients with the sweep as the gradient: goes on along the directions of the sweeps
// before, by the ratio of their changes; where changes grow it starts afresh. Impulses and rates go together,
// as the rates are linear in the impulses. The next sweep puts them back within their bounds (theory 5.7).
void GaussSeidel::extrapolate(const Workers& workers, bool first) {
  const auto squared = [&](const auto& records, const std::vector<Direction>& direction) {
    return workers.sum_chunks<double>(records.size(), kRecords, [&](size_t begin, size_t end, double& sum) {
      wide::Lanes s{};
      for (size_t i = 2 * begin; i < 2 * end; ++i) {
        const auto& p = records[i / 2].point[i % 2];
        const wide::Lanes n = p.p_n - direction[i].old_n, t = p.p_t - direction[i].old_t;
        s += n * n * p.u_nn + t * t * p.u_tt;
      }
      sum += sum_of(s);
    });
  };
  const double now = squared(contacts_, contact_direction_) + squared(ties_, tie_direction_);
  const double ratio = first || change_squared_ == 0 ? 0 : now / change_squared_;
  if (first || now < least_squared_) least_squared_ = now;
  const bool good = ratio <= kStillGood && now <= kMostGrowth * least_squared_;
  if (!good) least_squared_ = now;
  change_squared_ = now;
  const double share = good ? std::min(ratio, 1.0) : 0;
  const auto go_on = [&](auto& records, std::vector<Direction>& direction) {
    workers.for_chunks(records.size(), kRecords, [&](size_t begin, size_t end) {
      const wide::Lanes s{share, share, share, share};
      for (size_t i = 2 * begin; i < 2 * end; ++i) {
        auto& p = records[i / 2].point[i % 2];
        Direction& d = direction[i];
        const wide::Lanes along_n = share > 0 ? s * d.d_n : wide::Lanes{},
                          along_t = share > 0 ? s * d.d_t : wide::Lanes{};
        d.d_n = along_n + (p.p_n - d.old_n), d.d_t = along_t + (p.p_t - d.old_t);
        p.p_n += along_n, p.p_t += along_t;
      }
    });
  };
  go_on(contacts_, contact_direction_);
  go_on(ties_, tie_direction_);
  workers.for_chunks(rate_direction_.size(), kLines, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      RateDirection& d = rate_direction_[i];
      for (size_t k = 0; k < 6; ++k) {
        const double along = share > 0 ? share * d.d[k] : 0;
        d.d[k] = along + (lines_[i].rate[k] - d.old[k]);
        lines_[i].rate[k] += along;
      }
    }
  });
}

SolveReport GaussSeidel::solve(const StepProblem& problem, const SolverGoal& goal, const SolverInput& limits,
                               const Workers& workers) {
  const std::vector<Mobility>& mobility = problem.mobility;
  const double dt = problem.dt;
  RowSet& set = problem.rows;
  std::vector<BlockRate>& rate = problem.rate;
  SolveReport report;
  report.converged = set.points.empty();
  if (report.converged) {
    rate = problem.rate_free;
    return report;
  }
  Profile& profile = problem.profile;
  const InPart part(profile, Profile::kLayout);
  if (!layout_holds(set, workers)) lay_out(mobility, problem.tile, workers), ++profile.layouts;
  report.colours = most_colours();
  profile.go_on_with(Profile::kRecords);
  write_lines(mobility, problem.rate_free, workers);
  write_records(mobility, set, workers);

  const auto judge_now = [&] {
    const ContactError e = judge(workers);
    return ContactError{dt * e.worst, e.point};
  };
  // the change of a sweep and its decay tell when it is worth asking the judge, who costs as much as some
  // sweeps
  int ask_again = 0, last = limits.max_sweeps;
  double tolerance = goal.enough, change_before = 0, error_of_change = 0;
  bool first = true;
  double change_at_look = 0;
  const auto hopeless = [&](double change) {
    if (goal.worth == 0 || report.iterations % kBetweenLooks != 0) return false;
    const double decay = report.iterations > kBetweenLooks ? change / change_at_look : 0;
    change_at_look = change;
    if (decay == 0 || change <= tolerance) return false;
    return decay >= 1 || kBetweenLooks * std::log(tolerance / change) / std::log(decay) > goal.worth;
  };
  profile.go_on_with(Profile::kSweeps);
  while (!report.converged && report.iterations < last) {
    const bool second = report.iterations >= kPlainSweeps;
    if (second) keep(workers);
    report.judged.reset();
    const double change = sweep(workers) * dt;
    ++report.iterations, ++profile.sweeps;
    if (!std::isfinite(change)) break;  // a NaN may hide behind later numbers: the judge finds it
    const double decay = change_before > 0 ? std::min(change / change_before, 1.0) : 1;
    change_before = change;
    // once he has spoken, what he found tells more
    const double expected =
        (error_of_change > 0 ? error_of_change : std::max(kErrorOfNext * decay, 1.0)) * change;
    if ((goal.early && expected <= tolerance) ||
        (change <= 0.5 * tolerance && report.iterations >= ask_again)) {
      const InPart asking(profile, Profile::kAsks);
      ++profile.asks;
      report.judged = judge_now();
      const double worst = report.judged->worst;
      if (std::isnan(worst)) break;
      report.converged = worst <= goal.wanted;
      if (!report.converged && worst <= goal.enough && tolerance == goal.enough) {
        tolerance = goal.wanted;
        last = std::min(last, 2 * report.iterations + kSweepsMore);
      }
      if (change > 0) error_of_change = worst / change;
      ask_again = report.iterations + std::max(kSweepsBetween, report.iterations / 5);
    }
    if (!report.converged && hopeless(change)) {
      report.gave_up = true;
      break;
    }
    if (!second || report.converged || report.iterations == last) continue;
    extrapolate(workers, first);
    first = false;
    ++report.second_phase;
  }
  profile.go_on_with(Profile::kRecords);
  if (!report.converged) report.converged = tolerance < goal.enough;  // enough was reached
  read_records(workers, set);
  read_lines(problem, workers);
  if (!report.judged) {
    profile.go_on_with(Profile::kJudge);
    report.judged = judge_now();
  }
  return report;
}

}  // namespace talus
