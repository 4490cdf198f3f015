#include "talus/cut/expected.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "talus/base/index.h"
#include "talus/base/text.h"
#include "talus/cut/joint_set.h"
#include "talus/cut/regions.h"

namespace talus {

namespace {

// Of a block while it is cut and checked, and while it runs with some four contacts [bytes].
constexpr double kBytesPerBlock = 5000;
// Blocks and their points are counted with 32 bits.
constexpr double kMostBlocks = 5e7;

constexpr double kPi = 3.14159265358979323846;

// Lines of one direction, or of all, in one region.
struct Family {
  const Where* where;
  std::string path;
  double length = 0;  // [m]
  double lines = 0;
  double angle = 0;  // [rad]; of surveyed traces none
  bool any_angle = false;
};

class Estimate {
 public:
  explicit Estimate(const Model& model) : model_(model), regions_(model) {}

  std::vector<ExpectedPart> all() {
    for (const GridInput& g : model_.grids) {
      const double cells = static_cast<double>(g.columns) * static_cast<double>(g.rows);
      const bool crossed = g.pattern == GridPattern::kCrossedTriangles;
      add("grid." + g.name, g.where, crossed ? 4 * cells : cells);
    }
    if (!model_.cut.blocks_file.empty()) return std::move(parts_);
    for (const MasonryInput& m : model_.masonry)
      add("masonry." + m.name, m.where, area(m.region) / (m.length * m.height));
    for (const TessellationInput& t : model_.tessellations)
      add("tessellation." + t.name, t.where, (t.triangles ? 2 : 1) * area(t.region) / (t.size * t.size));
    for (int r = 0; r < count_of(regions_.list()); ++r) add_region(r);
    return std::move(parts_);
  }

 private:
  void add(const std::string& path, const Where& where, double blocks) {
    if (blocks > 0) parts_.push_back({path, where, blocks});
  }

  double area(int region) const {
    double sum = 0;
    for (int r = 0; r < count_of(regions_.list()); ++r)
      if (region < 0 || region == r) sum += std::abs(signed_area(regions_.list()[r].polygon));
    return sum;
  }

  // Euler's formula: faces are crossings less dead traces, and one more; the crossings go to the section that
  // has more lines.
  void add_region(int r) {
    const double size = area(r);
    std::vector<Family> families;
    for (const JointSetInput& set : model_.joint_sets) {
      if (set.region >= 0 && set.region != r) continue;
      const JointSetNote note = describe(set, model_.cut.section_azimuth);
      if (!(note.spacing > 0)) continue;  // told elsewhere
      const double cycle = set.trace_length.mean + set.gap.mean;
      const bool through = !(set.trace_length.mean > 0);
      const double whole = size / note.spacing;
      families.push_back({&set.where_spacing, "joint_set." + set.name + ".spacing",
                          through ? whole : whole * set.trace_length.mean / cycle,
                          through ? 0 : whole / cycle, note.angle, false});
    }
    for (const TracesInput& t : model_.traces) {
      Family f{&t.where, "traces." + t.name, 0, static_cast<double>(t.lines.size()), 0, true};
      for (const Polyline& line : t.lines)
        for (size_t k = 0; k + 1 < line.size(); ++k) f.length += norm(line[k + 1] - line[k]);
      const double share = size / area(-1);
      f.length *= share, f.lines *= share;
      families.push_back(f);
    }
    double lines = 0, crossings = 0;
    std::vector<double> of(families.size(), 0);
    for (size_t i = 0; i < families.size(); ++i) {
      lines += families[i].lines;
      for (size_t j = 0; j <= i; ++j) {
        const Family &a = families[i], &b = families[j];
        if (i == j && !a.any_angle) continue;  // parallel
        const double sine = a.any_angle || b.any_angle ? 2 / kPi : std::abs(std::sin(a.angle - b.angle));
        const double here = (i == j ? 0.5 : 1) * a.length * b.length / size * sine;
        crossings += here;
        of[a.length > b.length ? i : j] += here;
      }
    }
    for (size_t i = 0; i < families.size(); ++i)
      add(families[i].path, *families[i].where,
          of[i] > 0 ? std::max(0.0, crossings - lines) * of[i] / crossings : 0);
  }

  const Model& model_;
  RegionMap regions_;
  std::vector<ExpectedPart> parts_;
};

}  // namespace

std::vector<ExpectedPart> expected_blocks(const Model& model) { return Estimate(model).all(); }

void check_expected(const Model& model, double memory, Findings& findings) {
  const std::vector<ExpectedPart> parts = expected_blocks(model);
  double blocks = 0;
  for (const ExpectedPart& p : parts) blocks += p.blocks;
  const double most = std::min(memory / kBytesPerBlock, kMostBlocks);
  if (!(blocks > most)) return;
  const ExpectedPart& dearest =
      *std::max_element(parts.begin(), parts.end(),
                        [](const ExpectedPart& a, const ExpectedPart& b) { return a.blocks < b.blocks; });
  findings.error(dearest.where, dearest.path,
                 fmt::format("makes most of about {:.2g} blocks, which need {}; room is for about {:.2g}",
                             blocks, readable_bytes(blocks * kBytesPerBlock), most),
                 "is a unit missing? Else coarser, or a smaller region");
}

}  // namespace talus
