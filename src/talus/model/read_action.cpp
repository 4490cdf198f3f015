#include "talus/model/read_action.h"

#include <algorithm>
#include <cmath>

#include "talus/model/model_sections.h"

namespace talus {

namespace {

// Velocity at the end of a record, as share of its largest, that is no round-off.
constexpr double kStillMoving = 1e-2;

class ActionReader : private ModelSections {
 public:
  using ModelSections::ModelSections;

  void read() {
    for_list("support", [this](const Fields& f) { read_support(f); });
    for_list("boundary", [this](const Fields& f) { read_boundary(f); });
    for_list("load", [this](const Fields& f) { read_load(f); });
  }

 private:
  // A segment given as two points.
  void read_segment(const Fields& f, std::string_view key, Selection& s) {
    if (!f.has(key)) return;
    const auto points = f.get<std::vector<Vec2>>(key);
    s.is_edge = true;
    if (points.size() != 2 || points[0] == points[1])
      error(f, key, "must be a segment: two different points");
    else
      s.from = points[0], s.to = points[1];
  }

  void read_line_name(const Fields& f, std::string_view key, Selection& s) {
    s.along = f.get<std::string>(key);
    if (f.has(key) && s.along.empty())
      error(f, key, "is empty", "name a side of a region, an opening, a fault or a joint set");
  }

  // One of point, edge and along.
  void read_place(const Fields& f, bool with_point, Selection& s) {
    const int places = (with_point && f.given("point")) + f.given("edge") + f.given("along");
    if (places != 1)
      findings_.error(f.where(), f.path(), places > 1 ? "has more than one place" : "has no place",
                      with_point ? "give one of point = [x, y], edge = [[x0, y0], [x1, y1]], along = \"NAME\""
                                 : "give one of edge = [[x0, y0], [x1, y1]], along = \"NAME\"");
    read_line_name(f, "along", s);
    if (with_point) s.from = s.to = f.get<Vec2>("point");
    read_segment(f, "edge", s);
  }

  void read_block_name(const Fields& f, Selection& s) {
    s.where_block = f.where("block");
    s.block = f.get<std::string>("block");
  }

  int history(const Fields& f, std::string_view key) { return refer(f, key, model_.histories, "history"); }

  void read_support(const Fields& f) {
    claim_name(f, supports_, "support");
    auto s = f.filled<SupportInput>();
    read_place(f, true, s);
    read_block_name(f, s);
    s.x = motion(f, "x", model_.histories);
    s.y = motion(f, "y", model_.histories);
    s.stages = stages(f, model_.stages);
    if (s.x.kind == Motion::kFree && s.y.kind == Motion::kFree)
      findings_.error(f.where(), f.path(), "is free along x and y: it supports nothing");
    model_.supports.push_back(s);
  }

  // --- boundaries ---

  void read_boundary(const Fields& f) {
    claim_name(f, boundaries_, "boundary");
    auto b = f.filled<BoundaryInput>();
    b.where_material = f.where("material");
    b.stages = stages(f, model_.stages);
    const auto kind = f.get<std::string>("kind");
    const BoundaryEntry& of_kind = entry(b.kind);
    read_place(f, false, b);
    read_block_name(f, b);
    b.material = refer(f, "material", model_.materials, "material");
    b.history_x = history(f, "velocity_x");
    b.history_y = history(f, "velocity_y");
    check_quantity(f, "velocity_x", b.history_x, model_.histories, "velocity");
    check_quantity(f, "velocity_y", b.history_y, model_.histories, "velocity");
    b.outcrop = f.get<std::string>("motion") == "outcrop";
    if (!kind.empty() && of_kind.no_motion.empty()) {
      check_input_motion(f);
      warn_still_moving(f, "velocity_x", b.history_x);
      warn_still_moving(f, "velocity_y", b.history_y);
    }
    if (!of_kind.no_motion.empty()) refuse_input_motion(f, std::string(of_kind.no_motion));
    if (of_kind.two_sided)
      read_opposite(f, b);
    else if (!kind.empty())
      refuse_keys(f, {"to", "to_edge"}, "is only for kind = \"tied\"", "leave it out");
    model_.boundaries.push_back(b);
  }

  void refuse_keys(const Fields& f, const std::vector<const char*>& keys, const std::string& text,
                   const std::string& hint) {
    for (const char* key : keys)
      if (f.given(key)) error(f, key, text, hint);
  }

  void refuse_input_motion(const Fields& f, const std::string& hint) {
    refuse_keys(f, {"velocity_x", "velocity_y", "motion"}, "is only for kind = \"viscous\"", hint);
  }

  // Outcrop and upgoing differ by a factor of two: no default.
  void check_input_motion(const Fields& f) {
    const bool input = f.given("velocity_x") || f.given("velocity_y");
    const std::string within =
        "\"within\" is the real motion of the base, waves that come down included; a compliant base finds "
        "that out itself";
    if (f.get<std::string>("motion") == "within")
      error(
          f, "motion", within,
          "give the motion of the base to a [[support]] as x = { velocity = \"HISTORY\" } (a rigid base), or "
          "the upgoing or outcrop motion here");
    else if (input && !f.given("motion"))
      findings_.error(
          f.where(), f.path_of("motion"), "is missing: upgoing and outcrop motion differ by a factor of two",
          "give motion = \"outcrop\" for a record at the surface of rock, \"upgoing\" for the wave alone");
    else if (!input && f.given("motion"))
      error(f, "motion", "says what no history is", "give velocity_x or velocity_y, or leave it out");
  }

  // The last value of a history is held.
  void warn_still_moving(const Fields& f, std::string_view key, int history) {
    if (history < 0) return;
    const History& h = model_.histories[history];
    double largest = 0;
    for (const double v : h.value) largest = std::max(largest, std::abs(v));
    if (std::abs(h.value.back()) > kStillMoving * largest)
      warning(f, key,
              fmt::format("history \"{}\" ends at {:.3g} m/s: the ground goes on at that for ever", h.name,
                          h.value.back()),
              "let a velocity end at 0");
  }

  void read_opposite(const Fields& f, BoundaryInput& b) {
    b.where_opposite = f.given("to") ? f.where("to") : f.where("to_edge");
    if (f.given("to") == f.given("to_edge"))
      findings_.error(f.where(), f.path(),
                      f.given("to") ? "has more than one opposite side" : "has no opposite side",
                      "give one of to = \"NAME\", to_edge = [[x0, y0], [x1, y1]]");
    read_line_name(f, "to", b.opposite);
    read_segment(f, "to_edge", b.opposite);
    b.opposite.block = b.block, b.opposite.where_block = b.where_block;
    refuse_keys(f, {"material", "static", "stages"},
                "has no meaning for tied sides, which are tied in every stage", "leave it out");
    if (!b.along.empty() && b.along == b.opposite.along)
      error(f, "to", "names the side itself", "name the side at the other end of the model");
  }

  // --- loads ---

  // A constant, or the history that a name refers to.
  Signal signal(const Fields& f, std::string_view key) {
    if (!f.has(key)) return {};
    if (!f.holds<std::string>(key)) return {-1, f.get<double>(key)};
    const int i = history(f, key);
    if (key.starts_with("acceleration")) check_quantity(f, key, i, model_.histories, "acceleration");
    return i < 0 ? Signal{} : Signal{i, 1};
  }

  // Along the axes, or along a direction.
  void read_components(const Fields& f, const std::string& key, LoadInput& l) {
    l.x = signal(f, key + "_x"), l.y = signal(f, key + "_y");
    if (!f.given(key)) {
      if (f.given("direction"))
        error(f, "direction", fmt::format("has no {} to go with", key), "give " + key + " beside it");
      return;
    }
    if (f.given(key + "_x") || f.given(key + "_y"))
      error(f, key, fmt::format("and {}_x or {}_y are given", key, key),
            "give components, or size and direction");
    if (!f.given("direction"))
      error(f, key, "has no direction",
            fmt::format("give direction = \"30 deg\", or {}_x and {}_y", key, key));
    const double angle = f.get("direction", 0.0);
    l.x = l.y = signal(f, key);
    l.x.factor *= std::cos(angle), l.y.factor *= std::sin(angle);
  }

  void read_load(const Fields& f) {
    claim_name(f, loads_, "load");
    auto l = f.filled<LoadInput>();
    l.where = f.given("block") ? f.where("block") : f.where();
    l.stages = stages(f, model_.stages);
    read_block_name(f, l);
    const auto any = [&f](const std::string& key) {
      return f.given(key) || f.given(key + "_x") || f.given(key + "_y");
    };
    const bool body = any("acceleration"), force = any("force");
    const bool surface = f.given("pressure") || any("traction");
    l.kind = force ? LoadKind::kForce : surface ? LoadKind::kSurface : LoadKind::kAcceleration;
    l.has_place = f.given("point") || f.given("edge") || f.given("along");
    if (l.has_place || surface || force) read_place(f, true, l);
    l.pressure = signal(f, "pressure");
    if (body + surface + force == 0)
      findings_.error(f.where(), f.path(), "has no effect",
                      "give an acceleration, a pressure, a traction or a force: acceleration_x, "
                      "acceleration_y, or acceleration and direction, and so on");
    else if (body + surface + force > 1)
      findings_.error(f.where(), f.path(), "mixes accelerations, tractions and forces",
                      "write one [[load]] for each");
    else
      read_components(f, body ? "acceleration" : surface ? "traction" : "force", l);
    if (body + surface + force == 1) check_place_of(f, l);
    model_.loads.push_back(l);
  }

  void check_place_of(const Fields& f, const LoadInput& l) {
    if (l.kind == LoadKind::kAcceleration && l.has_place)
      findings_.error(f.where(), f.path(), "has a place, but an acceleration acts on whole blocks",
                      "name blocks with block = \"NAME\"");
    else if (l.kind == LoadKind::kSurface && f.given("point"))
      error(f, "point", "has no area for a pressure or traction", "give edge or along, or a force");
    else if (l.kind == LoadKind::kForce && l.has_place && !f.given("point"))
      findings_.error(f.where(), f.path(), "has a force on an edge: forces act at a point",
                      "give point = [x, y], or a traction per area");
  }

  std::set<std::string> supports_, boundaries_, loads_;
};

}  // namespace

void read_action_sections(const TomlSource& source, Model& model, Findings& findings) {
  ActionReader(source, model, findings).read();
}

}  // namespace talus
