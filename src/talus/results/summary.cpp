#include "talus/results/summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "talus/base/arithmetic.h"
#include "talus/base/version.h"

namespace talus {

namespace {

nlohmann::ordered_json monitor_numbers(const Scene& scene, const Histories& histories) {
  nlohmann::ordered_json j = nlohmann::ordered_json::object();
  for (const Histories::Peak& p : histories.peaks()) j[p.name]["peak_velocity [m/s]"] = p.velocity;
  for (const Histories::Touch& t : histories.touches()) {
    if (t.first < 0) continue;
    j[t.name]["first_touch [s]"] = t.first, j[t.name]["last_touch [s]"] = t.last;
  }
  const Answers& answers = histories.answers();
  for (const Answers::Stage& s : answers.stages()) {
    const StageInput& stage = scene.model.stages[s.stage];
    for (size_t k = 0; k < answers.titles().size(); ++k) {
      const ColumnTitle& title = answers.titles()[k];
      const Answer& a = s.asked[k];
      auto& out = j[title.monitor]["stages"][stage.name][ColumnTitle{"", title.quantity, title.unit}.text()];
      out = {{"at_start", a.at_start}, {"at_end", a.at_end},
             {"least", a.least},       {"time_of_least [s]", a.time_of_least},
             {"greatest", a.greatest}, {"time_of_greatest [s]", a.time_of_greatest}};
      // of a stage that was entered on its way nobody knows it
      if (const double left = a.residual(stage.kind == StageKind::kDynamic); !std::isnan(left))
        out["residual"] = left;
    }
  }
  return j;
}

nlohmann::ordered_json audit_numbers(const Scene& scene, const std::optional<audit::Report>& audit) {
  using nlohmann::ordered_json;
  if (!audit) return {};
  ordered_json j = {{"frames", audit->frames},
                    {"steps", audit->steps},
                    {"patches_by_energy", audit->patches_by_energy},
                    {"unexplained_overlap_share", audit->unexplained_share},
                    {"unexplained_overlap [m2]", audit->unexplained_area},
                    {"closure_share", audit->closure_share},
                    {"defects", ordered_json::array()}};
  for (size_t d = 0; d < audit::kDefects; ++d) {
    const auto defect = static_cast<audit::Defect>(d);
    const audit::Report::Entry& e = audit->of(defect);
    if (e.count == 0) continue;
    ordered_json one = {{"kind", audit::key_of(defect)},
                        {"valid", !e.invalid},
                        {"count", e.count},
                        {"first [s]", e.first.time},
                        {"worst [s]", e.worst.time}};
    if (e.worst.block_a >= 0) {
      ordered_json names = ordered_json::array();
      for (const int k : {e.worst.block_a, e.worst.block_b})
        if (k >= 0) names.push_back(scene.blocks.name[k]);
      one["blocks"] = names, one["x [m]"] = e.worst.place.x, one["y [m]"] = e.worst.place.y;
    }
    one["share"] = e.worst.share, one["text"] = e.worst.text;
    j["defects"].push_back(one);
  }
  return j;
}

}  // namespace

RunNotes notes_of(const std::vector<std::string>& overrides, const Findings& findings) {
  RunNotes notes{overrides, {}};
  for (const Finding& f : findings.list()) notes.warnings.push_back(f.key + ": " + f.text);
  return notes;
}

std::vector<std::pair<std::string, std::string>> warnings_of(const Scene& scene, const RunResult& r,
                                                             const JointSummary& joints, bool audited) {
  // of a block's thickness: its joints have taken more room than their thickness in any drawing; a fifth of what ends a run
  constexpr double kWorthAWarning = 0.05;
  std::vector<std::pair<std::string, std::string>> out;
  if (r.ringing_steps > 0)
    out.emplace_back(
        "ringing",
        fmt::format(
            "in {} of {} steps blocks that deform knocked on others at hard contacts without restitution; only "
            "contact.alpha damps what they ring by then. Where they knock for long, how far they slip and rock "
            "hangs on the step, and far less with a joint of restitution = 0, or as rigid blocks",
            r.ringing_steps, r.steps));
  if (r.closed_share > kWorthAWarning)
    out.emplace_back("WARNING", fmt::format("{} (t = {:.4g} s)", r.closed_row, r.closed_time));
  if (const std::string jolt = jolt_text(scene, r); !jolt.empty()) out.emplace_back("WARNING", jolt);
  if (!audited)
    out.emplace_back("audit", "none (output.audit = false): nothing says that the forces are right");
  for (const StageResult& s : r.stages)
    if (!s.left_out.empty())
      out.emplace_back("not waited for", fmt::format("stage \"{}\": {}", s.name, s.left_out));
  if (const std::string side = free_field_side(scene, joints); !side.empty())
    out.emplace_back("WARNING",
                     fmt::format("the largest slip ends at the free-field side \"{}\": the ground beyond, "
                                 "which does not slip, holds it; move the side away",
                                 side));
  return out;
}

std::string summary_text(const Scene& scene, const RunResult& r, const RunNotes& notes, int frames,
                         const JointSummary& joints, const BoltSummary& bolts, const Histories* histories,
                         const std::string& model, const std::optional<audit::Report>& audit) {
  using nlohmann::ordered_json;
  const BlockSet& b = scene.blocks;
  const auto count = [&b](BlockKind k) { return std::count(b.kind.begin(), b.kind.end(), k); };
  ordered_json j;
  j["program"] = fmt::format("talus {}", kVersion);
  j["arithmetic"] = arithmetic_digest();
  j["title"] = scene.model.title;
  j["model_file"] = std::filesystem::path(scene.model.file).filename().string();
  j["model_hash"] = scene.model.hash;
  j["overrides"] = notes.overrides;
  for (const InputFile& file : scene.model.files)
    j["reads"].push_back(
        {{"file", std::filesystem::path(file.path).filename().string()}, {"digest", file.digest}});
  if (notes.branch) {
    const BranchOrigin& o = *notes.branch;
    j["branch"] = {{"state", o.state},   {"digest", o.digest},       {"model_hash", o.model_hash},
                   {"stage", o.stage},   {"stage_ended", o.between}, {"step", o.step},
                   {"time [s]", o.time}, {"differs", o.differs}};
  }
  j["status"] = !r.failure.empty() ? "failed" : r.interrupted ? "interrupted" : "finished";
  if (!r.failure.empty()) j["failure"] = r.failure;
  ordered_json warnings = notes.warnings;
  if (audit)
    for (const std::string& line : audit->lines(b.name)) warnings.push_back("audit: " + line);
  j["valid"] = audit ? ordered_json(audit->valid()) : ordered_json();
  for (const auto& [what, text] : warnings_of(scene, r, joints, audit.has_value()))
    warnings.push_back(what == "WARNING" ? text : what + ": " + text);
  j["warnings"] = warnings;
  j["audit"] = audit_numbers(scene, audit);

  j["blocks"] = {{"all", b.count},
                 {"deformable", count(BlockKind::kDeformable)},
                 {"rigid", count(BlockKind::kRigid)},
                 {"fixed", count(BlockKind::kFixed)},
                 {"driven", count(BlockKind::kDriven)},
                 {"needles_merged", scene.layout.needles_merged},
                 {"slivers_merged", scene.layout.slivers_merged},
                 {"slivers_deleted", scene.layout.slivers_deleted},
                 {"slivers_kept", scene.layout.slivers_kept}};
  j["contacts"] = {
      {"bond_faces", scene.bonds.faces.size()},         {"bond_faces_broken", r.broken_faces},
      {"supported_points", scene.supported.size()},     {"boundary_points", scene.boundaries.points.size()},
      {"tied_points", scene.boundaries.ties.size()},    {"contact_points_most", r.most_contacts},
      {"candidate_list_rebuilds", r.candidate_rebuilds}};
  j["joints"] = {{"time [s]", joints.time},
                 {"points", joints.points},
                 {"intact", joints.intact},
                 {"slipped", joints.slipped},
                 {"open", joints.open},
                 {"slip_largest [m]", joints.largest.slip},
                 {"opening_largest [m]", joints.widest}};
  const auto where = [&b](const JointPoint& p) {
    return ordered_json{
        {"x [m]", p.point.x}, {"y [m]", p.point.y}, {"blocks", {b.name[p.block_a], b.name[p.block_b]}}};
  };
  j["joints"]["slip_times_length [m2]"] = joints.slip_area;
  j["joints"]["broken_length [m]"] = joints.broken;
  for (const auto& [set, slip] : joints.slip_by_set) j["joints"]["slip_largest_by_set [m]"][set] = slip;
  for (const auto& [set, slip] : joints.residual_by_set)
    j["joints"]["residual_slip_largest_by_set [m]"][set] = slip;
  for (const auto& [set, length] : joints.broken_by_set)
    j["joints"]["broken_length_by_set [m]"][set] = length;
  if (r.penalty > 0)
    j["penalty"] = {{"normal_stiffness [N/m]", r.penalty},
                    {"steps_cut", r.cut_steps},
                    {"parts", r.parts},
                    {"penetration_deepest [m]", r.penetration},
                    {"condition_largest", r.condition}};
  if (bolts.bolts > 0)
    j["bolts"] = {{"count", bolts.bolts},
                  {"yielded", bolts.yielded},
                  {"ruptured", bolts.ruptured},
                  {"tension_largest [N]", bolts.tension},
                  {"tension_largest_in", bolts.tension_in}};
  j["moved"] = {{"blocks", joints.moved_blocks}, {"area [m2]", joints.moved_area}};
  const auto moved = [&](const char* key, int block, double way) {
    if (block < 0) return;
    j["moved"][key] = {
        {"block", b.name[block]}, {"displacement [m]", way}, {"share of its size", way / b.size[block]}};
  };
  moved("most_in_metres", joints.moved_far, joints.moved_way);
  moved("most_for_its_size", joints.moved_most,
        joints.moved_most < 0 ? 0 : joints.moved_share * b.size[joints.moved_most]);
  if (joints.largest.slip > 0) j["joints"]["slip_largest_at"] = where(joints.largest);
  j["joints"]["slipped_joints"] = joints.slipped_joints;
  if (joints.slipped_joints > 0) {
    j["joints"]["residual_slip_largest [m]"] = joints.most_residual.residual_slip();
    j["joints"]["residual_slip_largest_while_open [m]"] = joints.most_residual.slip_while_open();
    j["joints"]["residual_slip_largest_at"] = where(joints.most_residual);
    if (!joints.most_residual.set.empty())
      j["joints"]["residual_slip_largest_at"]["set"] = joints.most_residual.set;
  }
  j["model"] = ordered_json::parse(model);
  j["stages"] = ordered_json::array();
  for (const StageResult& s : r.stages) {
    ordered_json stage = {{"name", s.name},
                          {"kind", s.kind == StageKind::kStatic ? "static" : "dynamic"},
                          {"begin [s]", s.begin},
                          {"end [s]", s.end},
                          {"steps", s.steps},
                          {"dt [s]", s.plan.dt},
                          {"dt_bound_block", bound_name(scene, s.plan)},
                          {"blocks_clamped", s.plan.clamped},
                          {"largest_clamp", s.plan.largest_clamp},
                          {"unbalanced", s.unbalanced}};
    if (std::isfinite(s.plan.dt_bound))  // where nothing bounds the step there is no bound
      stage["dt_bound [s]"] = s.plan.dt_bound, stage["dt_bound_undamped [s]"] = s.plan.dt_undamped;
    if (s.kind == StageKind::kStatic) stage["at_rest"] = s.at_rest;
    if (s.plan.balances > 0) stage["balances"] = s.balances, stage["balances_of_path"] = s.plan.balances;
    if (s.followed()) {
      stage["steps_from_rest"] = s.steps_from_rest;
      stage["followed_from [s]"] = s.followed_from;
      stage["followed_because"] = s.followed_because;
    }
    if (!s.left_out.empty()) stage["left_out"] = s.left_out, stage["left_out_share"] = s.left_out_share;
    j["stages"].push_back(stage);
  }
  ordered_json& solver = j["solver"];
  solver = {{"method", name_of(scene.model.solver.method)},
            {"jacobian", scene.model.solver.jacobian == JacobianKind::kAnalytic ? "analytic" : "difference"},
            {"contact_solves", r.steps},
            {"failed_steps", r.failed_steps},
            {"loose_steps", r.loose_steps},
            {"ringing_steps", r.ringing_steps},
            {"steps_cut", r.penalty > 0 ? 0 : r.cut_steps},
            {"second_solver_steps", r.second_solver_steps}};
  for (size_t k = 1; k < kSolverName.size(); ++k)
    solver[fmt::format("{}_steps", kSolverName[k])] = r.steps_by[k];
  solver["drift_deepest [m]"] = r.deepest_drift;
  solver["iterations_mean"] =
      r.steps > 0 ? static_cast<double>(r.iterations) / static_cast<double>(r.steps) : 0.0;
  solver["iterations_most"] = r.most_iterations;
  solver["contact_error_worst [m]"] = r.worst_error;
  solver["contact_error_time [s]"] = r.worst_error_time;
  solver["contact_error_at"] = r.worst_error_row;
  const Energy& e = r.energy;
  auto& energy = j["energy [J]"];
  energy = {{"kinetic", e.kinetic},
            {"between_steps", e.between},
            {"strain", e.strain},
            {"gravity_work", e.gravity}};
  for (size_t k = 0; k < kCauses; ++k) {
    std::string name(kCauseName[k]);
    std::replace(name.begin(), name.end(), ' ', '_');
    energy[name + "_work"] = e.work.by[k];
  }
  energy["left_over"] = e.left_over;
  energy["left_over_largest"] = r.largest_left_over;
  energy["term_largest"] = r.largest_energy;
  j["energy_closure"] = r.closure();
  if (histories) j["monitors"] = monitor_numbers(scene, *histories);
  j["frames"] = frames;
  j["wall_time [s]"] = r.wall_seconds;
  j["cpu_time [s]"] = r.cpu_seconds;
  return j.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace talus
