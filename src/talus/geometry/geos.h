#pragma once
// Owning handles of GEOS geometries. Not for use outside geometry/.

#include <geos_c.h>

#include <cstring>
#include <memory>
#include <new>
#include <utility>
#include <vector>

#include "talus/geometry/polygon.h"

namespace talus {

/// One GEOS context and the geometries made in it, released together.
class Geos {
 public:
  Geos() : context_(GEOS_init_r()) {
    // the reason of a failure is asked for where it matters; nothing may be printed behind the user's back
    GEOSContext_setErrorMessageHandler_r(
        context_,
        [](const char* why, void* self) {
          if (std::strstr(why, "bad_alloc")) static_cast<Geos*>(self)->no_memory_ = true;
        },
        this);
    GEOSContext_setNoticeMessageHandler_r(
        context_, [](const char*, void*) {}, nullptr);
  }
  ~Geos() { GEOS_finish_r(context_); }
  Geos(const Geos&) = delete;
  Geos& operator=(const Geos&) = delete;

  struct Release {
    GEOSContextHandle_t context;
    void operator()(GEOSGeometry* g) const { GEOSGeom_destroy_r(context, g); }
  };
  using Handle = std::unique_ptr<GEOSGeometry, Release>;

  /// Throws std::bad_alloc where there is no geometry for want of memory.
  Handle own(GEOSGeometry* g) const {
    check(g != nullptr);
    return Handle(g, Release{context_});
  }
  GEOSContextHandle_t context() const { return context_; }

  // Coordinates relative to `origin`: far from zero the overlay would lose digits.
  Handle make_polygon(const Polygon& polygon, Vec2 origin) const {
    const auto n = static_cast<unsigned>(polygon.size());
    GEOSCoordSequence* points = GEOSCoordSeq_create_r(context_, n + 1, 2);
    check(points != nullptr);
    for (unsigned i = 0; i <= n; ++i) {
      const Vec2 p = polygon[i % n] - origin;
      GEOSCoordSeq_setXY_r(context_, points, i, p.x, p.y);
    }
    GEOSGeometry* ring = GEOSGeom_createLinearRing_r(context_, points);
    return own(ring ? GEOSGeom_createPolygon_r(context_, ring, nullptr, 0) : nullptr);
  }

  /// Polylines relative to `origin` as one geometry.
  Handle make_lines(const std::vector<std::vector<Vec2>>& lines, Vec2 origin) const {
    std::vector<GEOSGeometry*> parts;
    parts.reserve(lines.size());
    for (const std::vector<Vec2>& line : lines) {
      GEOSCoordSequence* points = GEOSCoordSeq_create_r(context_, static_cast<unsigned>(line.size()), 2);
      check(points != nullptr);
      for (unsigned i = 0; i < line.size(); ++i)
        GEOSCoordSeq_setXY_r(context_, points, i, line[i].x - origin.x, line[i].y - origin.y);
      GEOSGeometry* g = GEOSGeom_createLineString_r(context_, points);
      check(g != nullptr);
      if (g) parts.push_back(g);
    }
    return own(GEOSGeom_createCollection_r(context_, GEOS_MULTILINESTRING, parts.data(),
                                           static_cast<unsigned>(parts.size())));
  }

  /// Corners of a line string or ring.
  std::vector<Vec2> corners_of(const GEOSGeometry* line) const {
    const GEOSCoordSequence* points = GEOSGeom_getCoordSeq_r(context_, line);
    unsigned n = 0;
    GEOSCoordSeq_getSize_r(context_, points, &n);
    std::vector<Vec2> list(n);
    for (unsigned i = 0; i < n; ++i) GEOSCoordSeq_getXY_r(context_, points, i, &list[i].x, &list[i].y);
    return list;
  }

 private:
  void check(bool made) const {
    if (!made && std::exchange(no_memory_, false)) throw std::bad_alloc();
  }

  GEOSContextHandle_t context_;
  mutable bool no_memory_ = false;  // told since it was last asked
};

inline const Geos& geos() {
  thread_local Geos instance;  // a GEOS context serves one thread
  return instance;
}

}  // namespace talus
