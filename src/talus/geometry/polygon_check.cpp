#include "talus/geometry/polygon_check.h"

#include <fmt/format.h>
#include <stdexcept>

#include "talus/geometry/geos.h"

namespace talus {

namespace {

Vec2 point_of(const GEOSGeometry* point) {
  Vec2 p;
  GEOSGeomGetX_r(geos().context(), point, &p.x);
  GEOSGeomGetY_r(geos().context(), point, &p.y);
  return p;
}

}  // namespace

std::string polygon_defect(const Polygon& polygon) {
  if (polygon.size() < 3) return fmt::format("has {} corners; a polygon needs at least 3", polygon.size());
  for (size_t i = 0; i < polygon.size(); ++i) {
    const size_t j = (i + 1) % polygon.size();
    if (polygon[i] == polygon[j]) {
      return fmt::format("has an edge of length zero: corners {} and {} are both ({:g}, {:g})", i + 1, j + 1,
                         polygon[i].x, polygon[i].y);
    }
  }
  const Vec2 origin = polygon[0];
  const auto g = geos().make_polygon(polygon, origin);
  GEOSGeometry* where = nullptr;
  char* reason = nullptr;
  const char valid = g ? GEOSisValidDetail_r(geos().context(), g.get(), 0, &reason, &where) : char{0};
  std::string text;
  if (valid != 1) {
    const std::string why = reason ? reason : "no polygon";
    const auto at = geos().own(where);
    const Vec2 p = at ? origin + point_of(at.get()) : origin;
    const bool crosses = why.find("Self") != std::string::npos;
    text = fmt::format("{} at ({:g}, {:g})", crosses ? "crosses or touches itself" : why, p.x, p.y);
  } else {
    GEOSGeom_destroy_r(geos().context(), where);
    const Box box = bounding_box(polygon);
    const double size = std::max(box.max.x - box.min.x, box.max.y - box.min.y);
    // below this the second moments have no digits left
    if (std::abs(signed_area(polygon)) < 2e-7 * size * size)
      text = fmt::format("has no area: its width is below a millionth of its length {:.3g} m", size);
  }
  if (reason) GEOSFree_r(geos().context(), reason);
  return text;
}

Overlap polygon_overlap(const Polygon& a, const Polygon& b) {
  const Vec2 origin = a[0];
  const auto ga = geos().make_polygon(a, origin), gb = geos().make_polygon(b, origin);
  const auto common = geos().own(GEOSIntersection_r(geos().context(), ga.get(), gb.get()));
  if (!common) throw std::runtime_error("the overlay of two block polygons failed");
  Overlap overlap;
  GEOSArea_r(geos().context(), common.get(), &overlap.area);
  if (overlap.area > 0) {
    const auto inside = geos().own(GEOSPointOnSurface_r(geos().context(), common.get()));
    if (inside) overlap.at = origin + point_of(inside.get());
  }
  return overlap;
}

}  // namespace talus
