// From the line of a bolt and the blocks as they lie to its nodes, segments and crossings.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "talus/base/index.h"
#include "talus/supports/bar.h"
#include "talus/supports/bolt_path.h"
#include "talus/supports/bolts.h"

namespace talus {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A piece of rock shorter than this share of the diameter holds no bar.
constexpr double kLeastPiece = 0.1;

// Free length of the bar across a closed joint, as share of the diameter: no more than keeps numbers finite.
constexpr double kClosed = 1e-6;

// Segments of a grouted bolt. A bar hands its force over to the grout along centimetres (theory 4.21), and a tenth of a
// millimetre of a metre tells nothing more; what they take is time and memory.
constexpr int kMostSegments = 10000;

// So much of a bolt may stick out of the rock at either end, as share of its length.
constexpr double kMostOutside = 0.05;

// Of the stiffness of the rows over that of the bar: room for what the blocks' own strains do to it
// (theory 4.21).
constexpr double kRowMargin = 1.25;

class BoltMaker {
 public:
  BoltMaker(const Model& model, const BlockSet& blocks, const State& state, int input)
      : type_(model.bolt_types[model.bolts[input].type]),
        blocks_(blocks),
        state_(state),
        index_(input),
        from_(model.bolts[input].from),
        share_(model.thickness / type_.spacing) {
    const Vec2 line = model.bolts[input].to - from_;
    length_ = norm(line), along_ = line / length_;
  }

  std::vector<Bolt> make(std::string& trouble) {
    const BoltPath path = path_through(blocks_, state_, from_, from_ + length_ * along_, least());
    trouble = path.trouble;
    if (!trouble.empty()) return {};
    if (path.pieces.front().from > kMostOutside * length_)
      trouble = "begins outside the blocks";
    else if (path.pieces.back().to < (1 - kMostOutside) * length_)
      trouble = "ends outside the blocks";
    else if (type_.kind == BoltKind::kAnchored && path.pieces.front().block == path.pieces.back().block)
      trouble = "begins and ends in the same block \"" + name(path.pieces.front().block) +
                "\": an anchored bolt there holds nothing";
    else if (type_.kind == BoltKind::kGrouted && length_ > kMostSegments * type_.segment_length)
      trouble = fmt::format("has more than {} segments: {:g} m in pieces of {:g} m (segment_length)",
                            kMostSegments, length_, type_.segment_length);
    if (!trouble.empty()) return {};
    switch (type_.kind) {
      case BoltKind::kAnchored:
        return {anchored(path.pieces)};
      case BoltKind::kGrouted:
        return {grouted(path.pieces)};
      case BoltKind::kSuperposed:
        break;
    }
    std::vector<Bolt> bolts;
    for (const PathPiece& p : path.pieces) bolts.push_back(superposed(p));
    return bolts;
  }

 private:
  double least() const { return std::max(kLeastPiece * type_.diameter, 1e-9 * length_); }
  std::string name(int block) const { return blocks_.name[block]; }
  double axial() const { return type_.axial_stiffness() * share_; }
  double closed() const { return kClosed * type_.diameter; }

  Bolt empty() const {
    Bolt bolt;
    bolt.input = index_, bolt.share = share_, bolt.rupture_strain = type_.rupture_strain;
    return bolt;
  }

  // The node at a distance along the line, held over a length of grout.
  BoltNode node(int block, double at, double grouted) const {
    const Vec2 place = ((from_ - blocks_.centroid[block]) + at * along_) - state_.displacement[block];
    BoltNode n;
    n.block = block;
    n.arm = inverse(kIdentity + state_.strain_part[block]) * place;
    n.stiffness = type_.grout_stiffness * grouted * share_;
    n.limit = type_.bond_strength * grouted * share_;
    return n;
  }

  void fix(BoltNode& n) const { n.stiffness = axial() / closed(), n.limit = kInfinity; }

  BoltSegment segment(double length, double gauge) const {
    BoltSegment s;
    s.length = length, s.gauge = gauge;
    s.stiffness = axial() / std::max(length, closed());
    s.yield = type_.yield_force * share_;
    s.start = s.plastic = -type_.pretension * share_ / s.stiffness;
    return s;
  }

  // Between the last two nodes, which lie in one block.
  void add_inside(Bolt& bolt) const {
    const BoltNode &a = bolt.nodes[bolt.nodes.size() - 2], &b = bolt.nodes.back();
    const Vec2 reference = b.arm - a.arm;
    const double length = norm(reference + state_.strain_part[a.block] * reference);
    bolt.segments.push_back(segment(length, length));
  }

  // Between the last two nodes, which lie in different blocks.
  void add_crossing(double gap, double gauge, Bolt& bolt) const {
    const BoltNode &a = bolt.nodes[bolt.nodes.size() - 2], &b = bolt.nodes.back();
    BoltSegment s = segment(gap, gauge);
    s.crossing = count_of(bolt.crossings);
    BoltCrossing c;
    c.segment = count_of(bolt.segments);
    c.direction[0] = reference_direction(a.block), c.direction[1] = reference_direction(b.block);
    c.apart = gap * along_ - (displacement(b) - displacement(a));
    c.row = {-type_.pretension * share_, 0};
    c.most = s.yield;
    if (gap <= type_.diameter && type_.kind == BoltKind::kGrouted) {
      c.shear_stiffness = type_.dowel_stiffness * share_;
      c.shear_yield = type_.dowel_yield * share_;
    }
    bolt.segments.push_back(s);
    bolt.crossings.push_back(c);
  }

  Vec2 displacement(const BoltNode& n) const { return displacement_at(state_, n.block, n.arm); }

  Vec2 reference_direction(int block) const {
    const Vec2 d = inverse(kIdentity + state_.strain_part[block]) * along_;
    return d / norm(d);
  }

  Bolt anchored(const std::vector<PathPiece>& pieces) const {
    Bolt bolt = empty();
    bolt.anchored = true;
    const double begin = pieces.front().from, end = pieces.back().to;
    bolt.nodes = {node(pieces.front().block, begin, 0), node(pieces.back().block, end, 0)};
    for (BoltNode& n : bolt.nodes) fix(n);
    add_crossing(end - begin, end - begin, bolt);
    bolt.crossings[0].row_stiffness = bolt.segments[0].stiffness;
    return bolt;
  }

  Bolt superposed(const PathPiece& piece) const {
    Bolt bolt = empty();
    bolt.nodes = {node(piece.block, piece.from, 0), node(piece.block, piece.to, 0)};
    for (BoltNode& n : bolt.nodes) fix(n);
    add_inside(bolt);
    return bolt;
  }

  Bolt grouted(const std::vector<PathPiece>& pieces) const {
    Bolt bolt = empty();
    double last = 0;  // length of the segments of the piece before
    for (size_t i = 0; i < pieces.size(); ++i) {
      const PathPiece& p = pieces[i];
      const int n = std::max(1, static_cast<int>(std::ceil((p.to - p.from) / type_.segment_length - 1e-9)));
      const double h = (p.to - p.from) / n;
      for (int k = 0; k <= n; ++k) {
        bolt.nodes.push_back(node(p.block, p.from + k * h, k == 0 || k == n ? 0.5 * h : h));
        if (k > 0) {
          add_inside(bolt);
        } else if (i > 0) {
          const double gap = p.from - pieces[i - 1].to;
          if (pieces[i - 1].block == p.block)
            add_inside(bolt);
          else
            add_crossing(gap, 0.5 * (last + h) + gap, bolt);
        }
      }
      last = h;
    }
    if (type_.plate || type_.pretension > 0) fix(bolt.nodes.front());
    if (type_.pretension > 0) fix(bolt.nodes.back());
    limit_crossings(bolt);
    return bolt;
  }

  // What a crossing can pass on, and the stiffness of its row.
  void limit_crossings(Bolt& bolt) const {
    std::vector<int> segments;
    for (BoltCrossing& c : bolt.crossings) {
      double before = 0, after = 0;
      for (int i = 0; i < count_of(bolt.nodes); ++i) (i <= c.segment ? before : after) += bolt.nodes[i].limit;
      c.most = std::min({c.most, before, after});
      segments.push_back(c.segment);
    }
    const std::vector<double> stiffness = elastic_stiffness(bolt, segments);
    for (size_t k = 0; k < stiffness.size(); ++k) bolt.crossings[k].row_stiffness = kRowMargin * stiffness[k];
  }

  const BoltType& type_;
  const BlockSet& blocks_;
  const State& state_;
  const int index_;
  const Vec2 from_;
  const double share_;
  double length_ = 0;
  Vec2 along_;
};

}  // namespace

std::vector<Bolt> make_bolt(const Model& model, const BlockSet& blocks, const State& state, int input,
                            std::string& trouble) {
  return BoltMaker(model, blocks, state, input).make(trouble);
}

}  // namespace talus
