#include "talus/supports/ground.h"

#include <cmath>

#include "talus/base/index.h"
#include "talus/cut/joint_set.h"
#include "talus/model/joint_law.h"

namespace talus {

namespace {

class JointFinder {
 public:
  JointFinder(const Model& model, std::string& trouble) : model_(model), trouble_(trouble) {}

  void add_grid(const GridInput& g) {
    if (g.pattern != GridPattern::kRectangles && law_of(g.joint).is_soft()) trouble_ = g.name;
    const Vec2 along{std::cos(g.place.angle), std::sin(g.place.angle)};
    add_set(g.joint, along, g.columns / (g.max.x - g.min.x));
    add_set(g.joint, turn_left(along), g.rows / (g.max.y - g.min.y));
  }

  // Edges of a mesh run in any direction: what their give adds up to is not known.
  void add_meshes() {
    for (const MeshInput& m : model_.meshes)
      if (law_of(m.joint).is_soft()) trouble_ = m.name;
  }

  void add_region(int region) {
    const RegionInput& r = model_.regions[region];
    const int own = r.joint >= 0 ? r.joint : model_.default_joint;
    const auto soft = [&](int joint) { return law_of(joint >= 0 ? joint : own).is_soft(); };
    const auto here = [region](int of) { return of < 0 || of == region; };
    for (const TessellationInput& t : model_.tessellations)
      if (here(t.region) && law_of(t.joint).is_soft()) trouble_ = t.name;
    for (const TracesInput& t : model_.traces)
      if (soft(t.joint)) trouble_ = t.name;
    for (const MasonryInput& m : model_.masonry)
      if (here(m.region) && (soft(m.bed_joint) || soft(m.head_joint))) trouble_ = m.name;
    for (const JointSetInput& s : model_.joint_sets) {
      if (!here(s.region)) continue;
      const JointSetNote note = describe(s, model_.cut.section_azimuth);
      const double trace = s.trace_length.mean, there = trace > 0 ? trace / (trace + s.gap.mean) : 1;
      add_set(s.joint >= 0 ? s.joint : own, {-std::sin(note.angle), std::cos(note.angle)},
              there / note.spacing);
    }
  }

  std::vector<JointsOfRock> sets;

 private:
  JointLaw law_of(int joint) const { return joint < 0 ? JointLaw() : JointLaw(model_.joints[joint]); }

  void add_set(int joint, Vec2 normal, double frequency) {
    const JointLaw law = law_of(joint);
    if (law.is_soft()) sets.push_back({normal, frequency, law.stiffness(0), law.stiffness(1)});
  }

  const Model& model_;
  std::string& trouble_;
};

}  // namespace

// Eq. 4.5.
Stiffness jointed_stiffness(const PlaneModuli& rock, const std::vector<JointsOfRock>& joints) {
  // compliance: of the rock, and (1/S) N^T Z N of each set, N from stress to traction, Z its 2 x 2 compliance
  const double d = rock.c11 * rock.c11 - rock.c12 * rock.c12;
  Stiffness s{{{rock.c11 / d, -rock.c12 / d, 0}, {-rock.c12 / d, rock.c11 / d, 0}, {0, 0, 1 / rock.c33}}};
  for (const JointsOfRock& j : joints) {
    const Vec2 n = j.normal;
    const double zn = j.kn > 0 ? 1 / j.kn : 0, zs = j.ks > 0 ? 1 / j.ks : 0;
    const Mat2 z{zs + (zn - zs) * n.x * n.x, (zn - zs) * n.x * n.y, (zn - zs) * n.x * n.y,
                 zs + (zn - zs) * n.y * n.y};
    const Vec2 column[3] = {{n.x, 0}, {0, n.y}, {n.y, n.x}};
    for (size_t p = 0; p < 3; ++p)
      for (size_t q = 0; q < 3; ++q) s[p][q] += j.frequency * dot(column[p], z * column[q]);
  }
  // inverse of a symmetric 3 x 3 by cofactors
  const auto minor = [&s](size_t p, size_t q) {
    const size_t r0 = (p + 1) % 3, r1 = (p + 2) % 3, c0 = (q + 1) % 3, c1 = (q + 2) % 3;
    return s[r0][c0] * s[r1][c1] - s[r0][c1] * s[r1][c0];
  };
  const double whole = s[0][0] * minor(0, 0) + s[0][1] * minor(0, 1) + s[0][2] * minor(0, 2);
  Stiffness c;
  for (size_t p = 0; p < 3; ++p)
    for (size_t q = 0; q < 3; ++q) c[p][q] = minor(q, p) / whole;
  return c;
}

std::vector<JointsOfRock> joints_around(const Model& model, const Layout& layout, const BlockShape& block,
                                        std::string& trouble) {
  // groups are the blocks, the grids, the meshes, then what was cut, the regions first
  const int group = block.group;
  const int first_cut = layout.first_cut_group, blocks = count_of(model.blocks);
  JointFinder finder(model, trouble);
  if (group >= blocks && group - blocks < count_of(model.grids))
    finder.add_grid(model.grids[group - blocks]);
  else if (group >= blocks && group < first_cut)
    finder.add_meshes();
  else if (group >= first_cut && group - first_cut < count_of(model.regions))
    finder.add_region(group - first_cut);
  return finder.sets;
}

Ground ground_at(const Model& model, const Layout& layout, const BlockShape& block, int material,
                 std::string& trouble) {
  const Material& m = model.materials[material];
  return {m.density, jointed_stiffness(plane_moduli(m.young, m.poisson, model.plane),
                                       joints_around(model, layout, block, trouble))};
}

}  // namespace talus
