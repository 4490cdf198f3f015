#include "talus/cut/traces.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "talus/base/index.h"
#include "talus/cut/joint_set.h"
#include "talus/cut/tessellate.h"

namespace talus {

namespace {

class TraceMaker {
 public:
  TraceMaker(const Model& model, const RegionMap& regions, Findings& findings)
      : model_(model), regions_(regions), findings_(findings) {}

  TraceSet make() {
    out_.origins = all_origins(model_, regions_);
    add_openings();
    add_sides();
    add_faults();
    add_surveys();
    add_masonry();
    add_arches();
    add_tessellations();
    add_joint_sets();
    return std::move(out_);
  }

 private:
  int origin(const std::string& name, OriginKind kind) const {
    size_t i = 0;
    while (!(out_.origins[i].kind == kind && out_.origins[i].name == name)) ++i;
    return static_cast<int>(i);
  }

  // The parts inside the regions; their length.
  double add_clipped(Vec2 a, Vec2 b, int region, int origin) {
    double length = 0;
    for (auto& part : regions_.clip(a, b, region)) {
      length += norm(part[1] - part[0]);
      out_.traces.push_back({std::move(part), origin});
    }
    return length;
  }

  void add_ring(const Polygon& ring, int origin, int region = -1) {
    for (size_t k = 0; k < ring.size(); ++k)
      add_clipped(ring[k], ring[(k + 1) % ring.size()], region, origin);
  }

  void add_openings() {
    for (const OpeningInput& o : model_.openings) add_ring(o.polygon, origin(o.name, OriginKind::kOpening));
  }

  void add_sides() {
    for (int i = 0; i < count_of(regions_.list()); ++i) {
      const CutRegion& r = regions_.list()[i];
      for (size_t k = 0; k < r.polygon.size(); ++k) {
        const Vec2 a = r.polygon[k], b = r.polygon[(k + 1) % r.polygon.size()];
        for (auto& part : regions_.uncovered(a, b, i))
          out_.traces.push_back({std::move(part), origin(r.sides[k], OriginKind::kSide)});
      }
    }
  }

  void add_faults() {
    for (const FaultInput& f : model_.faults) {
      const int o = origin(f.name, OriginKind::kFault);
      double length = 0;
      for (size_t k = 0; k + 1 < f.points.size(); ++k)
        length += add_clipped(f.points[k], f.points[k + 1], -1, o);
      if (length == 0)
        findings_.warning(f.where, "fault." + f.name, "has no part in the regions",
                          "are its points in metres?");
    }
  }

  void add_surveys() {
    for (const TracesInput& t : model_.traces) {
      const int o = origin(t.name, OriginKind::kSurveyed);
      SurveyNote note{t.name, count_of(t.lines), 0, 0};
      for (const Polyline& line : t.lines) {
        double length = 0;
        for (size_t k = 0; k + 1 < line.size(); ++k) length += add_clipped(line[k], line[k + 1], -1, o);
        note.length += length;
        note.inside += length > 0;
      }
      if (note.inside == 0)
        findings_.warning(t.where, "traces." + t.name, "have no part in the regions",
                          "are their points in metres?");
      out_.surveys.push_back(std::move(note));
    }
  }

  void add_masonry() {
    for (const MasonryInput& m : model_.masonry) {
      const int beds = origin(m.name + "-bed", OriginKind::kMasonry);
      const int heads = origin(m.name + "-head", OriginKind::kMasonry);
      const Box box = regions_.box(m.region);
      const auto first_course = static_cast<int64_t>(std::floor((box.min.y - m.origin.y) / m.height));
      const auto last_course = static_cast<int64_t>(std::ceil((box.max.y - m.origin.y) / m.height));
      for (int64_t j = first_course; j < last_course; ++j) {
        const double y0 = m.origin.y + m.height * static_cast<double>(j),
                     y1 = m.origin.y + m.height * static_cast<double>(j + 1);
        add_clipped({box.min.x, y0}, {box.max.x, y0}, m.region, beds);
        const double x0 = m.origin.x + (j % 2 != 0 ? m.overlap * m.length : 0);
        const auto last = static_cast<int64_t>(std::ceil((box.max.x - x0) / m.length));
        for (auto i = static_cast<int64_t>(std::floor((box.min.x - x0) / m.length)); i <= last; ++i) {
          const double x = x0 + m.length * static_cast<double>(i);
          add_clipped({x, y0}, {x, y1}, m.region, heads);
        }
      }
    }
  }

  void add_arches() {
    for (size_t a = 0; a < model_.arches.size(); ++a) {
      const ArchInput& arch = model_.arches[a];
      const int o = origin(arch.name, OriginKind::kArch);
      const Polygon ring = arch_polygon(arch);
      // joint i runs from the intrados to the extrados: corners are shared to the last bit
      for (int i = 1; i < arch.voussoirs; ++i)
        out_.traces.push_back({{ring[arch.voussoirs - i], ring[arch.voussoirs + 1 + i]}, o});
    }
  }

  void add_tessellations() {
    for (const TessellationInput& t : model_.tessellations) {
      const int o = origin(t.name, OriginKind::kTessellation);
      const Polygon& polygon = regions_.list()[t.region].polygon;
      for (const auto& [a, b] : tessellate(t, polygon, model_.cut.seed)) add_clipped(a, b, t.region, o);
    }
  }

  void add_joint_sets() {
    bool sound = true;
    for (const JointSetInput& set : model_.joint_sets) {
      out_.joint_sets.push_back(describe(set, model_.cut.section_azimuth));
      const JointSetDefect defect = joint_set_defect(set, out_.joint_sets.back(), regions_.box(set.region));
      if (defect.text.empty()) continue;
      findings_.error(defect.where, "joint_set." + set.name + "." + defect.key, defect.text,
                      "docs/theory.md 10.1 says how sets are drawn");
      sound = false;
    }
    if (!sound) return;
    for (size_t i = 0; i < model_.joint_sets.size(); ++i)
      add_joint_set(model_.joint_sets[i], out_.joint_sets[i]);
  }

  void add_joint_set(const JointSetInput& set, JointSetNote& note) {
    const int o = origin(set.name, OriginKind::kJointSet);
    for (const auto& [a, b] : joint_set_lines(set, note, model_.cut, regions_.box(set.region))) {
      const double length = add_clipped(a, b, set.region, o);
      note.length += length;
      note.traces += length > 0;
    }
    if (note.traces == 0)
      findings_.warning(set.where, "joint_set." + set.name, "has no joint in the regions",
                        "its spacing may be wider than they are, or its origin far away with few traces");
  }

  const Model& model_;
  const RegionMap& regions_;
  Findings& findings_;
  TraceSet out_;
};

}  // namespace

std::vector<Origin> all_origins(const Model& model, const RegionMap& regions) {
  std::vector<Origin> list;
  const auto glued = [&model](int joint) { return joint >= 0 ? joint : model.bonded_joint; };
  for (const OpeningInput& o : model.openings)
    list.push_back({o.name, OriginKind::kOpening, o.kept ? glued(o.joint) : -1, o.where});
  for (const CutRegion& r : regions.list()) {
    for (const std::string& side : r.sides) {
      const auto known = [&side](const Origin& o) { return o.kind == OriginKind::kSide && o.name == side; };
      if (std::none_of(list.begin(), list.end(), known))
        list.push_back({side, OriginKind::kSide, -1, r.where});
    }
  }
  for (const FaultInput& f : model.faults) list.push_back({f.name, OriginKind::kFault, f.joint, f.where});
  for (const TracesInput& t : model.traces) list.push_back({t.name, OriginKind::kSurveyed, t.joint, t.where});
  for (const MasonryInput& m : model.masonry) {
    list.push_back({m.name + "-bed", OriginKind::kMasonry, m.bed_joint, m.where});
    list.push_back({m.name + "-head", OriginKind::kMasonry, m.head_joint, m.where});
  }
  for (const ArchInput& a : model.arches) list.push_back({a.name, OriginKind::kArch, a.joint, a.where});
  for (const TessellationInput& t : model.tessellations)
    list.push_back({t.name, OriginKind::kTessellation, glued(t.joint), t.where});
  for (const JointSetInput& s : model.joint_sets)
    list.push_back({s.name, OriginKind::kJointSet, s.joint, s.where});
  return list;
}

TraceSet make_traces(const Model& model, const RegionMap& regions, Findings& findings) {
  return TraceMaker(model, regions, findings).make();
}

}  // namespace talus
