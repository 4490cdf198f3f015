#include "talus/output/vtk.h"

#include <fmt/format.h>

#include <cstdint>

#include "talus/base/error.h"
#include "talus/output/vtk_arrays.h"

namespace talus {

std::string blocks_vtu(const BlockSet& blocks, const State& state, const std::vector<BlockRate>& rate) {
  TALUS_ASSERT(rate.size() == static_cast<size_t>(blocks.count));
  std::vector<double> points, displacement, velocity, stress;
  std::vector<int64_t> connectivity, offsets, id, kind, material, group;
  std::vector<uint8_t> types;
  for (int i = 0; i < blocks.count; ++i) {
    const auto k = static_cast<size_t>(i);
    if (blocks.removed(i)) continue;
    for (int v = 0; v < blocks.vertex_count(i); ++v) {
      const Vec2 X = blocks.corner({i, v});
      connectivity.push_back(static_cast<int64_t>(connectivity.size()));
      push3(points, blocks.centroid[k] + offset_now(state, k, X));
      push3(displacement, displacement_shown(state, k, X));
      push3(velocity, velocity_at(rate[k], acting_arm(blocks, state, k, X)));
    }
    const Mat2 s = cauchy_stress(blocks, state, i);
    stress.insert(stress.end(), {s.xx, s.yy, s.xy});
    offsets.push_back(static_cast<int64_t>(connectivity.size()));
    types.push_back(7);  // polygon
    id.push_back(i), kind.push_back(static_cast<int>(blocks.kind[k]));
    material.push_back(blocks.material[k]), group.push_back(blocks.group[k]);
  }
  std::string out = file_begin("UnstructuredGrid") + time_field(state.time);
  out += fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n", connectivity.size(), id.size());
  out += "<Points>\n" + doubles("Points", 3, points) + "</Points>\n<Cells>\n" +
         integers("connectivity", connectivity) + integers("offsets", offsets) +
         data_array("UInt8", "types", 1, types) + "</Cells>\n";
  out += "<PointData>\n" + doubles("displacement [m]", 3, displacement) +
         doubles("velocity [m s-1]", 3, velocity) + "</PointData>\n";
  out += "<CellData>\n" + doubles("stress xx yy xy [Pa]", 3, stress) + integers("block", id) +
         integers("kind", kind) + integers("material", material) + integers("group", group) + "</CellData>\n";
  return out + "</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
}

std::string contacts_vtp(const std::vector<ContactFrame>& contacts, double time) {
  std::vector<double> points, force, normal, shear, gap, slip, opening;
  std::vector<int64_t> kind, state, connectivity, offsets;
  std::vector<int32_t> block_a, block_b, corner, edge, partner;
  for (const ContactFrame& c : contacts) {
    block_a.push_back(c.block_a), block_b.push_back(c.block_b);
    corner.push_back(c.corner), edge.push_back(c.edge), partner.push_back(c.partner);
    push3(points, c.point);
    push3(force, c.force);
    normal.push_back(c.normal_force), shear.push_back(c.shear_force), gap.push_back(c.gap);
    slip.push_back(c.slip), opening.push_back(c.opening);
    kind.push_back(c.kind), state.push_back(c.state);
    connectivity.push_back(static_cast<int64_t>(connectivity.size()));
    offsets.push_back(static_cast<int64_t>(connectivity.size()));
  }
  std::string out = file_begin("PolyData") + time_field(time);
  out += fmt::format(
      "<Piece NumberOfPoints=\"{0}\" NumberOfVerts=\"{0}\" NumberOfLines=\"0\" NumberOfStrips=\"0\" "
      "NumberOfPolys=\"0\">\n",
      contacts.size());
  out += "<Points>\n" + doubles("Points", 3, points) + "</Points>\n<Verts>\n" +
         integers("connectivity", connectivity) + integers("offsets", offsets) + "</Verts>\n";
  out += "<PointData>\n" + doubles("force [N]", 3, force) + doubles("normal force [N]", 1, normal) +
         doubles("shear force [N]", 1, shear) + doubles("gap [m]", 1, gap) + doubles("slip [m]", 1, slip) +
         doubles("opening [m]", 1, opening) + integers("kind", kind) + integers("state", state) +
         data_array("Int32", "block a", 1, block_a) + data_array("Int32", "block b", 1, block_b) +
         data_array("Int32", "corner", 1, corner) + data_array("Int32", "edge", 1, edge) +
         data_array("Int32", "partner", 1, partner) + "</PointData>\n";
  return out + "</Piece>\n</PolyData>\n</VTKFile>\n";
}

}  // namespace talus
