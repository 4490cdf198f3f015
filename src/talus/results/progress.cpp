#include "talus/results/progress.h"

#include <fmt/format.h>

#include <algorithm>

#include "talus/base/clock.h"
#include "talus/base/text.h"
#include "talus/results/slip_report.h"
#include "talus/results/summary.h"

namespace talus {

namespace {

constexpr double kRewriteInterval = 0.5, kLineInterval = 10;  // [s] of wall time

// Of a stage from rest, whose blocks stand after each step, velocity says nothing.
std::string rest_left(const StageInput& stage, const StepReport& report) {
  if (stage.kind != StageKind::kStatic) return "";
  if (stage.from_rest)
    return fmt::format(", unbalanced {:.1e}, to come below {:g}", report.unbalanced, stage.unbalanced);
  return fmt::format(", unbalanced {:.1e} and velocity {:.1e}, both to come below {:g}", report.unbalanced,
                     report.speed_left, stage.unbalanced);
}

// What blocks do: the fastest, and faces that have broken.
std::string moving(const Instant& i) {
  double fastest = 0;
  size_t block = 0;
  for (size_t k = 0; k < i.state.rate.size(); ++k) {
    const double v = norm(i.state.rate[k].a);
    if (v > fastest) fastest = v, block = k;
  }
  const auto broken =
      std::count_if(i.state.face.begin(), i.state.face.end(), [](const FaceState& f) { return f.broken; });
  std::string out;
  if (fastest > 0) out = fmt::format(", fastest {} {:.2g} m/s", i.scene.blocks.name[block], fastest);
  if (broken > 0) out += fmt::format(", {} face{} broken", broken, broken == 1 ? "" : "s");
  return out;
}

}  // namespace

void say(std::FILE* out, const std::string& text) { std::fwrite(text.data(), 1, text.size(), out); }

void Progress::stage_begins(const Scene& scene, int stage, const StagePlan& plan) {
  next_.stage_begins(scene, stage, plan);
  finish();
  const StageInput& s = scene.model.stages[stage];
  const bool at_rest = s.kind == StageKind::kStatic;
  const std::string how = (s.from_rest  ? ", steps from rest"
                           : s.implicit ? ", implicit elasticity"
                                        : "") +
                          damping_text(s);
  const std::string steps = s.from_rest
                                ? fmt::format("at most {:g} s, the first step {:.4g} s", s.duration, plan.dt)
                                : fmt::format("{:g} s in {}{} steps of {:.4g} s", s.duration,
                                              at_rest ? "at most " : "", plan.steps, plan.dt);
  // where the clock of histories is met for the first time, and where it goes on
  const double history_time = scene.model.history_time_at(stage);
  const std::string clock =
      s.path > 0 ? fmt::format("; histories from {:g} to {:g} s in {} balances", history_time,
                               history_time + s.path, plan.balances)
      : at_rest || scene.model.histories.empty()
          ? ""
          : fmt::format("; histories (their clock stands in static stages) from {:g} s", history_time);
  say(out_, fmt::format("stage {}/{} \"{}\" ({}{}): {}{}\n", stage + 1, scene.model.stages.size(), s.name,
                        at_rest ? "static" : "dynamic", how, steps, clock));
  std::fflush(out_);
  stage_wall_ = last_shown_ = wall_now();
  stage_step_ = 0;
}

void Progress::blocks_are_left_out(const Scene& scene, int stage, const std::string& who) {
  next_.blocks_are_left_out(scene, stage, who);
  finish();
  say(out_, fmt::format("  {}: not waited for: {}\n", scene.model.stages[stage].name, who));
}

void Progress::stage_is_followed(const Scene& scene, int stage, const StagePlan& plan,
                                 const std::string& why) {
  next_.stage_is_followed(scene, stage, plan, why);
  finish();
  say(out_, fmt::format("  {}: {}; followed by damped motion, {:g} s in at most {} steps of {:.4g} s\n",
                        scene.model.stages[stage].name, why, plan.dt * static_cast<double>(plan.steps),
                        plan.steps, plan.dt));
  std::fflush(out_);
  stage_wall_ = last_shown_ = wall_now();
  stage_step_ = 0;
}

void Progress::at(const Instant& instant) {
  next_.at(instant);
  worst_error_ = std::max(worst_error_, instant.report.error.worst);
  if (stage_step_++ == 0) pace_.begin(wall_now(), static_cast<double>(instant.steps_before));
  // the clock is not asked at every short step
  const StageInput& stage = instant.scene.model.stages[instant.stage];
  if (instant.last || (!stage.from_rest && stage_step_ % 16 != 0)) return;
  const double now = wall_now();
  if (now - last_shown_ < (terminal_ ? kRewriteInterval : kLineInterval)) return;
  show(instant, now);
  last_shown_ = now;
}

void Progress::show(const Instant& instant, double now) {
  const double rate = static_cast<double>(stage_step_) / (now - stage_wall_);
  pace_.add(now, static_cast<double>(instant.steps_before));
  const StageInput& s = instant.scene.model.stages[instant.stage];
  const double share =
      100 * static_cast<double>(instant.steps_before) / static_cast<double>(instant.plan.steps);
  const Pace::Range left = pace_.of(static_cast<double>(instant.plan.steps - instant.steps_before));
  const std::string to_go =
      s.kind == StageKind::kStatic ? "at most " + readable_seconds(left.high) : readable_range(left);
  const std::string pace =
      s.from_rest
          ? fmt::format("step {} of {:.4g} s", stage_step_, instant.work.clock.dt) +
                (s.path > 0
                     ? fmt::format(", {} of {} balances", instant.state.rest.balances, instant.plan.balances)
                     : "")
          : fmt::format("{:.0f} %, {} to go", share, to_go);
  const std::string steps = s.from_rest ? "" : fmt::format(", {:.0f} steps/s", rate);
  const std::string line =
      fmt::format("  {}: t = {:.4g} s, {}{}{}, contact error {:.0e} m{}", s.name, instant.state.time, pace,
                  rest_left(s, instant.report), moving(instant), worst_error_, steps);
  say(out_, (terminal_ ? "\r" : "") + line + (terminal_ ? "\x1b[K" : "\n"));
  std::fflush(out_);
  line_open_ = terminal_;
}

void Progress::finish() {
  if (line_open_) say(out_, "\r\x1b[K");
  line_open_ = false;
}

namespace {

// Of residual slip that is more than was slid, as far as the digits show it: the rest came while the joint was open.
std::string open_text(const JointPoint& p) {
  const double went = p.slip_while_open(), left = p.residual_slip();
  return fmt::format("{:.3g}", left) != fmt::format("{:.3g}", left - went)
             ? fmt::format(" ({:.3g} m of it while the joint was open)", went)
             : "";
}

// The block that has gone furthest, in metres and for its size.
std::string moved_text(const Scene& scene, const JointSummary& joints) {
  const auto line = [&scene](const std::string& by, int block, double way, double share) {
    return fmt::format("  moved most      {}, {:.3g} m ({:.2g} % of its size){}\n", scene.blocks.name[block],
                       way, 100 * share, by);
  };
  const auto size = [&scene](int block) { return scene.blocks.size[block]; };
  const int most = joints.moved_most, far = joints.moved_far;
  if (most == far || far < 0) return line("", most, joints.moved_share * size(most), joints.moved_share);
  return line(", in metres", far, joints.moved_way, joints.moved_way / size(far)) +
         line(", for its size", most, joints.moved_share * size(most), joints.moved_share);
}

}  // namespace

std::string closing_text(const Scene& scene, const RunResult& r, const JointSummary& joints,
                         const BoltSummary& bolts, const std::string& folder,
                         const std::optional<audit::Report>& audit) {
  std::string out;
  const char* ending = !r.failure.empty() ? "failed"
                       : r.interrupted    ? "interrupted; the results up to then are valid"
                                          : "finished";
  out += fmt::format("{}: {} blocks, {} steps, {} wall, {} CPU\n", ending, scene.blocks.count, r.steps,
                     readable_seconds(r.wall_seconds), readable_seconds(r.cpu_seconds));
  if (r.steps > 0 && r.penalty == 0)
    out += fmt::format(
        "  contact error   worst {:.2e} m at t = {:.4g} s; {} of {} steps not solved{}{}; {:.1f} iterations a "
        "step, at most {}\n",
        r.worst_error, r.worst_error_time, r.failed_steps, r.steps,
        r.loose_steps > 0
            ? fmt::format(", {} loose (above the tolerance, within solver.limit)", r.loose_steps)
            : "",
        r.cut_steps > 0 ? fmt::format(", {} cut into {} parts", r.cut_steps, r.parts) : "",
        static_cast<double>(r.iterations) / static_cast<double>(r.steps), r.most_iterations);
  if (r.steps > 0) {
    out += fmt::format(
        "  energy ledger   {:.2e} of its largest term ({:.3g} J) left over, {}; closing contacts took {:.4g} "
        "J\n",
        r.closure(), r.largest_energy,
        r.closure() < 1e-2 ? "good below 1e-2" : "TOO MUCH: above 1e-2, look in steps.csv",
        0.0 - r.energy.work[Cause::kContactClosing]);
  }
  if (r.penalty > 0)
    out += fmt::format(
        "  penalty         normal springs of {:.3g} N/m; {} of {} steps cut, {} parts in all; deepest penetration {:.3g} m; "
        "largest pivot over smallest {:.1g}\n",
        r.penalty, r.cut_steps, r.steps, r.parts, r.penetration, r.condition);
  for (const auto& [what, text] : warnings_of(scene, r, joints, audit.has_value()))
    out += fmt::format("  {:<14}  {}\n", what, text);
  if (audit) {
    out += fmt::format(
        "  audit           {}; {} frames and {} steps looked at; unexplained overlap {:.1e} of the smaller "
        "block at most, closure {:.2g} %\n",
        !audit->valid()              ? "NOT VALID"
        : audit->warning_kinds() > 0 ? "valid, with warnings"
                                     : "valid",
        audit->frames, audit->steps, audit->unexplained_share, 100 * audit->closure_share);
    for (const std::string& line : audit->lines(scene.blocks.name)) out += "    " + line + "\n";
  }
  const Layout& cut = scene.layout;
  if (cut.slivers_merged + cut.slivers_deleted > 0)
    out += fmt::format(
        "  slivers         {} merged, {} deleted, {} kept when the blocks were cut: a mechanism may be "
        "hidden there (red in cut.png of talus cut)\n",
        cut.slivers_merged, cut.slivers_deleted, cut.slivers_kept);
  for (const StageResult& s : r.stages) {
    if (s.plan.clamped > 0)
      out += fmt::format("  moment clamp    stage \"{}\": {} of {} blocks, up to {:.3g} times\n", s.name,
                         s.plan.clamped, scene.blocks.count, s.plan.largest_clamp);
    if (s.at_rest)
      out += fmt::format(
          "  at rest         stage \"{}\" after {} steps{}, unbalanced {:.1e}\n", s.name, s.steps,
          s.plan.balances > 0 ? fmt::format(", at each of {} balances of its path", s.plan.balances)
          : s.followed()      ? fmt::format(" ({} from rest, then damped motion)", s.steps_from_rest)
                              : "",
          s.unbalanced);
  }
  if (r.broken_faces > 0)
    out += fmt::format(
        "  broken          {} of {} faces held together (bonded, or by cohesion or tensile strength)\n",
        r.broken_faces, scene.bonds.faces.size());
  if (joints.slipped_joints > 0)
    out += fmt::format(
        "  slipped         {} joint{}, residual slip {:.3g} m at most{}: {}; all in slips.csv\n",
        joints.slipped_joints, joints.slipped_joints == 1 ? "" : "s", joints.most_residual.residual_slip(),
        open_text(joints.most_residual), place_text(scene, joints.most_residual));
  if (bolts.bolts > 0) out += fmt::format("  bolts           {}\n", bolts.text());
  constexpr double kWorthALine = 1e-3;  // of its size
  if (joints.moved_share > kWorthALine) out += moved_text(scene, joints);
  out += fmt::format(
      "  results         {0}: summary.json, histories.csv, steps.csv, blocks_end.svg, fields/view.py "
      "(ParaView)\n"
      "  next            talus report {0}\n",
      folder);
  return out;
}

}  // namespace talus
