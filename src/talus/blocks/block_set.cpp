#include "talus/blocks/block_set.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "talus/base/error.h"
#include "talus/base/index.h"
#include "talus/base/rank.h"
#include "talus/blocks/tiles.h"

namespace talus {

BlockSet::BlockSet() = default;
BlockSet::BlockSet(const BlockSet&) = default;
BlockSet::BlockSet(BlockSet&&) noexcept = default;
BlockSet& BlockSet::operator=(const BlockSet&) = default;
BlockSet& BlockSet::operator=(BlockSet&&) noexcept = default;
BlockSet::~BlockSet() = default;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Least size that the solver's tolerance counts by, as share of the median block's.
constexpr double kLeastOfMedian = 0.1;

// Share of its stable step that a step means for a clamped block.
constexpr double kClampMargin = 0.9;

// Eigenvalues s1 >= s2 of a symmetric matrix and the direction of s1.
struct Eigen2 {
  double s1, s2;
  Vec2 direction1;
};

Eigen2 eigen_symmetric(const Mat2& m) {
  const double mean = 0.5 * (m.xx + m.yy), half = 0.5 * (m.xx - m.yy);
  const double radius = std::hypot(half, m.xy);
  const double angle = 0.5 * std::atan2(m.xy, half);
  const double s1 = mean + radius;
  return {s1, std::max(det(m) / s1, 0.0), {std::cos(angle), std::sin(angle)}};
}

// Largest squared angular frequency of a free block with principal moments s1, s2 (eq. 2.2): the
// stretching modes couple through c12; the shear mode has c33 (1/s1 + 1/s2).
double largest_frequency2(const PlaneModuli& c, double volume, double s1, double s2) {
  const double a = c.c11 / s1, b = c.c11 / s2, off2 = c.c12 * c.c12 / (s1 * s2);
  const double stretch = 0.5 * (a + b) + std::sqrt(0.25 * (a - b) * (a - b) + off2);
  const double shear = c.c33 * (1 / s1 + 1 / s2);
  return volume * std::max(stretch, shear);
}

}  // namespace

PlaneModuli plane_moduli(double young, double poisson, Plane plane) {
  const double c33 = young / (2 * (1 + poisson));
  if (plane == Plane::kStress) {
    const double c11 = young / (1 - poisson * poisson);
    return {c11, poisson * c11, c33};
  }
  const double lambda = young * poisson / ((1 + poisson) * (1 - 2 * poisson));
  return {lambda + 2 * c33, lambda, c33};
}

// Theory 1.2, 1.3.
BlockSet build_blocks(const Model& model, const Layout& layout) {
  TALUS_ASSERT(layout.sound);
  BlockSet set;
  set.thickness = model.thickness;
  set.vertex_begin.push_back(0);
  for (const BlockShape& shape : layout.blocks) {
    const Material& material = model.materials[shape.material];
    const PolygonMoments m = polygon_moments(shape.polygon);
    const double lump = model.inertia == Inertia::kLumped && shape.kind == BlockKind::kDeformable ? 3 : 1;
    const Mat2 inertia = (lump * material.density * model.thickness) * m.second;

    ++set.count;
    set.name.push_back(shape.name);
    set.group.push_back(shape.group);
    set.kind.push_back(shape.kind);
    set.material.push_back(shape.material);
    set.centroid.push_back(m.centroid);
    set.volume.push_back(m.area * model.thickness);
    set.mass.push_back(material.density * m.area * model.thickness);
    set.inertia.push_back(inertia);
    set.inertia_inverse.push_back(inverse(inertia));
    set.polar_inertia.push_back(trace(inertia));
    const Eigen2 e = eigen_symmetric(inertia);
    set.axis.push_back(e.direction1);
    set.principal.push_back({e.s1, e.s2});
    set.moduli.push_back(shape.kind == BlockKind::kDeformable
                             ? plane_moduli(material.young, material.poisson, model.plane)
                             : PlaneModuli{});
    set.size.push_back(std::sqrt(m.area));
    set.radius.push_back(0);
    for (const Vec2 p : shape.polygon) {
      set.arm.push_back(p - m.centroid);
      set.radius.back() = std::max(set.radius.back(), norm(set.arm.back()));
    }
    set.thinness.push_back(m.area / (2 * set.radius.back()));
    set.vertex_begin.push_back(count_of(set.arm));
  }
  set.tile = tiles_of(set.centroid);
  return set;
}

double smallest_size(const BlockSet& blocks) {
  return blocks.count == 0 ? 0 : *std::min_element(blocks.size.begin(), blocks.size.end());
}

double tolerance_size(const BlockSet& blocks) {
  if (blocks.count == 0) return 0;
  return std::max(smallest_size(blocks), kLeastOfMedian * median(blocks.size));
}

double stable_step_of(const BlockSet& blocks, int i) {
  if (blocks.kind[i] != BlockKind::kDeformable) return kInfinity;
  const Eigen2 e = eigen_symmetric(blocks.inertia[i]);
  return 2 / std::sqrt(largest_frequency2(blocks.moduli[i], blocks.volume[i], e.s1, e.s2));
}

StableStep stable_step(const BlockSet& blocks) {
  StableStep least{kInfinity, -1};
  for (int i = 0; i < blocks.count; ++i) {
    const double dt = stable_step_of(blocks, i);
    if (dt < least.dt) least = {dt, i};
  }
  return least;
}

// Theory 2.6.
void clamp_moments(BlockSet& blocks, double dt) {
  TALUS_ASSERT(dt > 0);
  // a mode exactly at its limit grows linearly: clamped blocks stay a tenth below it
  const double allowed = 4 * kClampMargin * kClampMargin / (dt * dt);
  for (int i = 0; i < blocks.count; ++i) {
    if (stable_step_of(blocks, i) >= dt) continue;
    const Eigen2 e = eigen_symmetric(blocks.inertia[i]);
    const PlaneModuli& c = blocks.moduli[i];
    const auto fits = [&](double s1, double s2) {
      return largest_frequency2(c, blocks.volume[i], s1, s2) <= allowed;
    };

    // bisect on s2, raised up to s1; a block too small in both directions is raised as a whole
    double s1 = e.s1, s2 = e.s2;
    if (!fits(s1, s1)) s1 = s2 = s1 * largest_frequency2(c, blocks.volume[i], s1, s1) / allowed * (1 + 1e-12);
    double low = e.s2, high = s1;
    for (int n = 0; n < 200 && high - low > 1e-13 * high; ++n) {
      const double middle = 0.5 * (low + high);
      (fits(s1, middle) ? high : low) = middle;
    }
    s2 = high;

    const Vec2 d1 = e.direction1, d2 = turn_left(d1);
    blocks.inertia[i] = s1 * outer(d1, d1) + s2 * outer(d2, d2);
    blocks.inertia_inverse[i] = inverse(blocks.inertia[i]);
    blocks.polar_inertia[i] = s1 + s2;
    blocks.principal[i] = {s1, s2};
    ++blocks.clamped;
    blocks.largest_clamp = std::max(blocks.largest_clamp, s2 / e.s2);
  }
}

}  // namespace talus
