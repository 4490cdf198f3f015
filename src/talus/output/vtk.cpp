#include "talus/output/vtk.h"

#include <fmt/format.h>

#include <cstdint>

#include "talus/base/error.h"
#include "talus/base/index.h"
#include "talus/output/vtk_arrays.h"

namespace talus {

std::string blocks_vtu(const BlockSet& blocks, const State& state, const std::vector<BlockRate>& rate,
                       const std::vector<GroundMotion>& grounds) {
  TALUS_ASSERT(count_of(rate) == blocks.count);
  std::vector<double> points, displacement, velocity, centroid, gradient, centroid_rate, rate_gradient;
  std::array<std::vector<double>, 3> stress;
  std::vector<int32_t> connectivity, offsets, id, kind, material, group;
  const auto push = [](std::vector<double>& list, const Mat2& m) {
    list.insert(list.end(), {m.xx, m.xy, m.yx, m.yy});
  };
  std::vector<uint8_t> types;
  for (int i = 0; i < blocks.count; ++i) {
    if (blocks.removed(i)) continue;
    for (int v = 0; v < blocks.vertex_count(i); ++v) {
      const Vec2 X = blocks.corner({i, v});
      connectivity.push_back(static_cast<int32_t>(connectivity.size()));
      push3(points, blocks.centroid[i] + offset_now(state, i, X));
      push3(displacement, displacement_shown(state, i, X));
      push3(velocity, velocity_at(rate[i], acting_arm(blocks, state, i, X)));
    }
    const Mat2 s = cauchy_stress(blocks, state, i);
    stress[0].push_back(s.xx), stress[1].push_back(s.yy), stress[2].push_back(s.xy);
    const Vec2 u = displacement_shown(state, i, {});
    centroid.insert(centroid.end(), {u.x, u.y});
    push(gradient, gradient_shown(state, i));
    centroid_rate.insert(centroid_rate.end(), {rate[i].a.x, rate[i].a.y});
    const bool deforms = blocks.kind[i] == BlockKind::kDeformable;
    push(rate_gradient, deforms ? rate[i].G * inverse(kIdentity + state.strain_part[i]) : rate[i].G);
    offsets.push_back(static_cast<int32_t>(connectivity.size()));
    types.push_back(7);  // polygon
    id.push_back(i), kind.push_back(place_of(blocks.kind[i]));
    material.push_back(blocks.material[i]), group.push_back(blocks.group[i]);
  }
  std::string motions;
  for (const GroundMotion& g : grounds) {
    std::vector<double> rows;
    for (size_t i = 0; i < g.displacement.size(); ++i)
      rows.insert(rows.end(), {g.height.empty() ? 0 : g.height[i], g.displacement[i].x, g.displacement[i].y,
                               g.velocity[i].x, g.velocity[i].y});
    motions += field_array(kMotionArray + g.name, 5, rows);
  }
  std::string out = file_begin("UnstructuredGrid") + time_field(state.time, motions);
  out += fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n", connectivity.size(), id.size());
  const auto integers = [](const char* name, const std::vector<int32_t>& v) {
    return data_array("Int32", name, 1, v);
  };
  out += "<Points>\n" + doubles("Points", 3, points) + "</Points>\n<Cells>\n" +
         integers("connectivity", connectivity) + integers("offsets", offsets) +
         data_array("UInt8", "types", 1, types) + "</Cells>\n";
  out += "<PointData>\n" + doubles("displacement [m]", 3, displacement) +
         doubles("velocity [m s-1]", 3, velocity) + "</PointData>\n<CellData>\n";
  for (size_t c = 0; c < stress.size(); ++c) out += doubles(kStressArrays[c], 1, stress[c]);
  out += doubles(kCentroidArray, 2, centroid) + doubles(kGradientArray, 4, gradient) +
         doubles(kVelocityArray, 2, centroid_rate) + doubles(kRateArray, 4, rate_gradient) +
         integers("block", id) + integers("kind", kind) + integers("material", material) +
         integers("group", group) + "</CellData>\n";
  return out + "</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
}

}  // namespace talus
