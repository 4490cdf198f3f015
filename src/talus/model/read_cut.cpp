#include "talus/model/read_cut.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "talus/base/index.h"
#include "talus/geometry/polygon_check.h"
#include "talus/geometry/shapes.h"
#include "talus/model/joint_law.h"
#include "talus/model/model_sections.h"

namespace talus {

namespace {

constexpr double kTurn = 2 * std::numbers::pi;

// Most blocks that one region may be divided into on purpose.
constexpr double kMostCells = 1e7;

class CutReader : private ModelSections {
 public:
  CutReader(const TomlSource& source, std::set<std::string>& block_names, Model& model, Findings& findings)
      : ModelSections(source, model, findings), block_names_(block_names) {}

  void read() {
    claim_mesh_names();
    read_cut();
    read_regions();
    read_arches();
    read_openings();
    read_faults();
    read_traces();
    read_masonry();
    read_tessellations();
    read_joint_sets();
    check_use();
  }

 private:
  // --- names ---

  // Names that supports may follow: each stands for one source of block edges.
  void claim_trace_name(const Fields& f, const std::string& what) { claim_name(f, trace_names_, what); }

  // Curves of meshes, and their other edges by the name of the mesh, are sources of edges, too.
  void claim_mesh_names() {
    for (const MeshInput& m : model_.meshes) {
      for (const std::string& name : m.mesh.curve_groups) {
        if (trace_names_.insert(name).second) continue;
        findings_.error(m.where, "mesh." + m.name,
                        fmt::format("its physical curve \"{}\" has the name of another", name),
                        "supports follow these names: they must differ");
      }
      trace_names_.insert(m.name);
    }
  }

  // A name of blocks that is a source of edges, too: one message is enough.
  void claim_both(const Fields& f, const std::string& what) {
    const int before = findings_.error_count();
    claim_name(f, block_names_, what);
    const std::string name = f.get<std::string>("name");
    if (findings_.error_count() > before || trace_names_.insert(name).second) return;
    error(f, "name", fmt::format("a second source of joints is called \"{}\"", name),
          "supports follow these names: they must differ");
  }

  int region(const Fields& f) { return refer(f, "region", model_.regions, "region"); }
  int joint(const Fields& f, std::string_view key = "joint") { return refer(f, key, model_.joints, "joint"); }
  int material(const Fields& f) { return refer(f, "material", model_.materials, "material"); }

  void incomplete() { model_.shapes_readable = false; }

  // A polygon that must be simple; wrong ones are told and keep the cutter from starting.
  bool check_polygon(const Fields& f, std::string_view key, const Polygon& polygon) {
    const std::string defect = polygon_defect(polygon);
    if (defect.empty()) return true;
    error(f, key, defect, "give the corners in order, once around");
    incomplete();
    return false;
  }

  // --- sections ---

  void read_cut() {
    const Fields f = read_table("cut");
    CutInput& c = model_.cut;
    f.fill(c);
    c.where = f.where();
    azimuth_given_ = f.given("section_azimuth");
    where_merge_along_ = f.where("merge_along");
    if (f.given("merge_along") && c.slivers != SliverPolicy::kMerge)
      findings_.warning(where_merge_along_, f.path_of("merge_along"), "has no effect: nothing is merged",
                        "it counts with slivers = \"merge\"");
    c.where_file = f.where("blocks");
    if (f.given("blocks") && c.blocks_file.empty())
      error(f, "blocks", "is empty", "name a file that talus cut has written");
  }

  void read_regions() {
    for_list("region", [this](const Fields& f) {
      claim_name(f, block_names_, "block, grid or region");
      auto r = f.filled<RegionInput>();
      const bool sound = f.has("polygon") && check_polygon(f, "polygon", r.polygon);
      if (!sound) incomplete();
      if (sound && f.has("sides") && r.sides.size() != r.polygon.size()) {
        error(f, "sides", fmt::format("has {} names for {} edges", r.sides.size(), r.polygon.size()),
              "give one name per edge, the first for the edge from the first to the second corner");
      }
      for (size_t i = r.sides.size(); i < r.polygon.size(); ++i)
        r.sides.push_back(fmt::format("{}-{}", r.name, i + 1));
      for (const std::string& side : r.sides) {
        if (f.has("sides")) check_name(f.where("sides"), f.path_of("sides"), side);
        side_names_.emplace(side, f.has("sides") ? std::pair(f.where("sides"), f.path_of("sides"))
                                                 : std::pair(f.where(), f.path()));
      }
      r.material = material(f);
      r.joint = joint(f);
      if (sound) placement(f).apply(r.polygon);
      model_.regions.push_back(std::move(r));
    });
  }

  void read_arches() {
    for_list("arch", [this](const Fields& f) {
      claim_both(f, "block, grid or region");
      auto a = f.filled<ArchInput>();
      for (const char* key : {"name", "center", "radius", "thickness", "voussoirs"})
        if (!f.has(key)) incomplete();
      if (!(a.to > a.from) || a.to - a.from > kTurn * (1 - 1e-9)) {
        error(f, "to", "must be larger than from, by less than a full turn",
              "angles are counter-clockwise from +x: a half circle runs from \"0 deg\" to \"180 deg\"");
        incomplete();
      } else if ((a.to - a.from) / a.voussoirs > 0.5 * kTurn * (1 - 1e-9)) {
        error(f, "voussoirs", "each must span less than 180 deg", "give more of them");
        incomplete();
      }
      a.material = material(f);
      a.joint = joint(f);
      const Placement place = placement(f);
      a.center = place.apply(a.center, a.center), a.from += place.angle, a.to += place.angle;
      for (const char* side : {"intrados", "extrados", "start", "end"})
        side_names_.emplace(a.name + "-" + side, std::pair(f.where(), f.path()));
      model_.arches.push_back(a);
    });
  }

  void read_openings() {
    for_list("opening", [this](const Fields& f) {
      claim_both(f, "block, grid, region or opening");
      auto o = f.filled<OpeningInput>();
      const auto shape = f.get<std::string>("shape");
      const auto segments = static_cast<int>(f.get<int64_t>("segments", 32));
      if (f.has("shape") && has_only(f, shape)) {
        if (o.shape == OpeningShape::kPolygon) {
          o.polygon = f.get<std::vector<Vec2>>("polygon");
          check_polygon(f, "polygon", o.polygon);
        } else if (o.shape == OpeningShape::kCircle) {
          o.polygon = circle_polygon(f.get<Vec2>("center"), f.get("diameter", 1.0), segments);
          o.sagitta = sagitta(0.5 * f.get("diameter", 1.0), 2 * std::numbers::pi / segments);
        } else if (f.get("height", 1.0) < 0.5 * f.get("width", 1.0)) {
          error(f, "height", "is less than half the width", "the half circle alone is half the width high");
          incomplete();
        } else {
          o.polygon =
              horseshoe_polygon(f.get<Vec2>("center"), f.get("width", 1.0), f.get("height", 1.0), segments);
          o.sagitta = sagitta(0.5 * f.get("width", 1.0), std::numbers::pi / segments);
        }
      }
      o.joint = joint(f);
      if (!o.kept && f.has("rock") && f.given("joint"))
        warning(f, "joint", "has no effect: removed rock has no joint", "it counts with rock = \"kept\"");
      if (o.polygon.empty()) incomplete();
      model_.openings.push_back(std::move(o));
    });
  }

  // Whether the opening gives the keys of its shape and no others.
  bool has_only(const Fields& f, const std::string& shape) {
    const std::vector<std::string> needed = shape == "circle" ? std::vector<std::string>{"center", "diameter"}
                                            : shape == "horseshoe"
                                                ? std::vector<std::string>{"center", "width", "height"}
                                                : std::vector<std::string>{"polygon"};
    bool sound = true;
    for (const std::string key : {"center", "diameter", "width", "height", "polygon", "segments"}) {
      const bool belongs = std::find(needed.begin(), needed.end(), key) != needed.end() ||
                           (key == "segments" && shape != "polygon");
      if (!belongs && f.given(key)) {
        error(f, key, fmt::format("does not belong to shape = \"{}\"", shape),
              fmt::format("give {}", join_or(needed)));
        sound = false;
      }
    }
    for (const std::string& key : needed) {
      if (!f.given(key))
        findings_.error(f.where(), f.path_of(key), fmt::format("is missing for shape = \"{}\"", shape),
                        "see the section opening in docs/file_format.md");
      sound = sound && f.has(key);
    }
    return sound;
  }

  void read_faults() {
    for_list("fault", [this](const Fields& f) {
      claim_trace_name(f, "source of joints");
      auto fault = f.filled<FaultInput>();
      if (f.has("points") && fault.points.size() < 2)
        error(f, "points", "needs two points or more", "give [[x0, y0], [x1, y1], ...] from end to end");
      fault.joint = joint(f);
      if (!f.has("points") || fault.points.size() < 2) incomplete();
      model_.faults.push_back(std::move(fault));
    });
  }

  void read_traces() {
    for_list("traces", [this](const Fields& f) {
      claim_trace_name(f, "source of joints");
      auto t = f.filled<TracesInput>();
      if (f.has("lines") && t.lines.empty())
        error(f, "lines", "is empty", "give lines [[[x, y], [x, y], ...], ...], or leave the section out");
      t.joint = joint(f);
      if (t.lines.empty()) incomplete();
      model_.traces.push_back(std::move(t));
    });
  }

  void read_masonry() {
    for_list("masonry", [this](const Fields& f) {
      claim_trace_name(f, "source of joints");
      auto m = f.filled<MasonryInput>();
      m.region = region(f);
      m.bed_joint = joint(f, "bed_joint");
      m.head_joint = joint(f, "head_joint");
      for (const char* part : {"bed", "head"})
        side_names_.emplace(m.name + "-" + part, std::pair(f.where(), f.path()));
      check_cells(f, "length", m.region, m.length, m.height);
      model_.masonry.push_back(m);
    });
  }

  void read_tessellations() {
    for_list("tessellation", [this](const Fields& f) {
      claim_trace_name(f, "source of joints");
      auto t = f.filled<TessellationInput>();
      t.region = region(f);
      t.joint = joint(f);
      check_cells(f, "size", t.region, t.size, t.size);
      check_divides(f, t);
      model_.tessellations.push_back(t);
    });
  }

  // Cells that are larger than their region divide nothing.
  void check_divides(const Fields& f, const TessellationInput& t) {
    if (t.region < 0 || !f.has("size")) return;
    const Polygon& polygon = model_.regions[t.region].polygon;
    if (polygon.empty()) return;
    const Box box = bounding_box(polygon);
    const double across = norm(box.max - box.min);
    if (t.size <= across) return;
    incomplete();
    error(f, "size",
          fmt::format("{:g} m is more than the region is across ({:.3g} m): nothing would be divided", t.size,
                      across),
          "give the side of a cell");
  }

  // A region of known size must not be divided into more cells than any machine takes.
  void check_cells(const Fields& f, std::string_view key, int region, double length, double height) {
    if (region < 0) return incomplete();
    const Polygon& polygon = model_.regions[region].polygon;
    if (polygon.empty()) return;
    // over the box, as they are drawn
    const Box box = bounding_box(polygon);
    const double cells = ((box.max.x - box.min.x) / length + 1) * ((box.max.y - box.min.y) / height + 1);
    if (cells <= kMostCells) return;
    error(f, key, fmt::format("makes about {:.2g} cells, more than {:g}", cells, kMostCells),
          "is a unit missing?");
    incomplete();
  }

  void read_joint_sets() {
    for_list("joint_set", [this](const Fields& f) {
      claim_trace_name(f, "source of joints");
      auto s = f.filled<JointSetInput>();
      s.where_spacing = f.where("spacing");
      s.where_length = f.where("trace_length");
      s.in_space = f.given("dip") || f.given("dip_direction");
      if (f.given("angle") == s.in_space)
        findings_.error(f.where(), f.path(), s.in_space ? "has both angle and dip" : "has no direction",
                        "give angle, or dip and dip_direction");
      if (s.in_space && !f.given("angle") && !(f.given("dip") && f.given("dip_direction")))
        findings_.error(f.where(), f.path(), f.given("dip") ? "has no dip_direction" : "has no dip",
                        "an orientation in space needs both");
      if (s.in_space && !azimuth_given_)
        error(f, "dip", "needs the direction of the section", "give section_azimuth in [cut]");
      if (!s.in_space && f.given("fisher"))
        error(f, "fisher", "belongs to dip and dip_direction",
              "an angle scatters by itself: angle = { mean = ..., normal = ... }");
      for (const char* key : {"gap", "start"})
        if (f.given(key) && !f.given("trace_length"))
          error(f, key, "has no meaning for a through-going set", "give trace_length");
      s.region = region(f);
      s.joint = joint(f);
      if (!f.has("spacing") || (s.in_space && !std::isfinite(model_.cut.section_azimuth)) ||
          f.given("angle") == s.in_space || (s.in_space && !(f.given("dip") && f.given("dip_direction"))) ||
          (f.given("region") && s.region < 0))
        incomplete();
      model_.joint_sets.push_back(s);
    });
  }

  // Sections that would have nothing to work on, and names that stand for two things.
  void check_use() {
    const bool divides = !model_.joint_sets.empty() || !model_.faults.empty() || !model_.traces.empty() ||
                         !model_.openings.empty() || model_.cut.where.line > 0;
    if (divides && model_.regions.empty() && model_.arches.empty() && source_.root.get("region") == nullptr) {
      const Where where = !model_.joint_sets.empty() ? model_.joint_sets[0].where
                          : !model_.faults.empty()   ? model_.faults[0].where
                          : !model_.traces.empty()   ? model_.traces[0].where
                          : !model_.openings.empty() ? model_.openings[0].where
                                                     : model_.cut.where;
      findings_.error(where, "region", "the file has no [[region]]: there is nothing to cut",
                      "give the outline of the rock as [[region]] with name, polygon and material");
      incomplete();
    }
    for (const std::string& name : model_.cut.merge_along) {
      const auto is_it = [&name](const JointSetInput& s) { return s.name == name; };
      if (std::any_of(model_.joint_sets.begin(), model_.joint_sets.end(), is_it)) continue;
      findings_.error(where_merge_along_, "cut.merge_along", fmt::format("\"{}\" is no joint set", name),
                      "blocks are merged along the lines of joint sets only: give names of [[joint_set]]s");
    }
    for (const auto& [side, place] : side_names_)
      if (trace_names_.count(side))
        findings_.error(place.first, place.second,
                        fmt::format("\"{}\" is the name of a side and of a source of joints", side),
                        "supports follow these names: they must differ");
    if (model_.regions.empty() && model_.arches.empty() && model_.meshes.empty()) return;
    JointProperty glue;
    glue.name = "(glued)";
    glue.kind = kBondedJoint, glue.bonded = true;
    model_.bonded_joint = count_of(model_.joints);
    model_.joints.push_back(glue);
  }

  bool azimuth_given_ = false;
  Where where_merge_along_;
  std::set<std::string>& block_names_;
  std::set<std::string> trace_names_;
  std::map<std::string, std::pair<Where, std::string>> side_names_;  // with place and key
};

}  // namespace

void read_cut_sections(const TomlSource& source, std::set<std::string>& block_names, Model& model,
                       Findings& findings) {
  CutReader(source, block_names, model, findings).read();
}

}  // namespace talus
