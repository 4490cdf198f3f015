#include "talus/supports/bolts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "talus/base/error.h"
#include "talus/base/index.h"
#include "talus/supports/bar.h"

namespace talus {

namespace {

// The bar inside a block acts on it as an explicit force: below this share of the rock's own stiffness that
// does not touch the stable step (theory 4.21).
constexpr double kMostStiffening = 0.05;

// Direction of a material line of a block as it lies now, unit.
Vec2 direction_now(const State& state, int block, Vec2 d) {
  const Vec2 now = d + state.strain_part[block] * d;
  return now / norm(now);
}

Vec2 displacement_of(const State& state, const BoltNode& n) { return displacement_at(state, n.block, n.arm); }

// Where a crossing is now.
struct CrossingNow {
  Vec2 along;                   // unit, from the node before to the node after
  double axial = 0, shear = 0;  // displacement of the node after against the node before [m]
};

CrossingNow crossing_now(const State& state, const Bolt& bolt, const BoltCrossing& c) {
  const int j = c.segment;
  const BoltNode &a = bolt.nodes[j], &b = bolt.nodes[j + 1];
  const Vec2 apart = c.apart + (displacement_of(state, b) - displacement_of(state, a));
  if (bolt.anchored) return {apart / norm(apart), norm(apart) - bolt.segments[j].length, 0};
  const Vec2 sum =
      direction_now(state, a.block, c.direction[0]) + direction_now(state, b.block, c.direction[1]);
  const Vec2 along = sum / norm(sum);
  return {along, dot(along, apart) - bolt.segments[j].length, dot(turn_left(along), apart)};
}

// Elongation of the rock along each segment since installation.
std::vector<double> rock_elongation(const State& state, const Bolt& bolt) {
  std::vector<double> rock(bolt.segments.size());
  for (size_t j = 0; j < rock.size(); ++j) {
    const BoltSegment& s = bolt.segments[j];
    if (s.crossing >= 0) {
      rock[j] = crossing_now(state, bolt, bolt.crossings[s.crossing]).axial;
      continue;
    }
    const Vec2 reference = bolt.nodes[j + 1].arm - bolt.nodes[j].arm;
    const Mat2& H = state.strain_part[bolt.nodes[j].block];
    rock[j] = norm(reference + H * reference) - s.length;
  }
  return rock;
}

void balance(const State& state, Bolt& bolt) {
  for (BoltCrossing& c : bolt.crossings) {
    c.shear = crossing_now(state, bolt, c).shear;
    if (c.shear_stiffness <= 0) continue;
    const double x = c.shear - c.shear_plastic;
    if (c.shear_stiffness * std::abs(x) > c.shear_yield) {
      c.shear_plastic += x - std::copysign(c.shear_yield / c.shear_stiffness, x);
      bolt.segments[c.segment].yielded = true;
    }
  }
  balance_bar(rock_elongation(state, bolt), bolt);
}

// The stage at whose start each block is excavated; past the last one where none does.
std::vector<int> stage_without(const Model& model, const Layout& layout) {
  std::vector<int> out(layout.blocks.size(), count_of(model.stages));
  for (int s = 0; s < count_of(model.stages); ++s)
    for (const std::string& name : model.stages[s].excavate)
      for (const int k : layout.blocks_called(name)) out[k] = s;
  return out;
}

// A bar that is tied to a block loses its hold when the block is taken out: what becomes of it is not known.
void check_excavation(const Model& model, const BlockSet& blocks, const BoltInput& input, const Bolt& bolt,
                      const std::vector<int>& gone, Findings& findings) {
  for (const BoltNode& n : bolt.nodes) {
    const int k = n.block;
    const int stage = gone[k];
    if (stage >= count_of(model.stages)) continue;
    findings.error(input.where, "bolt." + input.name,
                   fmt::format("is tied to block \"{}\", which stage \"{}\" excavates", blocks.name[k],
                               model.stages[stage].name),
                   "let its `stage` be that one or a later one, or move it so that it is tied to rock that "
                   "stays: an anchored bolt at both ends, a grouted one all along");
    return;
  }
}

}  // namespace

void check_bolts(const Model& model, const Layout& layout, const BlockSet& blocks, Findings& findings) {
  if (model.bolts.empty()) return;
  const State start = initial_state(blocks, layout);
  const std::vector<int> gone = stage_without(model, layout);
  BlockSet there = blocks;                          // when the bolt is installed
  std::vector<double> stiffening(blocks.count, 0);  // [Pa m3]
  for (int i = 0; i < count_of(model.bolts); ++i) {
    const BoltInput& input = model.bolts[i];
    std::string trouble;
    for (size_t k = 0; k < gone.size(); ++k)
      there.kind[k] = gone[k] <= input.stage ? BlockKind::kRemoved : blocks.kind[k];
    const std::vector<Bolt> bolts = make_bolt(model, there, start, i, trouble);
    if (!trouble.empty()) {
      findings.error(input.where, "bolt." + input.name, trouble,
                     "bolts begin and end in blocks, where they lie at the start of their stage");
      continue;
    }
    const BoltKind kind = model.bolt_types[input.type].kind;
    if (kind != BoltKind::kSuperposed) check_excavation(model, blocks, input, bolts[0], gone, findings);
    if (kind == BoltKind::kGrouted && bolts[0].crossings.empty())
      findings.warning(input.where, "bolt." + input.name, "crosses no joint: it only stiffens one block",
                       "is it where it should be?");
    for (const Bolt& bolt : bolts)
      for (size_t j = 0; j < bolt.segments.size(); ++j) {
        const BoltSegment& s = bolt.segments[j];
        if (s.crossing < 0) stiffening[bolt.nodes[j].block] += s.stiffness * s.length * s.length;
      }
  }
  for (size_t k = 0; k < stiffening.size(); ++k) {
    if (blocks.kind[k] != BlockKind::kDeformable) continue;
    const double share = stiffening[k] / (blocks.volume[k] * blocks.moduli[k].c33);
    if (share > kMostStiffening)
      findings.warning(model.bolts[0].where, "bolt",
                       fmt::format("bars inside block \"{}\" have {:.0f} % of its shear stiffness",
                                   blocks.name[k], 100 * share),
                       "they may shorten the stable time step: use a smaller safety if the run blows up");
  }
}

void install_bolts(const Model& model, const BlockSet& blocks, int stage, State& state) {
  for (int i = 0; i < count_of(model.bolts); ++i) {
    if (model.bolts[i].stage != stage) continue;
    std::string trouble;
    std::vector<Bolt> bolts = make_bolt(model, blocks, state, i, trouble);
    if (!trouble.empty())
      throw NumericalError(fmt::format(
          "bolt \"{}\" cannot be installed at the start of stage \"{}\": where the blocks lie by then, it {}",
          model.bolts[i].name, model.stages[stage].name, trouble));
    for (Bolt& bolt : bolts) state.bolts.push_back(std::move(bolt));
  }
}

void balance_bolts(State& state) {
  for (Bolt& bolt : state.bolts) balance(state, bolt);
}

// Theory 4.21.
void add_bolt_forces(const BlockSet& blocks, const State& state, std::vector<BlockForce>& force) {
  TALUS_ASSERT(count_of(force) == blocks.count);
  for (const Bolt& bolt : state.bolts) {
    if (bolt.anchored) continue;
    for (size_t j = 0; j < bolt.segments.size(); ++j) {
      const BoltSegment& s = bolt.segments[j];
      const int k = bolt.nodes[j].block;
      if (s.crossing >= 0 || s.force == 0 || blocks.kind[k] != BlockKind::kDeformable) continue;
      const Vec2 reference = bolt.nodes[j + 1].arm - bolt.nodes[j].arm;
      const Vec2 along = direction_now(state, bolt.nodes[j].block, reference);
      force[k].Q += outer((-s.force) * along, reference);  // tension pulls the ends together
    }
  }
}

// Eq. 4.10.
void add_bolt_rows(const BlockSet& blocks, const State& state, const std::vector<BlockRate>& before,
                   const StepClock& clock, RowSet& rows) {
  for (int i = 0; i < count_of(state.bolts); ++i) {
    const Bolt& bolt = state.bolts[i];
    for (const BoltCrossing& c : bolt.crossings) {
      const int j = c.segment;
      const BoltSegment& s = bolt.segments[j];
      const BoltNode &a = bolt.nodes[j], &b = bolt.nodes[j + 1];
      const CrossingNow now = crossing_now(state, bolt, c);
      PointRows p;
      p.block_a = a.block, p.block_b = b.block;
      p.arm_a = acting_arm(blocks, state, a.block, a.arm);
      p.arm_b = acting_arm(blocks, state, b.block, b.arm);
      p.normal = -now.along;  // the tangent is then the left turn of `along`
      p.lower = p.upper = p.cohesion = 0;
      const auto u = relative_velocity(p, before);
      // force_on_a: along the row on the first block, as it is at this instant
      const auto soften = [&](size_t k, double stiffness, double force_on_a) {
        p.row[k].compliance = clock.position_factor() / (stiffness * clock.dt * clock.dt_kick);
        p.row[k].bias = -clock.old_share() * u[k] - p.row[k].compliance * force_on_a * clock.dt_kick;
      };
      if (s.ruptured) {
        p.row[0].compliance = p.row[1].compliance = 1;  // of rows that stay without force
      } else {
        soften(0, c.row_stiffness, -s.force);
        p.lower = -c.most * clock.dt_kick;
        p.upper = bolt.anchored ? 0 : c.most * clock.dt_kick;
        if (c.shear_stiffness > 0) {
          soften(1, c.shear_stiffness, c.shear_stiffness * (c.shear - c.shear_plastic));
          p.cohesion = c.shear_yield * clock.dt_kick;
        } else {
          p.row[1].compliance = 1;
        }
      }
      Impulse guess{c.row[0] * clock.dt_kick, c.row[1] * clock.dt_kick};
      if (s.ruptured) guess = {0, 0};
      rows.add(p, guess, {Family::kBolt, i});
    }
  }
}

void remember_bolts(const RowSet& rows, const StepClock& clock, State& state) {
  TALUS_ASSERT(clock.dt_kick > 0);
  size_t next = rows.range(Family::kBolt).begin;
  for (Bolt& bolt : state.bolts)
    for (BoltCrossing& c : bolt.crossings) {
      const Impulse& p = rows.impulse[next++];
      c.row = {p[0] / clock.dt_kick, p[1] / clock.dt_kick};
    }
  TALUS_ASSERT(next == rows.range(Family::kBolt).end);
}

std::vector<BoltPart> bolt_parts(const BlockSet& blocks, const State& state) {
  std::vector<BoltPart> parts;
  for (const Bolt& bolt : state.bolts) {
    const int first = parts.empty() || parts.back().input != bolt.input ? 0 : parts.back().piece + 1;
    const auto place = [&](const BoltNode& n) {
      const int k = n.block;
      return blocks.centroid[k] + offset_now(state, k, n.arm);
    };
    for (int j = 0; j < count_of(bolt.segments); ++j) {
      const BoltSegment& s = bolt.segments[j];
      BoltPart part;
      part.input = bolt.input, part.piece = first + j, part.crossing = s.crossing >= 0;
      part.from = place(bolt.nodes[j]), part.to = place(bolt.nodes[j + 1]);
      part.axial = s.force / bolt.share;
      if (part.crossing) {
        const BoltCrossing& c = bolt.crossings[s.crossing];
        part.axial = 0.0 - c.row[0] / bolt.share, part.shear = 0.0 + c.row[1] / bolt.share;
      }
      part.elongation = s.stretch;
      part.condition = s.ruptured ? BoltPart::kRuptured : s.yielded ? BoltPart::kYielded : BoltPart::kElastic;
      parts.push_back(part);
    }
  }
  return parts;
}

}  // namespace talus
