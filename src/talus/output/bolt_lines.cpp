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

std::string bolts_csv_head() {
  return "stage,t [s],bolt,piece,kind,x [m],y [m],axial_force [N],shear_force [N],elongation [m],state\n";
}

std::string bolts_csv_rows(const std::string& stage, double time, const std::vector<BoltLine>& lines) {
  static constexpr const char* kCondition[] = {"elastic", "yielded", "ruptured"};
  std::string out;
  for (const BoltLine& l : lines) {
    const Vec2 middle = 0.5 * (l.from + l.to);
    out += fmt::format("{},{:.17g},{},{},{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{}\n", stage, time, l.bolt,
                       l.piece, l.crossing ? "crossing" : "segment", middle.x, middle.y, l.axial, l.shear,
                       l.elongation, kCondition[l.condition]);
  }
  return out;
}

}  // namespace talus
