#include "talus/model/read_model.h"
#include "talus/model/read_as_printed.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "talus/base/index.h"
#include "talus/base/text.h"
#include "talus/base/version.h"
#include "talus/model/joint_law.h"
#include "talus/model/model_sections.h"
#include "talus/model/names_used.h"
#include "talus/model/read_action.h"
#include "talus/model/read_bolt.h"
#include "talus/model/read_cut.h"
#include "talus/model/read_history_file.h"
#include "talus/model/read_mesh.h"
#include "talus/model/read_penalty.h"
#include "talus/model/read_stages.h"
#include "talus/schema/expression.h"
#include "talus/schema/variables.h"

namespace talus {

namespace {

constexpr double kMostGravity = 600;  // [m/s2], of a centrifuge

class ModelReader : private ModelSections {
 public:
  using ModelSections::ModelSections;

  void read() {
    model_.shapes_readable = false;
    check_section_names();
    if (!read_top() || !check_maps()) return;
    model_.shapes_readable = true;
    read_general();
    read_materials();
    read_joints();
    read_histories();
    read_blocks();
    read_grids();
    const std::string shapes = read_mesh_sections(source_, block_names_, model_, findings_);
    if (!shapes.empty()) model_.shapes_hash = text_hash(shapes);
    files_ += shapes;
    if (!files_.empty()) model_.hash = text_hash(model_.text + files_);
    read_cut_sections(source_, block_names_, model_, findings_);
    if (!model_.cut.blocks_file.empty()) {  // what is wrong with it is told where it is read
      const auto path = std::filesystem::path(model_.folder) / model_.cut.blocks_file;
      std::error_code ec;
      if (std::filesystem::is_regular_file(path, ec))
        model_.files.push_back({path.string(), file_hash(path)});
    }
    read_contact();
    read_stage_sections(source_, model_, findings_);
    read_action_sections(source_, model_, findings_);
    read_solver();
    read_bolt_sections(source_, model_, findings_);
    read_monitors();
    read_output();
    read_safety();
    read_penalty_section(source_, model_, findings_);
    refuse_as_printed(model_, findings_);
    for (const BlockInput& b : model_.blocks)
      check_material_of(b.kind, b.material, b.where, "block." + b.name);
    for (const GridInput& g : model_.grids) check_material_of(g.kind, g.material, g.where, "grid." + g.name);
    for (const MeshInput& m : model_.meshes) {
      check_material_of(m.kind, m.material, m.where, "mesh." + m.name);
      for (const int material : m.group_material)
        check_material_of(m.kind, material, m.where, "mesh." + m.name);
    }
    for (const RegionInput& r : model_.regions)
      check_material_of(r.kind, r.material, r.where, "region." + r.name);
    for (const ArchInput& a : model_.arches) check_material_of(a.kind, a.material, a.where, "arch." + a.name);
  }

 private:
  // --- sections ---

  void check_section_names() {
    std::vector<std::string> sections;
    for (const SectionSpec& s : model_schema())
      if (s.shape != SectionShape::kTop) sections.emplace_back(s.name);
    std::vector<std::string> known = sections;
    known.insert(known.end(), {"talus", "title", "folder"});
    for (const auto& [key, node] : source_.root) {
      const std::string name(key.str());
      if (std::find(known.begin(), known.end(), name) == known.end()) {
        const std::string near = findings_.many() ? "" : closest_name(name, known);
        findings_.error(where_of(key.source()), name,
                        node.is_table() || node.is_array_of_tables() ? "unknown section" : "unknown key",
                        near.empty() ? fmt::format("sections are {}", join_or(sections))
                                     : fmt::format("did you mean \"{}\"?", near));
      }
    }
  }

  // Maps become sections before the model is read.
  bool check_maps() {
    for (const char* section : {"map", "maps"}) {
      const toml::node* node = source_.root.get(section);
      if (!node) continue;
      const toml::array* list = node->as_array();
      findings_.error(
          where_of(list && !list->empty() ? list->get(0)->source() : node->source()), section,
          "maps are read by talus cut alone",
          "talus cut MODEL -o DIR writes DIR/model.toml with the sections that come of them: use that");
      return false;
    }
    return true;
  }

  // --- content ---

  bool read_top() {
    const Fields f = read_section(model_schema().front(), source_.root, "", {1, 1, ""}, source_, findings_);
    f.fill(model_);
    model_.folder =
        (std::filesystem::path(model_.file).parent_path() / f.get<std::string>("folder")).string();
    const auto format = f.get<int64_t>("talus", kModelFormat);
    if (format > kModelFormat) {
      findings_.error(
          f.where("talus"), "talus",
          fmt::format("the file is in format {}, newer than this program (talus {}), which reads format {}",
                      format, kVersion, kModelFormat),
          "use a newer talus; nothing of the file was interpreted");
      return false;
    }
    return true;
  }

  void read_general() {
    const Fields f = read_table("model");
    f.fill(model_);
    check_gravity();
  }

  void read_materials() {
    for_named("material", [this](const std::string& name, const Fields& f) {
      auto m = f.filled<Material>();
      m.name = name;
      // a value that was given but refused has its message already: 0 keeps it from being called missing
      m.young = f.get("young", f.given("young") ? 0 : m.young);
      m.poisson = f.get("poisson", f.given("poisson") ? 0 : m.poisson);
      model_.materials.push_back(m);
    });
  }

  void check_material_of(BlockKind kind, int material, const Where& where, const std::string& path) {
    if (kind != BlockKind::kDeformable || material < 0) return;
    const Material& m = model_.materials[material];
    // one message per material, at its first user
    if (!(std::isnan(m.young) || std::isnan(m.poisson)) || !incomplete_.insert(m.name).second) return;
    findings_.error(where, path,
                    fmt::format("is deformable, but material \"{}\" has no {}", m.name,
                                std::isnan(m.young) ? "young" : "poisson"),
                    fmt::format("give it in [material.{}], or make the block kind = \"rigid\"", m.name));
  }

  // The kind of a joint, and the keys that it alone has.
  void read_kind(const Fields& f, JointProperty& j) {
    const std::vector<JointKind>& kinds = joint_kinds();
    for (int k = 0; k < count_of(kinds); ++k)
      if (kinds[k].name == f.get<std::string>("kind")) j.kind = k;
    j.bonded = kinds[j.kind].bonded;
    for (int k = 0; k < count_of(kinds); ++k)
      for (const KeySpec& key : kinds[k].keys) {
        if (k == j.kind)
          j.own.push_back(f.get(key.name, std::numeric_limits<double>::quiet_NaN()));
        else if (f.given(key.name))
          findings_.error(f.where(key.name), f.path_of(key.name),
                          fmt::format("is of joints of kind \"{}\" alone", kinds[k].name),
                          fmt::format("leave it out, or make the joint kind = \"{}\"", kinds[k].name));
      }
  }

  void read_joints() {
    for_named("joint", [this](const std::string& name, const Fields& f) {
      auto j = f.filled<JointProperty>();
      j.name = name;
      read_kind(f, j);
      const auto strength = [&](const char* key, double& mean, StrengthScatter& scatter) {
        const Strewn given = f.get<Strewn>(key);
        mean = given.mean;
        scatter = {static_cast<StrengthScatter::Kind>(given.kind),
                   given.mean,
                   given.deviation,
                   given.least,
                   given.most,
                   strength_seed(given.seed, name, key)};
      };
      strength("friction_angle", j.friction_angle, j.friction_scatter);
      strength("cohesion", j.cohesion, j.cohesion_scatter);
      strength("tensile_strength", j.tensile_strength, j.tension_scatter);
      const bool may = model_.formulation == Formulation::kContactForces && JointLaw(j).is_soft();
      j.damping_time =
          may || f.given("damping_time") ? f.get("damping_time", 0.0) : 0;  // its default is one of stiffness
      j.restitution = f.get("restitution", -1.0);
      for (const JointDefect& d : JointLaw::defects(j))
        findings_.error(f.where(d.key), f.path_of(d.key), d.text, d.hint);
      for (const char* key :
           {"friction_angle", "cohesion", "tensile_strength", "normal_stiffness", "shear_stiffness",
            "damping_time", "restitution", "dilation_angle", "dilation_slip", "residual_friction_angle",
            "residual_cohesion", "residual_tensile_strength"}) {
        if (j.bonded && f.given(key))
          error(f, key, "has no meaning for a bonded joint, which never breaks",
                "leave it out, or make the joint kind = \"frictional\"");
      }
      model_.joints.push_back(j);
    });
  }

  void read_histories() {
    for_named("history", [this](const std::string& name, const Fields& f) {
      History h;
      h.name = name, h.where = f.where();
      const bool table = f.given("time") || f.given("value"), formula = f.given("expression");
      const bool file = f.given("file");
      for (const char* key : {"duration", "samples"})
        if (!formula && f.given(key)) error(f, key, "belongs to an expression", "leave it out");
      for (const char* key : {"column", "dt", "unit"})
        if (!file && f.given(key)) error(f, key, "belongs to a file", "leave it out, or give file");
      if (table + formula + file != 1) {
        findings_.error(f.where(), f.path(),
                        table + formula + file == 0 ? "is empty" : "is given in more than one way",
                        "give time and value, or expression and duration, or file and column");
      } else if (formula) {
        sample_expression(f, h);
      } else if (file) {
        const std::string text = read_history_file(f, model_.folder, h, findings_);
        if (!text.empty())
          model_.files.push_back(
              {(std::filesystem::path(model_.folder) / f.get<std::string>("file")).string(),
               text_hash(text)});
        files_ += text;
      } else {
        h.time = f.get<std::vector<double>>("time");
        h.value = f.get<std::vector<double>>("value");
        check_table(f, h);
      }
      for (double& v : h.value) v *= f.get("scale", 1.0);
      if (h.time.size() != h.value.size() || h.time.empty()) h.time = {0, 1}, h.value = {0, 0};
      h.integral.assign(h.time.size(), 0);
      for (size_t i = 1; i < h.time.size(); ++i)
        h.integral[i] = h.integral[i - 1] + 0.5 * (h.time[i] - h.time[i - 1]) * (h.value[i] + h.value[i - 1]);
      model_.histories.push_back(std::move(h));
    });
  }

  void check_table(const Fields& f, const History& h) {
    if (h.time.size() != h.value.size()) {
      findings_.error(f.where("value"), f.path(),
                      fmt::format("has {} times and {} values", h.time.size(), h.value.size()));
    } else if (h.time.size() < 2) {
      error(f, "time", "needs at least two points");
    }
    for (size_t i = 1; i < h.time.size(); ++i) {
      if (h.time[i] > h.time[i - 1]) continue;
      error(f, "time", fmt::format("does not rise: {:g} s is followed by {:g} s", h.time[i - 1], h.time[i]));
      break;
    }
  }

  void sample_expression(const Fields& f, History& h) {
    if (!f.has("duration")) {
      findings_.error(f.where("expression"), f.path_of("duration"), "is missing",
                      "an expression is sampled from t = 0 to duration");
      return;
    }
    const double duration = f.get<double>("duration");
    const auto n = f.get<int64_t>("samples", 10000);
    std::string trouble;
    for (int64_t i = 0; i <= n; ++i)
      h.time.push_back(duration * static_cast<double>(i) / static_cast<double>(n));
    h.value = evaluate_expression(f.get<std::string>("expression"), h.time, trouble);
    if (!trouble.empty()) error(f, "expression", trouble);
  }

  void read_blocks() {
    for_list("block", [this](const Fields& f) {
      claim_name(f, block_names_, "block or grid");
      auto b = f.filled<BlockInput>();
      if (!f.has("polygon") || !f.has("name")) model_.shapes_readable = false;
      b.where = f.given("polygon") ? f.where("polygon") : f.where();
      b.material = refer(f, "material", model_.materials, "material");
      placement(f).apply(b.polygon);
      b.motion_x = motion(f, "motion_x", model_.histories);
      b.motion_y = motion(f, "motion_y", model_.histories);
      b.motion_rotation = motion(f, "motion_rotation", model_.histories);
      for (const char* key : {"motion_x", "motion_y", "motion_rotation"}) {
        if (f.given(key) && b.kind != BlockKind::kDriven)
          error(f, key, "is only for a block of kind = \"driven\"",
                "use a [[support]] to move points of other blocks");
        if (f.get<MotionText>(key).kind == MotionText::kFree)
          error(f, key, "a driven block has no free axis",
                "make the block \"rigid\" and drive it by a [[support]]");
      }
      if (b.kind == BlockKind::kFixed || b.kind == BlockKind::kDriven) {
        for (const char* key : {"velocity", "spin"}) {
          if (f.given(key))
            error(f, key, fmt::format("has no meaning for a {} block", f.get<std::string>("kind")),
                  "leave it out, or use kind = \"driven\" with motion_x, motion_y, motion_rotation");
        }
      }
      model_.blocks.push_back(std::move(b));
    });
  }

  void read_grids() {
    for_list("grid", [this](const Fields& f) {
      claim_name(f, block_names_, "block or grid");
      auto g = f.filled<GridInput>();
      for (const char* key : {"name", "min", "max", "cells"})
        if (!f.has(key)) model_.shapes_readable = false;
      const auto cells = f.get<std::array<int, 2>>("cells", {1, 1});
      g.columns = cells[0], g.rows = cells[1];
      g.material = refer(f, "material", model_.materials, "material");
      g.joint = refer(f, "joint", model_.joints, "joint");
      g.place = placement(f);
      if (g.kind == BlockKind::kFixed && f.given("velocity"))
        error(f, "velocity", "has no meaning for fixed blocks", "leave it out");
      if (f.has("min") && f.has("max") && !(g.min.x < g.max.x && g.min.y < g.max.y)) {
        error(f, "max", "must lie above and to the right of min");
        model_.shapes_readable = false;
      }
      if (static_cast<double>(g.columns) * g.rows > 1e7)
        error(f, "cells", "makes more than ten million cells");
      model_.grids.push_back(g);
    });
  }

  void read_contact() {
    const Fields f = read_table("contact");
    model_.default_joint = refer(f, "joint", model_.joints, "joint");
    ContactInput& contact = model_.contact;
    f.fill(contact);
    const bool printed = model_.formulation == Formulation::kAsPrinted;
    contact.law = f.get<std::string>("law") == "smoothed" || (printed && !f.given("law"))
                      ? ContactLaw::kSmoothed
                      : ContactLaw::kExact;
    if (printed && contact.law == ContactLaw::kExact)
      error(f, "law", "the contact equations of model.formulation = \"as_printed\" are smoothed",
            "leave it out, or use formulation = \"contact_forces\"");
    contact.give = f.get<std::string>("stiffness") != "none";
    // the paper gives a width for friction alone
    if (printed && !f.given("smoothing_force")) contact.smoothing_force = contact.smoothing_slip;
    for (const char* key : {"smoothing_force", "smoothing_slip"})
      if (f.given(key) && contact.law == ContactLaw::kExact) error(f, key, "belongs to law = \"smoothed\"");
    for (const JointProperty& j : model_.joints)
      if (contact.law == ContactLaw::kSmoothed && j.dilation_angle > 0)
        error(f, "law", fmt::format("never slips by its rules, and joint \"{}\" dilates with slip", j.name),
              "use law = \"exact\", or leave dilation_angle out");
    for (const JointProperty& j : model_.joints)
      if (contact.law == ContactLaw::kSmoothed && j.restitution >= 0)
        error(f, "law", fmt::format("knows no blows, and joint \"{}\" has a restitution", j.name),
              "use law = \"exact\", or leave restitution out");
    for_list("contact_pair", [this](const Fields& p) {
      ContactPairInput c;
      const auto names = p.get<std::vector<std::string>>("between");
      if (names.size() == 2) c.name_a = names[0], c.name_b = names[1];
      c.joint = refer(p, "joint", model_.joints, "joint");
      c.where = p.where("between");
      model_.contact_pairs.push_back(c);
    });
  }

  void read_solver() {
    const Fields f = read_table("solver");
    f.fill(model_.solver);
    if (model_.formulation == Formulation::kAsPrinted) {
      if (!f.given("jacobian")) model_.solver.jacobian = JacobianKind::kDifference;
      if (model_.solver.jacobian != JacobianKind::kDifference)
        error(f, "jacobian", "model.formulation = \"as_printed\" solves by difference quotients",
              "leave it out, or use formulation = \"contact_forces\"");
    }
    if (model_.formulation == Formulation::kAsPrinted && model_.solver.method != SolverKind::kAuto &&
        model_.solver.method != SolverKind::kNewton) {
      error(f, "method", "model.formulation = \"as_printed\" solves by Newton's method",
            "leave it out, or use formulation = \"contact_forces\"");
      model_.solver.method = SolverKind::kNewton;
    }
    const bool only_exact =
        model_.solver.method != SolverKind::kAuto && model_.solver.method != SolverKind::kNewton;
    if (only_exact && model_.contact.law == ContactLaw::kSmoothed)
      error(f, "method", fmt::format("{} solves the exact law only", name_of(model_.solver.method)),
            "use method = \"newton\" with contact.law = \"smoothed\"");
    if (only_exact && model_.solver.jacobian == JacobianKind::kDifference)
      error(f, "jacobian",
            fmt::format("difference quotients are of newton; {} takes none", name_of(model_.solver.method)),
            "leave it out, or use method = \"newton\"");
    read_tolerance(f);
    model_.solver.stop_on_failure = f.get<std::string>("on_failure") != "continue";
  }

  void read_tolerance(const Fields& f) {
    SolverInput& solver = model_.solver;
    const bool smoothed = model_.contact.law == ContactLaw::kSmoothed;
    solver.limit = smoothed           ? solver.tolerance
                   : f.given("limit") ? f.get("limit", solver.limit)
                                      : std::max(solver.limit, solver.tolerance);
    if (f.given("limit") && smoothed)
      error(f, "limit", "is of the exact law: steps of the smoothed one are judged by what its solver leaves",
            "leave it out, or use contact.law = \"exact\"");
    if (solver.limit < solver.tolerance)
      error(f, "limit",
            fmt::format("{:g} is not allowed; must be at least solver.tolerance, {:g}", solver.limit,
                        solver.tolerance),
            "give a larger limit or a smaller tolerance; without limit it is 1e-5, or the tolerance "
            "where that is larger");
  }

  void read_monitors() {
    std::set<std::string> used;
    for_list("monitor", [this, &used](const Fields& f) {
      claim_name(f, used, "monitor");
      auto m = f.filled<MonitorInput>();
      const int kinds = f.given("point") + f.given("block") + f.given("support") + f.given("contact") +
                        f.given("bolt") + f.given("convergence") + f.given("centroid") + f.given("crack");
      if (kinds != 1) {
        findings_.error(f.where(), f.path(),
                        kinds == 0 ? "does not say what to record" : "records more than one thing",
                        "give one of point, centroid, convergence, crack, block, support, contact, bolt");
        return;
      }
      for (const char* key : {"block", "centroid", "support", "bolt"})
        if (f.given(key) && f.has(key) && f.get<std::string>(key).empty()) {
          error(f, key, "is empty", "name what is to be recorded");
          return;
        }
      if (f.given("window") && !f.given("contact")) error(f, "window", "is only for contact monitors");
      if (m.spectrum && !f.given("point") && !f.given("centroid"))
        error(f, "spectrum", "is only for point and centroid monitors");
      read_reference(f, m);
      if (f.given("convergence") || f.given("crack")) {
        const char* key = f.given("crack") ? "crack" : "convergence";
        m.kind = f.given("crack") ? MonitorKind::kCrack : MonitorKind::kConvergence;
        m.where = f.where(key);
        const auto points = f.get<std::vector<Vec2>>(key);
        if (f.has(key) && (points.size() != 2 || points[0] == points[1]))
          findings_.error(m.where, f.path_of(key), "must be two different points",
                          fmt::format("write {} = [[x0, y0], [x1, y1]]", key));
        else if (f.has(key))
          m.point = points[0], m.other = points[1];
      } else if (f.given("centroid")) {
        m.kind = MonitorKind::kCentroid;
        m.target_a = f.get<std::string>("centroid");
        m.where = f.where("centroid");
      } else if (f.given("point")) {
        m.point = f.get<Vec2>("point");
        m.where = f.where("point");
      } else if (f.given("block")) {
        m.kind = MonitorKind::kBlock;
        m.target_a = f.get<std::string>("block");
        m.where = f.where("block");
      } else if (f.given("support")) {
        m.kind = MonitorKind::kSupport;
        m.target_a = f.get<std::string>("support");
        refer(f, "support", model_.supports, "support");
      } else if (f.given("bolt")) {
        m.kind = MonitorKind::kBolt;
        m.target_a = f.get<std::string>("bolt");
        if (is_left_out("bolt", "name", m.target_a) || is_left_out("bolt_pattern", "name", m.target_a)) {
          warning(f, "bolt",
                  fmt::format("\"{}\" is left out (use = false): nothing is recorded", m.target_a));
          return;
        }
        check_bolt_name(f, m.target_a);
      } else {
        m.kind = MonitorKind::kContact;
        m.where = f.where("contact");
        const auto names = f.get<std::vector<std::string>>("contact");
        if (names.size() == 2) m.target_a = names[0], m.target_b = names[1];
      }
      model_.monitors.push_back(m);
    });
  }

  // A bolt, or all of a pattern.
  void check_bolt_name(const Fields& f, const std::string& name) {
    for (const BoltInput& b : model_.bolts)
      if (b.belongs_to(name)) return;
    refer(f, "bolt", model_.bolts, "bolt");
  }

  void read_reference(const Fields& f, MonitorInput& m) {
    int given = 0;
    for (const char* key : {"relative_to", "relative_to_point", "relative_to_points"})
      if (f.given(key)) m.where_relative = f.where(key), ++given;
    if (f.given("relative_to_point")) m.relative_to_points = {f.get<Vec2>("relative_to_point")};
    if (given > 1)
      findings_.error(m.where_relative, f.path(), "is relative to two things",
                      "give one of relative_to, relative_to_point, relative_to_points");
    if (f.given("relative_to_points") && m.relative_to_points.size() < 2)
      findings_.error(m.where_relative, f.path_of("relative_to_points"), "needs two points or more",
                      "write relative_to_points = [[x0, y0], [x1, y1]]; relative_to_point is for one");
    if (given > 0 && !f.given("point") && !f.given("centroid"))
      findings_.error(m.where_relative, f.path(), "is relative to something, but no point",
                      "relative_to, relative_to_point and relative_to_points belong to point and centroid");
  }

  void read_output() {
    const Fields f = read_table("output");
    f.fill(model_.output);
    model_.output.where_history = f.where("history_interval");
    model_.output.where_field = f.where("field_interval");
  }

  void read_safety() {
    const Fields f = read_table("safety");
    SafetyInput& s = model_.safety;
    f.fill(s);
    // strength and loads by factors, a tilt in degrees, an acceleration in shares of gravity
    const double usual[4][3] = {{0.5, 4, 0.01}, {0.5, 4, 0.01}, {1, 60, 0.05}, {0.01, 1, 0.001}};
    const auto& [lowest, highest, tolerance] = usual[place_of(s.by)];
    s.lowest = f.get("lowest", lowest), s.highest = f.get("highest", highest);
    s.tolerance = f.get("tolerance", tolerance);
    if (f.given("load") != (s.by == SafetyBy::kLoad))
      findings_.error(f.given("load") ? f.where("load") : f.where("by"), f.path_of("load"),
                      f.given("load") ? "is raised by = \"load\" alone" : "is missing: which load is raised",
                      "give by = \"load\" and load = \"NAME\"");
    s.load = refer(f, "load", model_.loads, "load");
    for (const char* key : {"joints", "from"})
      if (s.by != SafetyBy::kStrength && f.given(key))
        error(f, key, "belongs to by = \"strength\"", "leave it out");
    s.at = refer(f, "at", model_.stages, "stage");
    for (int k = 0; k <= s.at; ++k)
      if (model_.stages[k].kind != StageKind::kStatic) {
        error(
            f, "at",
            fmt::format("stage \"{}\" is not static, or one before it is not: there is no rest to go on from",
                        model_.stages[s.at].name),
            "name one of the static stages that the model begins with");
        break;
      }
    const bool turns = s.by == SafetyBy::kTilt || s.by == SafetyBy::kAcceleration;
    if (turns && (norm(model_.gravity) == 0 || model_.in_situ.given))
      error(f, "by",
            model_.in_situ.given ? "turns gravity, and the stress of the ground is that of the gravity given"
                                 : "turns gravity, and there is none",
            model_.in_situ.given ? "leave [in_situ] out" : "give model.gravity");
    if (s.by == SafetyBy::kTilt && s.highest >= 90) error(f, "highest", "is a tilt of 90 degrees or more");
    s.where = f.where();
    if (!(s.lowest < s.highest)) error(f, "highest", "must be larger than lowest");
    for (const std::string& name : f.get<std::vector<std::string>>("joints")) {
      const int i = refer_name(name, f.where("joints"), f.path_of("joints"), model_.joints, "joint");
      if (i < 0) continue;
      s.joints.push_back(i);
      if (model_.joints[i].bonded)
        error(f, "joints", fmt::format("joint \"{}\" is bonded: it has no strength to reduce", name),
              "leave it out");
    }
  }

  void check_gravity() {
    const Vec2 g = model_.gravity;
    std::string unusual;
    if (g.y > 0)
      unusual = fmt::format("{:g} m/s2 along y: things fall upwards", g.y);
    else if (g.y == 0 && g.x != 0)
      unusual = fmt::format("{:.3g} m/s2 along x alone: things fall sideways", g.x);
    else if (norm(g) > kMostGravity)
      unusual = fmt::format("{:.3g} m/s2 is more than a centrifuge has", norm(g));
    if (!unusual.empty())
      findings_.warning(model_.where_gravity, "model.gravity", unusual, "downwards is [0, -9.81]");
  }

  std::set<std::string> block_names_, incomplete_;
  std::string files_;  // content of the files of histories and meshes, one behind the other
};

}  // namespace

Model read_model(const std::string& file, const std::string& text, const std::vector<std::string>& overrides,
                 Findings& findings) {
  Model model;
  model.file = file;
  model.text = with_overrides(text, overrides);
  model.hash = text_hash(model.text);
  const TomlSource source = read_toml(text, overrides, findings, model_schema());
  if (findings.has_errors()) {  // after a syntax error every further message would mislead
    model.shapes_readable = false;
    return model;
  }
  ModelReader(source, model, findings).read();
  if (findings.has_errors()) return model;
  check_names_used(source, model, findings);
  check_variables_used(source, findings);
  return model;
}

}  // namespace talus
