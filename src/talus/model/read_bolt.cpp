#include "talus/model/read_bolt.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "talus/base/index.h"
#include "talus/model/model_sections.h"

namespace talus {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kMostBolts = 10000;  // of a pattern

// Force across a joint per displacement along it, of a bar on an elastic foundation of the grout's stiffness
// on both sides (theory 4.21) [N/m].
double dowel_of_beam(const BoltType& t) {
  const double bending = t.young * kPi * std::pow(t.diameter, 4) / 64;
  return t.grout_stiffness / (4 * std::pow(t.grout_stiffness / (4 * bending), 0.25));
}

// Where the ray from `centre` meets the outline last; `centre` itself when it never does.
Vec2 on_outline(const Polygon& polygon, Vec2 centre, Vec2 ray) {
  double far = 0;
  for (size_t k = 0; k < polygon.size(); ++k) {
    const Vec2 a = polygon[k] - centre, b = polygon[(k + 1) % polygon.size()] - centre;
    const double ha = cross(ray, a), hb = cross(ray, b);
    if ((ha > 0) != (hb > 0)) far = std::max(far, dot(ray, a + ha / (ha - hb) * (b - a)));
  }
  return centre + far * ray;
}

class BoltReader : private ModelSections {
 public:
  using ModelSections::ModelSections;

  void read() {
    for_named("bolt_type", [this](const std::string& name, const Fields& f) { read_type(name, f); });
    for_list("bolt", [this](const Fields& f) { read_bolt(f); });
    for_list("bolt_pattern", [this](const Fields& f) { read_pattern(f); });
    for (int i = 0; i < count_of(model_.bolt_types); ++i) {
      const std::string& name = model_.bolt_types[i].name;
      const bool used = std::any_of(model_.bolts.begin(), model_.bolts.end(),
                                    [i](const BoltInput& b) { return b.type == i; });
      if (!used && !is_left_out("bolt", "type", name) && !is_left_out("bolt_pattern", "type", name))
        findings_.warning(model_.bolt_types[i].where, "bolt_type." + name, "is used by no bolt",
                          "name it in a [[bolt]] or [[bolt_pattern]]");
    }
  }

 private:
  // --- types ---

  void read_type(const std::string& name, const Fields& f) {
    auto t = f.filled<BoltType>();
    t.name = name;
    const auto kind = f.get<std::string>("kind");
    t.yield_force = f.get("yield_force",
                          f.given("yield_stress") ? f.get<double>("yield_stress") * t.area() : t.yield_force);
    t.dowel_stiffness = f.get("dowel_stiffness", dowel_of_beam(t));
    t.dowel_yield = f.get("dowel_yield", t.yield_force / std::sqrt(3.0));
    if (f.given("yield_stress") && f.given("yield_force"))
      error(f, "yield_force", "is given beside yield_stress", "give one of the two");
    if (!(t.pretension < t.yield_force))
      error(f, "pretension",
            fmt::format("{:g} N is not below the yield force {:g} N", t.pretension, t.yield_force),
            "use a thicker bar or less pretension");
    if (t.pretension / t.axial_stiffness() >= t.rupture_strain)
      error(f, "rupture_strain",
            fmt::format("is reached by the pretension, which stretches the bar by {:.3g}",
                        t.pretension / t.axial_stiffness()),
            "is it meant in percent? 0.05 is 5 %");
    if (std::isfinite(t.rupture_strain) && t.yield_force / t.axial_stiffness() > t.rupture_strain &&
        std::isfinite(t.yield_force))
      error(f, "rupture_strain", "is reached before the bar yields", "is it meant in percent? 0.05 is 5 %");
    if (!kind.empty() && kind != "grouted")
      for (const char* key :
           {"grout_stiffness", "bond_strength", "dowel_stiffness", "dowel_yield", "segment_length", "plate"})
        if (f.given(key)) error(f, key, "is only for kind = \"grouted\"", "leave it out");
    model_.bolt_types.push_back(t);
  }

  // --- bolts ---

  // Type and stage; false when the bolt cannot be.
  bool begin(const Fields& f, BoltInput& b) {
    claim_name(f, names_, "bolt");
    b.name = f.get<std::string>("name");
    b.where = f.where();
    b.type = refer(f, "type", model_.bolt_types, "bolt_type");
    if (f.has("stage")) b.stage = refer(f, "stage", model_.stages, "stage");
    if (b.type >= 0 && b.stage >= 0 && b.stage < count_of(model_.stages) &&
        model_.stages[b.stage].kind == StageKind::kDynamic && model_.bolt_types[b.type].pretension > 0)
      findings_.warning(f.where(), f.path(),
                        fmt::format("is tensioned at once at the start of dynamic stage \"{}\": a blow",
                                    model_.stages[b.stage].name),
                        "install it in a static stage");
    return b.type >= 0 && b.stage >= 0;
  }

  void read_bolt(const Fields& f) {
    BoltInput b;
    const bool sound = begin(f, b);
    b.from = f.get<Vec2>("from"), b.to = f.get<Vec2>("to");
    if (f.has("from") && f.has("to") && b.from == b.to)
      error(f, "to", "is where the bolt begins", "give its other end");
    else if (sound && f.has("from") && f.has("to"))
      model_.bolts.push_back(b);
  }

  // --- patterns ---

  void read_pattern(const Fields& f) {
    BoltInput b;
    const bool sound = begin(f, b);
    const auto kind = f.get<std::string>("kind");
    if (kind.empty() || !f.has("length")) return;
    const bool radial = kind == "radial";
    for (const char* key : {"from", "to", "spacing", "direction"})
      if (radial && f.given(key)) error(f, key, "is only for kind = \"row\"", "leave it out");
    for (const char* key :
         {"opening", "center", "radius", "count", "angle_spacing", "angle_from", "angle_to"})
      if (!radial && f.given(key)) error(f, key, "is only for kind = \"radial\"", "leave it out");
    const auto lines = radial ? radial_lines(f) : row_lines(f);
    if (!sound) return;
    const std::string name = b.name;
    for (size_t i = 0; i < lines.size(); ++i) {
      b.name = fmt::format("{}[{}]", name, i);
      b.from = lines[i].first, b.to = lines[i].second;
      model_.bolts.push_back(b);
    }
  }

  using Lines = std::vector<std::pair<Vec2, Vec2>>;

  Lines radial_lines(const Fields& f) {
    const bool circle = f.given("center") && f.given("radius"), part = f.given("center") || f.given("radius");
    if (f.given("opening") == part || part != circle) {
      findings_.error(f.where(), f.path(), "does not say around what",
                      "give either opening = \"NAME\", or center = [x, y] and radius");
      return {};
    }
    const int opening = refer(f, "opening", model_.openings, "opening");
    if (!circle && opening < 0) return {};
    const std::vector<double> angles = angles_of(f);
    const double length = f.get<double>("length");
    Lines lines;
    for (const double angle : angles) {
      const Vec2 ray{std::cos(angle), std::sin(angle)};
      const Polygon* outline = circle ? nullptr : &model_.openings[opening].polygon;
      if (outline && outline->size() < 3) return {};  // told where it was read
      const Vec2 head = circle ? f.get<Vec2>("center") + f.get<double>("radius") * ray
                               : on_outline(*outline, polygon_moments(*outline).centroid, ray);
      lines.emplace_back(head, head + length * ray);
    }
    return lines;
  }

  std::vector<double> angles_of(const Fields& f) {
    if (f.given("count") == f.given("angle_spacing")) {
      findings_.error(f.where(), f.path(),
                      f.given("count") ? "says twice how many bolts" : "does not say how many bolts",
                      "give one of count, angle_spacing");
      return {};
    }
    const bool around = !f.given("angle_to");
    const double first = f.get("angle_from", 0.0),
                 range = around ? 2 * kPi : f.get<double>("angle_to") - first;
    if (range <= 0 || range > 2 * kPi * (1 + 1e-12)) {
      error(f, "angle_to", "must lie above angle_from, by at most 360 deg", "angles go counter-clockwise");
      return {};
    }
    if (!f.has("count") && !f.has("angle_spacing")) return {};  // wrong, and told
    int count = static_cast<int>(f.get<int64_t>("count", 0));
    double step = f.get("angle_spacing", 0.0);
    if (count > 0) {
      step = around ? range / count : count > 1 ? range / (count - 1) : 0;
    } else {
      const double wanted = std::floor(range / step * (1 + 1e-12)) + 1;
      if (wanted > kMostBolts) {
        error(f, "angle_spacing", fmt::format("makes {:g} bolts", wanted), "is a unit missing?");
        return {};
      }
      count = static_cast<int>(wanted);
    }
    if (step > 0 && step * count > 2 * kPi * (1 + 1e-9))
      count = static_cast<int>(std::lround(2 * kPi / step));
    std::vector<double> angles;
    for (int i = 0; i < count; ++i) angles.push_back(first + step * i);
    return angles;
  }

  Lines row_lines(const Fields& f) {
    for (const char* key : {"from", "to", "spacing", "direction"})
      if (!f.has(key)) {
        if (!f.given(key)) error(f, key, "is missing", "a row needs from, to, spacing and direction");
        return {};
      }
    const Vec2 from = f.get<Vec2>("from"), line = f.get<Vec2>("to") - from;
    const double angle = f.get<double>("direction"), spacing = f.get<double>("spacing");
    const double count = std::floor(norm(line) / spacing * (1 + 1e-12)) + 1;
    if (count > kMostBolts) {
      error(f, "spacing", fmt::format("makes {:g} bolts", count), "is a unit missing?");
      return {};
    }
    Lines lines;
    for (int i = 0; i < static_cast<int>(count); ++i) {
      const Vec2 head = norm(line) > 0 ? from + (i * spacing / norm(line)) * line : from;
      lines.emplace_back(head, head + f.get<double>("length") * Vec2{std::cos(angle), std::sin(angle)});
    }
    return lines;
  }

  std::set<std::string> names_;
};

}  // namespace

void read_bolt_sections(const TomlSource& source, Model& model, Findings& findings) {
  BoltReader(source, model, findings).read();
}

}  // namespace talus
