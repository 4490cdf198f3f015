#include "talus/output/contact_points.h"

#include <fmt/format.h>

#include <algorithm>

#include "talus/output/vtk_arrays.h"

namespace talus {

std::string ContactColumn::array() const {
  std::string out = title();
  std::replace(out.begin(), out.end(), '_', ' ');
  return out;
}

std::string contacts_vtp(const std::vector<FramePoint>& all, double time) {
  std::vector<double> points, force;
  std::vector<int32_t> order, ends;
  for (const FramePoint& c : all) {
    push3(points, c.point), push3(force, c.force);
    order.push_back(static_cast<int32_t>(order.size())), ends.push_back(static_cast<int32_t>(order.size()));
  }
  std::string out = file_begin("PolyData") + time_field(time);
  out += fmt::format(
      "<Piece NumberOfPoints=\"{0}\" NumberOfVerts=\"{0}\" NumberOfLines=\"0\" NumberOfStrips=\"0\" "
      "NumberOfPolys=\"0\">\n",
      all.size());
  out += "<Points>\n" + doubles("Points", 3, points) + "</Points>\n<Verts>\n" +
         data_array("Int32", "connectivity", 1, order) + data_array("Int32", "offsets", 1, ends) +
         "</Verts>\n";
  out += "<PointData>\n" + doubles("force [N]", 3, force);
  for (const ContactColumn& column : contact_columns()) {
    std::vector<double> values;
    for (const FramePoint& c : all) values.push_back(column.of(c));
    out += column.whole()
               ? data_array("Int32", column.array(), 1, std::vector<int32_t>(values.begin(), values.end()))
               : doubles(column.array(), 1, values);
  }
  return out + "</PointData>\n</Piece>\n</PolyData>\n</VTKFile>\n";
}

}  // namespace talus
