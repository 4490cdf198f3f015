#include "talus/output/bolt_lines.h"

#include <fmt/format.h>

#include "talus/output/vtk_arrays.h"

namespace talus {

std::string bolts_vtp(const std::vector<BoltLine>& lines, double time) {
  std::vector<double> points, axial, shear, elongation;
  std::vector<int64_t> condition, crossing, connectivity, offsets;
  for (const BoltLine& l : lines) {
    push3(points, l.from), push3(points, l.to);
    axial.push_back(l.axial), shear.push_back(l.shear), elongation.push_back(l.elongation);
    condition.push_back(l.condition), crossing.push_back(l.crossing);
    for (int end = 0; end < 2; ++end) connectivity.push_back(static_cast<int64_t>(connectivity.size()));
    offsets.push_back(static_cast<int64_t>(connectivity.size()));
  }
  std::string out = file_begin("PolyData") + time_field(time);
  out += fmt::format(
      "<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"0\" NumberOfLines=\"{}\" NumberOfStrips=\"0\" "
      "NumberOfPolys=\"0\">\n",
      2 * lines.size(), lines.size());
  out += "<Points>\n" + doubles("Points", 3, points) + "</Points>\n<Lines>\n" +
         integers("connectivity", connectivity) + integers("offsets", offsets) + "</Lines>\n";
  out += "<CellData>\n" + doubles("axial force [N]", 1, axial) + doubles("shear force [N]", 1, shear) +
         doubles("elongation [m]", 1, elongation) + integers("condition", condition) +
         integers("crossing", crossing) + "</CellData>\n";
  return out + "</Piece>\n</PolyData>\n</VTKFile>\n";
}

const Columns<BoltRow, Cell>& bolt_columns() {
  using R = BoltRow;
  static const Columns<BoltRow, Cell> columns{
      {"stage", "", [](const R& r) { return r.stage; }},
      {"t", "s", [](const R& r) { return r.time; }},
      {"bolt", "", [](const R& r) { return r.line.bolt; }},
      {"piece", "", [](const R& r) { return int64_t{r.line.piece}; }},
      {"kind", "", [](const R& r) { return r.line.crossing ? "crossing" : "segment"; }},
      {"x", "m", [](const R& r) { return 0.5 * (r.line.from.x + r.line.to.x); }, Over::kLast, 9},
      {"y", "m", [](const R& r) { return 0.5 * (r.line.from.y + r.line.to.y); }, Over::kLast, 9},
      {"axial_force", "N", [](const R& r) { return r.line.axial; }, Over::kLast, 9},
      {"shear_force", "N", [](const R& r) { return r.line.shear; }, Over::kLast, 9},
      {"elongation", "m", [](const R& r) { return r.line.elongation; }, Over::kLast, 9},
      {"state", "", [](const R& r) { return kBoltConditions.at(r.line.condition); }}};
  return columns;
}

}  // namespace talus
