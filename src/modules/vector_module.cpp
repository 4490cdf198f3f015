// The module that reads vector files with GDAL/OGR. Nothing else of talus knows that library.

#include <cpl_conv.h>
#include <cpl_error.h>
#include <gdal.h>
#include <ogr_api.h>
#include <ogr_srs_api.h>

#include <cmath>
#include <memory>
#include <string>

#include "talus/base/angle.h"
#include "talus/base/version.h"
#include "talus/maps/vector_module.h"

namespace talus::maps {

namespace {

constexpr int kMostFeatures = 1000000;

struct CloseDataset {
  void operator()(void* dataset) const { GDALClose(dataset); }
};
struct DestroyFeature {
  void operator()(void* feature) const { OGR_F_Destroy(feature); }
};
struct DestroyGeometry {
  void operator()(void* geometry) const { OGR_G_DestroyGeometry(geometry); }
};

// What the library says while it works: nothing may be printed behind the user's back.
class Messages {
 public:
  Messages() { CPLPushErrorHandlerEx(&Messages::take, this); }
  ~Messages() { CPLPopErrorHandler(); }
  Messages(const Messages&) = delete;
  Messages& operator=(const Messages&) = delete;

  std::string first_failure;
  int failures = 0;
  std::string first_warning;
  int warnings = 0;

 private:
  static void CPL_STDCALL take(CPLErr kind, CPLErrorNum, const char* text) {
    auto& self = *static_cast<Messages*>(CPLGetErrorHandlerUserData());
    if (kind == CE_Failure || kind == CE_Fatal) {
      if (self.failures++ == 0) self.first_failure = text;
    } else if (kind == CE_Warning) {
      if (self.warnings++ == 0) self.first_warning = text;
    }
  }
};

// A setting of the library for as long as this lives, in this thread only.
class Setting {
 public:
  Setting(const char* key, const std::string& value) : key_(key) {
    CPLSetThreadLocalConfigOption(key, value.c_str());
  }
  ~Setting() { CPLSetThreadLocalConfigOption(key_, nullptr); }
  Setting(const Setting&) = delete;
  Setting& operator=(const Setting&) = delete;

 private:
  const char* key_;
};

class Reader {
 public:
  Reader(GDALDatasetH dataset, double curve_step, Drawing& out)
      : dataset_(dataset), curve_step_(curve_step), out_(out), is_dxf_(out.format == "DXF") {}

  bool read(std::string& error) {
    for (int i = 0; i < GDALDatasetGetLayerCount(dataset_); ++i) {
      OGRLayerH layer = GDALDatasetGetLayer(dataset_, i);
      take_unit(layer);
      if (!error_.empty()) return error = error_, false;
      OGR_L_ResetReading(layer);
      int64_t read = 0;
      while (const std::unique_ptr<void, DestroyFeature> f{OGR_L_GetNextFeature(layer)}) {
        if (++read > kMostFeatures) return error = "has more than a million features: is it a map?", false;
        take_feature(OGR_L_GetName(layer), f.get());
      }
    }
    if (above_ > 0)
      out_.notes.push_back(std::to_string(above_) +
                           " of its lines are not level: their heights are left out");
    return true;
  }

 private:
  void take_unit(OGRLayerH layer) {
    if (is_dxf_) return;  // it has none, and counting reads, and fails, once more
    if (OGR_L_GetFeatureCount(layer, TRUE) == 0) return;
    OGRSpatialReferenceH system = OGR_L_GetSpatialRef(layer);
    const bool first = layers_++ == 0;
    if (first) system_ = system;
    const bool same =
        (system == nullptr) == (system_ == nullptr) && (!system || OSRIsSame(system, system_) != 0);
    if (!same) {
      error_ = std::string("its layer ") + OGR_L_GetName(layer) +
               " is not in the coordinate system of the first: save the layers that you need in one";
      return;
    }
    if (!system || !first) return;
    if (OSRIsGeographic(system)) {
      out_.geographic = true;
      return;
    }
    char* name = nullptr;
    const double unit = OSRGetLinearUnits(system, &name);
    const std::string source =
        std::string("its coordinate system, in ") + (name && *name ? name : "units without a name");
    out_.unit = unit, out_.unit_source = source;
  }

  void take_feature(const char* layer_name, OGRFeatureH f) {
    Feature feature;
    feature.layer = layer_name;
    feature.id = "feature " + std::to_string(OGR_F_GetFID(f));
    for (int i = 0; i < OGR_F_GetFieldCount(f); ++i) {
      if (!OGR_F_IsFieldSetAndNotNull(f, i)) continue;
      feature.attributes[OGR_Fld_GetNameRef(OGR_F_GetFieldDefnRef(f, i))] = OGR_F_GetFieldAsString(f, i);
    }
    std::string kind = "feature";
    if (is_dxf_) {
      const auto attribute = [&feature](const char* key) {
        const auto it = feature.attributes.find(key);
        return it == feature.attributes.end() ? std::string() : it->second;
      };
      feature.layer = attribute("Layer");
      feature.id = "entity " + attribute("EntityHandle");
      if (attribute("PaperSpace") == "1") return leave_out(feature, "entity", "lies in paper space");
      if (!attribute("Text").empty() && OGR_F_GetGeometryRef(f) &&
          wkbFlatten(OGR_G_GetGeometryType(OGR_F_GetGeometryRef(f))) == wkbPoint)
        return leave_out(feature, "TEXT", "is no line or point");
      const std::string classes = attribute("SubClasses");
      if (classes.find("Dimension") != std::string::npos || classes.find("Leader") != std::string::npos)
        return leave_out(feature, "annotation", "is no line or point");
      kind = "entity";
    }
    OGRGeometryH geometry = OGR_F_GetGeometryRef(f);
    if (!geometry || OGR_G_IsEmpty(geometry)) return leave_out(feature, kind, "has no geometry");
    const std::unique_ptr<void, DestroyGeometry> straight{
        OGR_G_GetLinearGeometry(geometry, curve_step_ / kDegree, nullptr)};
    take_geometry(feature, straight ? straight.get() : geometry);
  }

  void take_geometry(const Feature& feature, OGRGeometryH g) {
    switch (wkbFlatten(OGR_G_GetGeometryType(g))) {
      case wkbPoint:
        return take_points(feature, g, {.is_point = true});
      case wkbLineString:
        return take_points(feature, g, {});
      case wkbPolygon:
        if (is_dxf_) return leave_out(feature, "filled area", "is no line or point");
        for (int i = 0; i < OGR_G_GetGeometryCount(g); ++i)
          take_points(feature, OGR_G_GetGeometryRef(g, i), {.is_area = true, .is_hole = i > 0});
        return;
      case wkbMultiPoint:
      case wkbMultiLineString:
      case wkbMultiPolygon:
      case wkbGeometryCollection:
        for (int i = 0; i < OGR_G_GetGeometryCount(g); ++i)
          take_geometry(feature, OGR_G_GetGeometryRef(g, i));
        return;
      default:
        return leave_out(feature, OGR_G_GetGeometryName(g), "is no line or point");
    }
  }

  struct Shape {
    bool is_point = false, is_area = false, is_hole = false;
  };

  void take_points(Feature feature, OGRGeometryH g, const Shape& shape) {
    if (OGR_G_GetPointCount(g) == 0) return leave_out(feature, "part of a feature", "has no geometry");
    feature.is_point = shape.is_point, feature.is_area = shape.is_area, feature.is_hole = shape.is_hole;
    double low = 0, high = 0;
    for (int i = 0; i < OGR_G_GetPointCount(g); ++i) {
      const Vec2 p{OGR_G_GetX(g, i), OGR_G_GetY(g, i)};
      if (!std::isfinite(p.x) || !std::isfinite(p.y))
        return leave_out(feature, "feature", "has a coordinate that is no number");
      const double z = OGR_G_GetZ(g, i);
      low = i == 0 ? z : std::min(low, z), high = i == 0 ? z : std::max(high, z);
      feature.points.push_back(p);
    }
    above_ += high > low;
    out_.features.push_back(std::move(feature));
  }

  void leave_out(const Feature& feature, const std::string& what, const std::string& reason) {
    out_.leave_out(feature.layer, what, reason);
  }

  GDALDatasetH dataset_;
  double curve_step_;
  Drawing& out_;
  bool is_dxf_;
  int above_ = 0, layers_ = 0;
  OGRSpatialReferenceH system_ = nullptr;  // of the first layer that holds anything
  std::string error_;
};

bool read(const std::string& path, double curve_step, Drawing& out, std::string& error) {
  GDALAllRegister();
  Messages messages;
  const Setting parts("DXF_MERGE_BLOCK_GEOMETRIES", "FALSE");  // entities of a block keep their layers
  const Setting step("OGR_ARC_STEPSIZE", std::to_string(curve_step / kDegree));
  const char* const drivers[] = {"DXF", "ESRI Shapefile", "GPKG", "GeoJSON", nullptr};
  const std::unique_ptr<void, CloseDataset> dataset{GDALOpenEx(
      path.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR, drivers, nullptr, nullptr)};
  if (!dataset) {
    error = "is no DXF, shapefile, GeoPackage or GeoJSON that can be read";
    if (!messages.first_failure.empty()) error += " (" + messages.first_failure + ")";
    return false;
  }
  out.format = GDALGetDriverShortName(GDALGetDatasetDriver(dataset.get()));
  Reader reader(dataset.get(), curve_step, out);
  if (!reader.read(error)) return false;
  const bool is_dxf = out.format == "DXF";
  if (messages.failures > 0 && !is_dxf) {
    error = "is damaged: " + messages.first_failure;
    return false;
  }
  out.unreadable = messages.failures, out.first_failure = messages.first_failure;
  if (messages.warnings > 0) out.notes.push_back(messages.first_warning);
  return true;
}

}  // namespace

}  // namespace talus::maps

extern "C" {
// found by dlsym
extern const talus::maps::VectorModule talus_vector_module;
const talus::maps::VectorModule talus_vector_module{talus::kVersion, sizeof(talus::maps::Drawing),
                                                    sizeof(talus::maps::Feature), &talus::maps::read};
}
