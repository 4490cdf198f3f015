#include "talus/run/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>
#include <optional>

#include "talus/base/clock.h"
#include "talus/base/error.h"
#include "talus/base/index.h"
#include "talus/base/memory_reserve.h"
#include "talus/base/rank.h"
#include "talus/contact/pairs.h"
#include "talus/run/mechanism.h"
#include "talus/run/path.h"
#include "talus/run/rest_judge.h"
#include "talus/run/step_notes.h"
#include "talus/run/stepper.h"
#include "talus/run/steps_from_rest.h"
#include "talus/run/unrest.h"
#include "talus/step/change.h"

namespace talus {

namespace {

// Steps from rest within which a stage finds its balance, if there is one near: those of 51,000 blocks took 89.
constexpr int64_t kMostFromRest = 300;

// How far blocks go in them, as share of their size, on the way to a balance that is near; and how far what slides goes before
// it is called a mechanism: it may come to lie on something yet.
constexpr double kFarFromRest = 0.5, kMechanismWay = 1.5;

}  // namespace

class StagedRun::Runner {
 public:
  Runner(Scene& scene, const std::vector<StagePlan>& plans, State& state, Observer& observer,
         const Workers& workers)
      : scene_(scene), plans_(plans), state_(state), observer_(observer), unclamped_(scene.blocks) {
    // stages of other steps must not find other contacts
    // stages of a branch keep that of the run that it comes from
    if (!(scene_.give.shortest_step > 0)) scene_.give.shortest_step = std::numeric_limits<double>::infinity();
    for (const StagePlan& plan : plans)
      scene_.give.shortest_step = std::min(scene_.give.shortest_step, plan.dt);
    work_.workers = workers;
    if (scene.model.formulation == Formulation::kPenalty)
      motion_ = make_penalty_stepper(scene_, work_, state_, result_);
    else
      motion_ = std::make_unique<ExplicitSteps>(scene_, work_, state_);
  }

  // Makes the state ready. Trouble is told by the first go().
  void begin(const Standing* from) {
    attempt([&] {
      motion_->begin();
      if (from) go_on(*from);
      return true;
    });
  }

  // Whether the run goes on when `pause` is reached.
  bool go(const Pause& pause) {
    return attempt([&] {
      for (int64_t taken = 0;; ++taken) {
        if (!in_stage_) {
          if (result_.interrupted || result_.stages.size() >= plans_.size()) return show_end(), false;
          begin_stage(count_of(result_.stages));
        }
        const double close = 1e-6 * plans_[result_.stages.size() - 1].dt;  // sums of steps are not round
        if (taken >= pause.steps || state_.time >= pause.time - close) return true;
        if (take_step() && steps_of_plan() < plans_[result_.stages.size() - 1].steps) continue;
        end_stage();
        if (pause.stage_end && !result_.interrupted && result_.stages.size() < plans_.size()) return true;
      }
    });
  }

  // Ends it where it stands, when it has not come to its end.
  void stop() {
    if (over_) return;
    attempt([&] {
      if (result_.stages.empty()) begin_stage(0);  // the last instant is one of a stage
      result_.interrupted = true;
      observer_.keep_state(standing(), state_);
      if (in_stage_) end_stage();
      return show_end(), false;
    });
  }

  bool over() const { return over_; }
  Standing standing() const { return {result_, !in_stage_}; }
  const RunResult& result() const { return result_; }

 private:
  // What is done while the clock of the run goes. Numerical trouble ends the run.
  template <class What>
  bool attempt(const What& what) {
    if (over_) return false;
    const double wall = wall_now(), shared = work_.workers.shared_seconds(),
                 idle = work_.workers.idle_seconds();
    const std::clock_t cpu = std::clock();
    try {
      const InPart part(work_.profile, Profile::kRest);
      over_ = !what();
    } catch (const NumericalError& e) {
      over_ = true;
      result_.failure = e.what();
      if (result_.no_rest) show_unrest();
    }
    result_.candidate_rebuilds = state_.candidates.rebuilds;
    result_.threads = work_.workers.threads();
    shared_ += work_.workers.shared_seconds() - shared;
    wall_ += wall_now() - wall;
    result_.profile = work_.profile;
    result_.profile.shared = shared_, result_.profile.wall = wall_;
    result_.wall_seconds += wall_now() - wall;
    // helpers that stand by keep their processors busy and do nothing
    result_.cpu_seconds +=
        static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC - (work_.workers.idle_seconds() - idle);
    result_.broken_faces = 0;
    for (const FaceState& f : state_.face) result_.broken_faces += f.broken;
    return !over_;
  }

  void begin_stage(int index) {
    const StageInput& stage = scene_.model.stages[index];
    const StagePlan& plan = plans_[index];
    change(index);
    settle_in(stage);
    const auto is_static = [&](size_t i) { return scene_.model.stages[i].kind == StageKind::kStatic; };
    enter_stage(scene_.boundaries, index > 0 && is_static(index - 1), is_static(index), state_);
    install_bolts(scene_.model, scene_.blocks, index, state_);
    state_.largest_kinetic = 0;
    state_.rest = StepsFromRest::first_look(plan.dt), state_.left_out.clear();
    state_.rest.begin = state_.time;
    judge_.begin();
    if (stage.from_rest) stop_motion(scene_, state_);
    state_.relaxed = stage.relaxed_at(0, state_.relaxed);
    if (stage.reset_displacements) {
      state_.displacement_start = state_.displacement;
      state_.strain_part_start = state_.strain_part;
    }
    StageResult& out = result_.stages.emplace_back();
    out.name = stage.name, out.kind = stage.kind, out.plan = plan;
    out.begin = out.end = state_.time;
    enter_steps(index);
  }

  void settle_in(const StageInput& stage) {
    settings_ = {.damping_mass = stage.damping_mass,
                 .damping_stiffness = stage.damping_stiffness,
                 .damping_local = stage.damping_local,
                 .tolerance = scene_.model.solver.tolerance * tolerance_size(scene_.blocks),
                 .limit = scene_.model.solver.limit * tolerance_size(scene_.blocks),
                 .dynamic = stage.kind == StageKind::kDynamic,
                 .implicit = stage.implicit,
                 .from_rest = stage.from_rest,
                 .keep_guess = true};
    motion_->settle(stage);
    work_.mobility.clear();  // of other inertias
  }

  // From a saved run: the scene of its stage, and the rest of that stage.
  void go_on(const Standing& from) {
    result_ = from.result;
    result_.interrupted = false;
    const int index = count_of(result_.stages) - 1;
    for (int i = 0; i <= index; ++i) change_scene(i, scene_);
    unclamped_ = scene_.blocks;
    const StagePlan& plan = plans_[index];
    if (plan.clamped > 0) clamp_moments(scene_.blocks, plan.clamp_dt);
    settle_in(scene_.model.stages[index]);
    // hard contacts give by the shortest step of what has been
    for (size_t i = 0; i < result_.stages.size(); ++i)
      if (result_.stages[i].followed())
        scene_.give.shortest_step = std::min(scene_.give.shortest_step, plans_[i].dt_follow);
    if (result_.stages.back().followed()) go_by_motion();
    if (from.between)
      goals_ = path_goals(scene_, index);
    else
      enter_steps(index);
  }

  void enter_steps(int index) {
    in_stage_ = true;
    advance_ = plans_[index].dt;
    observer_.stage_begins(scene_, index, plans_[index]);
    motion_->stand(advance_);
    from_rest_ = std::make_unique<StepsFromRest>(scene_, work_, state_);
    goals_ = path_goals(scene_, index);
  }

  // Where the histories of the present balance stand: on a path at its next goal.
  double history_goal() const { return goals_.empty() ? state_.history_time : goals_[state_.rest.balances]; }

  // A balance was found; whether another one is to be.
  bool next_balance() {
    if (goals_.empty()) return false;
    StageResult& out = result_.stages.back();
    out.balances = ++state_.rest.balances;
    if (state_.rest.balances >= count_of(goals_)) return false;
    from_rest_->go_on(history_goal(), plans_[result_.stages.size() - 1].dt, out.steps);
    return true;
  }

  // ", behind 12 of 21 balances of its path, on the way of the histories from 0.55 to 0.6 s", for messages.
  std::string on_path() const {
    if (goals_.empty()) return "";
    const int found = state_.rest.balances;
    if (found == 0) return ", at the beginning of its path";
    return fmt::format(", behind {} of {} balances of its path, as the histories go from {:.6g} to {:.6g} s",
                       found, goals_.size(), goals_[found - 1], goals_[found]);
  }

  // Steps of the present stage in the way of its plan: those from rest before are not among them.
  int64_t steps_of_plan() const {
    const StageResult& out = result_.stages.back();
    return out.followed() ? out.steps - out.steps_from_rest : out.steps;
  }

  // The same of the present balance alone, on a path.
  int64_t steps_of_balance() const { return result_.stages.back().steps - state_.rest.begin_steps; }

  // Time of the present stage after so many steps of its plan [s].
  double stage_time(int64_t steps) const {
    const StageResult& out = result_.stages.back();
    const double before = out.followed() ? out.followed_from - out.begin : 0;
    return before + plans_[result_.stages.size() - 1].dt * static_cast<double>(steps);
  }

  // From the steps from rest of a stage to the damped motion that follows what they brought into no balance.
  void follow_motion(const std::string& because) {
    StageResult& out = result_.stages.back();
    out.steps_from_rest = out.steps, out.followed_from = state_.time, out.followed_because = because;
    state_.rest = {}, state_.left_out.clear();
    judge_.begin();
    state_.largest_kinetic = 0;
    std::fill(state_.rate.begin(), state_.rate.end(), BlockRate{});
    go_by_motion();
    const int index = count_of(result_.stages) - 1;
    observer_.stage_is_followed(scene_, index, plans_[index], because);
  }

  // The plan and the settings of that.
  void go_by_motion() {
    const size_t k = result_.stages.size() - 1;
    StagePlan& plan = plans_[k];
    scene_.model.stages[k].go_by_motion();
    plan.dt = plan.dt_follow, plan.steps = plan.steps_follow;
    plan.dt_bound = plan.dt_undamped = plan.bound_follow;
    scene_.give.shortest_step = std::min(scene_.give.shortest_step, plan.dt);
    settle_in(scene_.model.stages[k]);
    advance_ = plan.dt;
  }

  // Crumbs that go on without an end are no matter of the others' rest: named, and waited for no longer.
  bool leaves_out(const StageInput& stage, const Mechanism& m) {
    StageResult& out = result_.stages.back();
    if (stage.strict_rest || m.members.empty() || !(out.left_out_share + m.share < kMechanismShare))
      return false;
    out.left_out_share += m.share;
    const std::string who = m.text(scene_, state_);
    out.left_out += (out.left_out.empty() ? "" : "; ") + who;
    std::vector<int>& all = state_.left_out;
    all.insert(all.end(), m.members.begin(), m.members.end());
    std::sort(all.begin(), all.end());
    state_.rest.gone = state_.rest.gone_many = 0;
    observer_.blocks_are_left_out(scene_, count_of(result_.stages) - 1, who);
    return true;
  }

  // Whether damped motion that has not come to rest never will: it is the fastest at its end, and at half of that pace, which is
  // that of a constant pull, blocks have gone as far as from any balance that was near.
  bool slides_on(const StageInput& stage, const Mechanism& m) const {
    const StageResult& out = result_.stages.back();
    const double moved_for = out.end - (out.followed() ? out.followed_from : out.begin);
    return steps(stage).has_inertia() && m.slides && m.share >= kMechanismShare &&
           last_.energy.moving >= state_.largest_kinetic &&
           0.5 * moved_for * pace_of_many(scene_.blocks, state_) > kFarFromRest;
  }

  // A mechanism ends the run.
  [[noreturn]] void fail_by(const Mechanism& m, const std::string& how) {
    result_.mechanism = result_.no_rest = true;
    throw NumericalError(
        fmt::format("static stage \"{}\" finds no balance{}: a mechanism. {}. {}; blocks_end.svg shows it",
                    result_.stages.back().name, on_path(), m.text(scene_, state_), how));
  }

  // Whether steps from rest have said all they can say, and blocks are followed as they move; tells why. A mechanism ends the
  // run.
  bool gives_up_rest(const StageInput& stage, const StageResult& out, std::string& because) {
    if (!stage.from_rest) return false;
    if (state_.rest.gone > kFarFromRest) {
      const Mechanism m = find_mechanism(scene_, state_);
      const bool goes_on = state_.rest.gone_many > kMechanismWay || steps_of_balance() >= kMostFromRest;
      if (m.slides && m.share >= kMechanismShare && goes_on)
        fail_by(m, fmt::format("{} steps from rest; {}", goals_.empty() ? out.steps : steps_of_balance(),
                               goals_.empty()
                                   ? fmt::format("stage.{}.integration = \"dynamic\" follows it", stage.name)
                                   : "histories.csv has the balances before it"));
      if (leaves_out(stage, m)) return false;
      // what slides may come to lie on something: not what falls, or is a crumb
      if (stage.may_follow && !(m.slides && m.share >= kMechanismShare))
        return because = "no balance near: " + m.text(scene_, state_), true;
    }
    if (!stage.may_follow) return false;
    if (out.steps >= kMostFromRest)
      because = fmt::format("no balance in {} steps from rest", out.steps);
    else if (state_.time >= out.begin + stage.duration)
      because = fmt::format("no balance in {:g} s of steps from rest", stage.duration);
    return !because.empty();
  }

  // Whether the stage goes on after a step more.
  bool take_step() {
    const int index = count_of(result_.stages) - 1;
    const StageInput& stage = scene_.model.stages[index];
    const StagePlan& plan = plans_[index];
    StageResult& out = result_.stages.back();
    if (std::string because; gives_up_rest(stage, out, because)) follow_motion(because);
    const int64_t n = steps_of_plan();
    if (n >= plan.steps) return false;
    if (memory_is_short()) throw std::bad_alloc();  // while there is some left to end in order
    if (stops()) {
      result_.interrupted = true;
      return false;
    }
    if (stage.from_rest && state_.time >= state_.rest.begin + stage.duration) return false;
    settings_.sharper = state_.rest.sharper;
    double part = plan.dt;
    const auto kicked = kick(index, part);
    if (!kicked) return follow_motion(steps(stage).why_not()), true;
    StepReport report = *kicked;
    if (stage.kind == StageKind::kStatic)
      report.speed_left = judge_.speed_left(report, advance_ / plan.dt_bound);
    // faces that break in the drift are told in the balance after them
    const bool rests = stage.kind == StageKind::kStatic && n >= 1 && is_relaxed(stage, n) &&
                       judge_.is_at_rest(stage, report) &&
                       (!stage.from_rest || from_rest_->stands(!goals_.empty()));
    show({scene_, state_, work_, report, plan, advance_, index, out.steps == 0, false, n,
          !goals_.empty() && !rests && out.steps > 0});
    // from the start of the stage, not by adding: the last step ends exactly on the stage's end
    const double end = stage.from_rest ? state_.time + advance_ : out.begin + stage_time(n + 1);
    go_on_or_fail(index, n, part < plan.dt ? state_.time + part : end, report);
    if (part < plan.dt) go_on_in_parts(index, n, part, end, report);
    if (!goals_.empty()) from_rest_->arrive(history_goal());
    ++out.steps;
    if (stage.from_rest)
      from_rest_->lengthen(plan.dt, is_relaxed(stage, 0));
    else
      state_.relaxed = stage.relaxed_at(stage_time(n + 1), state_.relaxed);
    out.unbalanced = report.unbalanced;
    last_ = report;
    state_.largest_kinetic = std::max(state_.largest_kinetic, report.energy.moving);
    if (stage.kind != StageKind::kStatic) return true;
    if (rests && !(stage.from_rest && report.broken_faces > 0)) {
      out.at_rest = !next_balance();
      return !out.at_rest;
    }
    return !judge_.stalls(stage, report, is_relaxed(stage, n), plan.dt * static_cast<double>(plan.steps - n));
  }

  Stepper& steps(const StageInput& stage) const {
    return stage.from_rest ? static_cast<Stepper&>(*from_rest_) : *motion_;
  }

  std::optional<StepReport> kick(int index, double& dt) {
    const StageInput& stage = scene_.model.stages[index];
    return steps(stage).kick({stage, plans_[index], result_.stages[index].begin, history_goal()}, settings_,
                             dt, advance_);
  }

  // The rest of a step of which a part is over.
  void go_on_in_parts(int index, int64_t n, double part, double end, StepReport& report) {
    ++result_.cut_steps, ++result_.parts;
    while (state_.time < end) {
      const double left = end - state_.time;
      const bool last = part > (1 - 1e-6) * left;
      if (last) part = left;
      double taken = part;
      report = kick(index, taken).value();
      go_on_or_fail(index, n, last && taken == part ? end : state_.time + taken, report);
      part = taken;
      ++result_.parts;
    }
  }

  void end_stage() {
    StageResult& out = result_.stages.back();
    const StageInput& stage = scene_.model.stages[result_.stages.size() - 1];
    in_stage_ = false;
    out.end = state_.time;
    // the next stage begins at rest; until now they told how far to look ahead
    if (stage.from_rest && out.at_rest) std::fill(state_.rate.begin(), state_.rate.end(), BlockRate{});
    if (stage.kind == StageKind::kStatic && !out.at_rest && !result_.interrupted) {
      result_.no_rest = true;
      const double elapsed = out.end - (goals_.empty() ? out.begin : state_.rest.begin);
      if (const Mechanism m = find_mechanism(scene_, state_); slides_on(stage, m))
        fail_by(m, fmt::format("after {} steps they go faster than ever", out.steps));
      throw NumericalError(
          unrest().text(stage, elapsed, goals_.empty() ? out.steps : steps_of_balance(), on_path()));
    }
    if (!result_.interrupted) observer_.keep_state({result_, true}, state_);
  }

  // What the step found is judged, and the blocks move. The instant of a step that ends the run is seen too,
  // and shown once more with everything in its place.
  void go_on_or_fail(int index, int64_t n, double end, StepReport& report) {
    const StagePlan& plan = plans_[index];
    displacement_ = state_.displacement;
    strain_part_ = state_.strain_part;
    try {
      notes_.note(report, settings_, state_);
      steps(scene_.model.stages[index]).move(end, settings_, report);
    } catch (const NumericalError&) {
      state_.displacement = displacement_;
      state_.strain_part = strain_part_;
      observer_.fails({scene_, state_, work_, report, plan, advance_, index, n == 0, true, n});
      throw;
    }
  }

  // From the scene of the stage before to this one. What changes the energy of blocks here is no work, so not
  // in the ledger: the moments of clamped blocks, what is taken out or gets other moduli.
  void change(int index) {
    const std::vector<char> out = excavated_blocks(scene_, index);
    if (!scene_.model.stages[index].excavate.empty()) keep_forces(index, out);
    const double energy = ledger_energy(scene_, state_);
    const BlockSet before = std::move(scene_.blocks);
    const std::vector<SupportedPoint> supported = scene_.supported;
    scene_.blocks = unclamped_;
    change_scene(index, scene_);
    unclamped_ = scene_.blocks;
    const StagePlan& plan = plans_[index];
    if (plan.clamped > 0) clamp_moments(scene_.blocks, plan.clamp_dt);
    adapt_state(before, supported, scene_, state_);
    state_.energy_start += ledger_energy(scene_, state_) - energy;
    if (before.kind != scene_.blocks.kind) work_.solvers.forget();
  }

  // What the blocks to be taken out push on the others now, found on a copy of the state.
  void keep_forces(int index, const std::vector<char>& out) {
    state_.kept_force.clear();
    // before the first stage nothing has pushed yet
    if (index == 0 || scene_.model.stages[index].relaxation.empty()) return;
    State copy = state_;
    talus::kick(scene_, settings_, plans_[index - 1].dt, work_, copy);
    state_.kept_force = forces_of_blocks(work_, out);
  }

  Unrest unrest() const {
    return {scene_, state_, last_, judge_.look(), plans_[result_.stages.size() - 1].dt, work_.clock.dt};
  }

  // Whether the run is to stop here; hands over states that are wanted.
  bool stops() {
    const InPart part(work_.profile, Profile::kObservers);
    const bool stop = observer_.stop();
    if (stop || observer_.wants_state()) observer_.keep_state({result_, false}, state_);
    if (!stop && observer_.wants_copy()) observer_.hold_state({result_, false}, state_);
    return stop;
  }

  void show(const Instant& instant) {
    const InPart part(work_.profile, Profile::kObservers);
    observer_.at(instant);
  }

  bool is_relaxed(const StageInput& stage, int64_t n) const {
    if (stage.from_rest) return stage.relaxation.empty() || state_.relaxed >= stage.relaxation.back().y;
    return stage.relaxation.empty() || stage_time(n) >= stage.relaxation.back().x;
  }

  // A stage without rest ends between two sound steps: the instant is shown like that of any end, with its pictures.
  void show_unrest() {
    try {
      show_end();
    } catch (const NumericalError&) {  // the run has failed already, and says why
    }
  }

  // The last instant has its forces too, found on a copy so that the state stays between two steps.
  void show_end() {
    if (result_.stages.empty()) return;
    const int index = count_of(result_.stages) - 1;
    const StagePlan& plan = plans_[index];
    State copy = state_;
    const StepReport report = motion_->look(settings_, plan.dt, copy);
    notes_.note(report, settings_, copy);
    // a run that is stopped between two stages has not shown the begin of the second
    const bool at_start = result_.stages.back().steps == 0;
    show({scene_, copy, work_, report, plan, plan.dt, index, at_start, true, 0, !goals_.empty()});
  }

  Scene& scene_;
  std::vector<StagePlan> plans_;
  State& state_;
  Observer& observer_;
  BlockSet unclamped_;
  std::vector<Vec2> displacement_;  // before the drift
  std::vector<Mat2> strain_part_;
  StepReport last_;
  StepSettings settings_;
  StepWork work_;
  std::unique_ptr<Stepper> motion_;  // in which blocks have speed
  std::vector<double> goals_;        // of the path of the stage that goes on; empty: none
  // of that stage
  bool in_stage_ = false, over_ = false;
  double advance_ = 0;
  std::unique_ptr<StepsFromRest> from_rest_;
  double wall_ = 0, shared_ = 0;  // [s] of Profile
  RunResult result_;
  StepNotes notes_{scene_, work_, result_};
  RestJudge judge_{scene_, work_, state_};
};

StagedRun::StagedRun(Scene& scene, const std::vector<StagePlan>& plans, State& state, Observer& observer,
                     const Workers& workers, const Standing* from) {
  TALUS_ASSERT(plans.size() <= scene.model.stages.size());
  runner_ = std::make_unique<Runner>(scene, plans, state, observer, workers);
  runner_->begin(from);
}

StagedRun::~StagedRun() = default;
bool StagedRun::advance(const Pause& pause) { return runner_->go(pause); }
void StagedRun::stop() { runner_->stop(); }
bool StagedRun::over() const { return runner_->over(); }
Standing StagedRun::standing() const { return runner_->standing(); }
const RunResult& StagedRun::result() const { return runner_->result(); }

RunResult run_stages(Scene& scene, const std::vector<StagePlan>& plans, State& state, Observer& observer,
                     const Workers& workers) {
  StagedRun run(scene, plans, state, observer, workers);
  run.advance({});
  return run.result();
}

RunResult continue_stages(Scene& scene, const std::vector<StagePlan>& plans, const Standing& from,
                          State& state, Observer& observer, const Workers& workers) {
  StagedRun run(scene, plans, state, observer, workers, &from);
  run.advance({});
  return run.result();
}

int threads_for(int blocks) {
  // below this many blocks to a thread the handing over of work costs as much as it gains
  constexpr int kBlocksPerThread = 2000;
  return std::clamp(blocks / kBlocksPerThread, 1, processors());
}

std::string profile_text(const Profile& p, int threads) {
  const double all = p.total(), steps = static_cast<double>(std::max<int64_t>(p.steps, 1));
  const auto share = [all](double s) { return all > 0 ? 100 * s / all : 0.0; };
  std::string text =
      fmt::format("profile ({} thread{}, {} steps)\n", threads, threads == 1 ? "" : "s", p.steps);
  for (size_t i = 0; i < Profile::kParts; ++i)
    text += fmt::format("  {:<10} {:10.3f} s {:6.1f} % {:10.4f} ms a step\n", Profile::kName[i], p.seconds[i],
                        share(p.seconds[i]), 1e3 * p.seconds[i] / steps);
  text += fmt::format("  {:<10} {:10.3f} s of {:.3f} s wall\n", "all", all, p.wall);
  if (threads > 1)
    text += fmt::format("  {:<10} {:10.3f} s {:6.1f} %, by one thread while the others stand by\n", "serial",
                        all - p.shared, share(all - p.shared));
  return text +
         fmt::format(
             "  a step: {:.1f} points, {:.2f} sweeps, {:.2f} asks, {:.2f} pairs sought, {:.3f} layouts\n",
             static_cast<double>(p.points) / steps, static_cast<double>(p.sweeps) / steps,
             static_cast<double>(p.asks) / steps, static_cast<double>(p.sought) / steps,
             static_cast<double>(p.layouts) / steps);
}

}  // namespace talus
