#include "talus/run/safety.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <future>
#include <limits>
#include <thread>

#include "talus/base/angle.h"
#include "talus/base/error.h"
#include "talus/base/index.h"
#include "talus/base/parallel.h"
#include "talus/model/joint_law.h"
#include "talus/run/safety_watch.h"
#include "talus/step/change.h"

namespace talus {

namespace {

// The rung of the ladder after a factor: 1, 1.1, 1.2 ... 2, 2.2 ... 4, 4.4 ..., and so on below 1; `by`: how many
// rungs on. A tenth of what a factor is at most, whatever the bracket: friction goes by the path.
constexpr int kRungs = 10;
double rung_after(double factor, int by) {
  const double octave = std::exp2(std::floor(std::log2(factor * (1 + 1e-9))));
  const double next = std::rint(kRungs * factor / octave) + by;
  return next < 2 * kRungs ? octave * next / kRungs
                           : octave * 2 * (kRungs + std::floor((next - 2 * kRungs) / 2)) / kRungs;
}

// The first rung of what is raised from nothing: far below what anybody asks about, and doubled until something fails. A
// power of two, so that the rungs above are the same from wherever one begins: a matter of speed.
double first_rung(SafetyBy by) {
  constexpr double kFirst[] = {1, 1. / 16, 1, 1. / 64};  // factor, factor, degrees, share of gravity
  return kFirst[place_of(by)];
}

int leading_static_stages(const Model& model) {
  int n = 0;
  while (n < count_of(model.stages) && model.stages[n].kind == StageKind::kStatic) ++n;
  return n;
}

bool is_weakened(const SafetyInput& safety, int joint) {
  return safety.joints.empty() ||
         std::find(safety.joints.begin(), safety.joints.end(), joint) != safety.joints.end();
}

// Divides strength. Faces stay: strength divided by a factor is still strength.
/// @param full  the joints before that
void weaken(Scene& scene, const std::vector<JointProperty>& full, double factor) {
  for (int i = 0; i < count_of(full); ++i)
    if (is_weakened(scene.model.safety, i)) scene.model.joints[i] = reduced(full[i], factor);
  scene.laws = joint_laws(scene.model.joints);
}

// Joints with the strength that they have at the end of the stages.
std::vector<JointProperty> joints_after(const Model& model, int stages) {
  std::vector<JointProperty> out = model.joints;
  for (int stage = 0; stage < stages; ++stage)
    for (const ChangeInput& c : model.changes)
      if (c.joint >= 0 && c.stage == stage) {
        JointProperty& joint = out[c.joint];
        joint = changed(joint, c);
      }
  return out;
}

// The scene of a trial that runs the stages.
Scene weakened(const PreparedRun& prepared, double factor) {
  Scene scene = prepared.scene;
  scene.model.stages.resize(safety_stages(scene.model));
  weaken(scene, prepared.scene.model.joints, factor);
  for (ChangeInput& c : scene.model.changes) {  // what a stage gives is divided, too
    if (c.joint < 0 || !is_weakened(scene.model.safety, c.joint)) continue;
    c.friction_angle = std::atan(std::tan(c.friction_angle) / factor);
    c.cohesion /= factor, c.tensile_strength /= factor;
  }
  // a wedge is a failure, however small
  for (StageInput& stage : scene.model.stages) stage.strict_rest = true;
  return scene;
}

// From where trials start: the model as it stands under the largest action it is known to bear.
struct Base {
  Scene scene;
  std::vector<StagePlan> plans;
  Standing standing;
  State state;
  std::vector<Vec2> since;  // displacements from which ways are counted; empty: those of each trial's start
  double factor = 0;        // under which it stands; 0: nothing raised
};

// The stage of trials: like the last one as it was prepared (motion that follows changes that of a scene), with what acts
// there.
void add_raised(Base& base, const PreparedRun& prepared) {
  Model& model = base.scene.model;
  const int last = count_of(model.stages) - 1;
  StageInput raised = prepared.scene.model.stages[last];
  raised.name += ", raised";
  raised.excavate.clear(), raised.relaxation.clear();
  raised.path = 0, raised.increments = 0;  // histories stand where they are
  raised.reset_displacements = true;
  // what acts in the last of them, and nothing that comes later
  const auto also = [last](auto& list) {
    for (auto& item : list)
      if (!item.stages.empty())
        item.stages = item.acts_in(last) ? std::vector{last, last + 1} : std::vector{-1};
  };
  also(model.supports), also(model.boundaries), also(model.loads);
  for (BoltInput& bolt : model.bolts)
    if (bolt.stage > last) bolt.stage = std::numeric_limits<int>::max();
  // those of joints have been made, and are not made again where a run goes on
  std::erase_if(model.changes, [last](const ChangeInput& c) { return c.stage > last || c.joint >= 0; });
  model.stages.push_back(raised);
  base.plans.push_back(prepared.plans[last]);
  base.plans.back().balances = 0;
  base.standing.between = true;
}

// Searches by trials of one kind.
class Search {
 public:
  Search(const PreparedRun& prepared, const Workers& workers, const SafetySettings& settings)
      : prepared_(prepared),
        workers_(workers),
        settings_(settings),
        input_(prepared.scene.model.safety),
        full_(joints_after(prepared.scene.model, safety_stages(prepared.scene.model))) {
    if (input_.by != SafetyBy::kStrength) settle();
  }

  // From a state that stands under this.
  Search(const PreparedRun& prepared, const Workers& workers, const SafetySettings& settings,
         std::shared_ptr<const Base> stood, double stands)
      : prepared_(prepared),
        workers_(workers),
        settings_(settings),
        input_(prepared.scene.model.safety),
        full_(joints_after(prepared.scene.model, safety_stages(prepared.scene.model))),
        base_(stood),
        before_(stood) {
    result_.stands = stands;
  }

  SafetyResult run() {
    if (input_.from_start) {
      if (!round({input_.lowest})) return ended(SafetyStatus::kBelow);
      if (round({input_.highest}); result_.fails == 0) return ended(SafetyStatus::kAbove);
      close_in();
      return ended(SafetyStatus::kFound);
    }
    if (input_.by == SafetyBy::kStrength && !stand()) return ended(SafetyStatus::kBelow);
    const std::shared_ptr<const Base> stood = base_;
    const double begun = result_.stands;
    // the same by longer strides, beside it where a processor has nothing to do; its trials are not told
    SafetySettings quiet;
    quiet.jobs = settings_.jobs;
    // never where states are read: that is done in a copy of this process, which may have no other thread
    const bool beside =
        settings_.known.empty() && processors() > std::max(workers_.threads(), settings_.jobs);
    const Workers alone(1);
    Search coarse(prepared_, beside ? alone : workers_, quiet, stood, begun);
    const auto by_longer = [&coarse] {
      return coarse.climb(2) == SafetyStatus::kFound ? coarse.result_.factor() : 0.0;
    };
    const auto when = beside ? std::launch::async | std::launch::deferred : std::launch::deferred;
    std::future<double> longer = std::async(when, by_longer);
    const struct GivesUp {
      std::atomic<bool>& flag;
      ~GivesUp() { flag = true; }  // before the future waits for it
    } gives_up{coarse.given_up_};
    const SafetyStatus status = climb(1);
    if (status == SafetyStatus::kFound) result_.coarse = longer.get();
    return ended(status);
  }

 private:
  struct Tried {
    SafetyTrial trial;
    std::unique_ptr<Base> after;  // of one that stands, where trials go on from there
  };

  // A state that stands: with the strength given, or with twice that, and so on.
  bool stand() {
    for (double factor = 1;; factor /= 2) {
      if (round({factor})) {
        result_.fails = 0;  // with less it failed as it was built; it is tried again from here
        return true;
      }
      if (factor <= input_.lowest) return false;
    }
  }

  // From what stands rung by rung to the first that fails, and by halving between the two. What is raised from nothing is
  // doubled before, until something fails: no more is taken from that than from where rungs begin.
  SafetyStatus climb(int rungs) {
    if (input_.by != SafetyBy::kStrength) {
      const double first = first_rung(input_.by), stride = std::exp2(rungs);
      while (result_.fails == 0 && result_.stands < input_.highest)
        round({std::min(result_.stands > 0 ? stride * result_.stands : first, input_.highest)});
      if (result_.stands > 0) result_.fails = 0;
    }
    while (result_.fails == 0) {
      if (result_.stands >= input_.highest) return SafetyStatus::kAbove;
      round({std::min(rung_after(result_.stands, rungs), input_.highest)});
    }
    if (result_.fails <= input_.lowest) return SafetyStatus::kBelow;
    close_in();
    return SafetyStatus::kFound;
  }

  void close_in() {
    while (result_.fails - result_.stands > input_.tolerance) {
      std::vector<double> factors;
      for (int k = 1; k <= settings_.jobs; ++k)
        factors.push_back(settings_.jobs == 1
                              ? result_.factor()
                              : result_.stands + k * (result_.fails - result_.stands) / (settings_.jobs + 1));
      round(factors);
    }
  }

  SafetyResult ended(SafetyStatus status) {
    result_.status = status;
    if (settings_.keeper)
      for (const auto& [factor, from] :
           {std::pair(result_.stands, before_), std::pair(result_.fails, failed_from_)})
        if (factor > 0) keep(factor, from);
    return result_;
  }

  // Tries factors, rising, side by side, and takes over what they say; whether the first stands.
  bool round(const std::vector<double>& factors) {
    const std::shared_ptr<const Base> from = base_;
    std::vector<std::optional<Tried>> tried(factors.size());
    for (size_t k = 0; k < factors.size(); ++k) tried[k] = as_known(factors[k]);
    std::vector<std::exception_ptr> wrong(factors.size());
    const auto one = [&](size_t k, const Workers& workers) {
      try {
        if (!tried[k]) tried[k] = attempt(factors[k], workers);
      } catch (...) {
        wrong[k] = std::current_exception();
      }
    };
    if (factors.size() == 1) {
      one(0, workers_);
    } else {
      std::vector<std::thread> threads;
      for (size_t k = 0; k < factors.size(); ++k) threads.emplace_back([&one, k] { one(k, Workers(1)); });
      for (std::thread& t : threads) t.join();
    }
    bool all_stand = true;
    for (size_t k = 0; k < factors.size(); ++k) {
      if (wrong[k]) std::rethrow_exception(wrong[k]);
      const SafetyTrial& trial = tried[k]->trial;
      std::unique_ptr<Base>& after = tried[k]->after;
      result_.trials.push_back(trial);
      if (after) save(trial, *after);
      if (settings_.told) settings_.told(trial);
      // of several that were tried at once the first that fails ends it: what lies above is not asked
      if (trial.stands && all_stand) {
        result_.stands = factors[k];
        if (after) before_ = from, base_ = std::move(after);
      } else if (!trial.stands && all_stand) {
        result_.fails = factors[k];
        failed_from_ = from;
        all_stand = false;
      }
    }
    return tried[0]->trial.stands;
  }

  // The stages without the action, once.
  void settle() {
    auto base = std::make_shared<Base>(Base{prepared_.scene, {}, {}, {}, {}});
    Model& model = base->scene.model;
    const int stages = safety_stages(model);
    model.stages.resize(stages);
    base->plans.assign(prepared_.plans.begin(), prepared_.plans.begin() + stages);
    if (input_.by == SafetyBy::kLoad) model.loads[input_.load].factor = 0;
    SafetyTrial settled;
    settled.factor = 0;
    if (!take_saved_stages(settled, *base)) {
      base->state = start_state(base->scene);
      struct Nobody : Observer {
        void at(const Instant&) override {}
      } nobody;
      base->standing.result = run_stages(base->scene, base->plans, base->state, nobody, workers_);
      if (!base->standing.result.failure.empty())
        throw NumericalError("the model does not come to rest before anything is raised: " +
                             base->standing.result.failure);
    }
    save(settled, *base);
    count_from_here(*base, 0);
    base_ = before_ = std::move(base);
  }

  // What has come to rest is where trials begin.
  void count_from_here(Base& base, double factor) const {
    add_raised(base, prepared_);
    base.since = base.state.displacement;
    base.factor = factor;
  }

  void save(const SafetyTrial& trial, const Base& after) const {
    if (settings_.save) settings_.save(trial, run_archive(after.scene, after.standing, after.state));
  }

  // The end of a trial as a search that was broken off has saved it; whether it has, and it can be used.
  bool take_saved(const SafetyTrial& trial, Base& base) const {
    const PreparedRun of{base.scene, base.plans};
    try {
      std::optional<Archive> archive = settings_.saved ? settings_.saved(trial) : std::nullopt;
      if (!archive) return false;
      SavedRun run = saved_run_of(fmt::format("trial at {:g}", trial.factor), std::move(*archive), of);
      base.scene.give.shortest_step = run.archive.numbers.at(kSavedGive).at(1);
      base.state = std::move(run.state);
      base.standing = {run.standing.result, true};
    } catch (const FileError&) {  // the trial is run again
      return false;
    }
    return true;
  }

  // The same of the end of the stages, whose scene is that of their end.
  bool take_saved_stages(const SafetyTrial& trial, Base& base) const {
    if (!take_saved(trial, base)) return false;
    for (int i = 0; i < count_of(base.scene.model.stages); ++i) change_scene(i, base.scene);
    return true;
  }

  // Puts the action into a scene whose blocks stand as `state` says. The ledger goes on: what turns is no work.
  void raise(Scene& scene, State& state, double factor) const {
    Model& model = scene.model;
    if (input_.by == SafetyBy::kStrength) return weaken(scene, full_, factor);
    if (input_.by == SafetyBy::kLoad) {
      model.loads[input_.load].factor = factor;
      return;
    }
    const Vec2 was = model.gravity, down = prepared_.scene.model.gravity, aside = turn_left(down);
    if (input_.by == SafetyBy::kAcceleration) {
      model.gravity = down + factor * aside;
    } else {
      const double angle = factor * kDegree;
      model.gravity = std::cos(angle) * down + std::sin(angle) * aside;
    }
    for (size_t k = 0; k < state.displacement.size(); ++k)
      state.energy_start -= scene.blocks.mass[k] * dot(model.gravity - was, state.displacement[k]);
  }

  // What a search that was broken off has told of it; nothing where it has to be run.
  std::optional<Tried> as_known(double factor) const {
    const bool needs_no_state = input_.by == SafetyBy::kStrength && input_.from_start;
    for (const SafetyTrial& k : settings_.known) {
      if (k.factor != factor || k.from != (base_ ? base_->factor : 0)) continue;
      if (!k.stands || needs_no_state) return Tried{k, nullptr};
      auto after = std::make_unique<Base>(base_ ? *base_ : beginning(factor));
      if (base_) raise(after->scene, after->state, factor);
      if (!(base_ ? take_saved(k, *after) : take_saved_stages(k, *after))) break;
      if (base_)
        after->factor = factor;
      else
        count_from_here(*after, factor);
      return Tried{k, std::move(after)};
    }
    return std::nullopt;
  }

  Tried attempt(double factor, const Workers& workers) const {
    return base_ ? of_action(factor, *base_, workers, nullptr) : of_start(factor, workers, nullptr);
  }

  // The same trial again, shown to a keeper.
  void keep(double factor, const std::shared_ptr<const Base>& from) const {
    SafetyTrial told;
    for (const SafetyTrial& t : result_.trials)
      if (t.factor == factor && t.from == (from ? from->factor : 0)) told = t;
    if (from)
      of_action(factor, *from, workers_, &told);
    else
      of_start(factor, workers_, &told);
  }

  // The stages with this strength, before they are run.
  Base beginning(double factor) const {
    Base base{weakened(prepared_, factor), {}, {}, {}, {}};
    base.plans.assign(prepared_.plans.begin(), prepared_.plans.begin() + base.scene.model.stages.size());
    base.state = start_state(base.scene);
    return base;
  }

  Tried of_start(double factor, const Workers& workers, const SafetyTrial* kept) const {
    auto after = std::make_unique<Base>(beginning(factor));
    Tried tried = judged(factor, 0, *after, kept, [&](Observer& observer) {
      after->standing.result = run_stages(after->scene, after->plans, after->state, observer, workers);
      return after->standing.result;
    });
    if (!tried.trial.stands || input_.from_start) return tried;
    count_from_here(*after, factor);
    tried.after = std::move(after);
    return tried;
  }

  Tried of_action(double factor, const Base& from, const Workers& workers, const SafetyTrial* kept) const {
    auto after = std::make_unique<Base>(from);
    const StageInput stage = after->scene.model.stages.back();
    // another go of the stage in which the trial before has come to rest, whatever did not there
    Standing begin = after->standing;
    if (begin.result.stages.size() == after->scene.model.stages.size()) begin.result.stages.pop_back();
    begin.result.failure.clear(), begin.result.no_rest = false;
    raise(after->scene, after->state, factor);
    Tried tried = judged(factor, from.factor, *after, kept, [&](Observer& observer) {
      after->standing.result =
          continue_stages(after->scene, after->plans, begin, after->state, observer, workers);
      return after->standing.result;
    });
    if (!tried.trial.stands) return tried;
    after->scene.model.stages.back() = stage;
    after->factor = factor;
    tried.after = std::move(after);
    return tried;
  }

  template <class Run>
  Tried judged(double factor, double from, const Base& base, const SafetyTrial* kept, Run go) const {
    const Scene& scene = base.scene;
    const State& state = base.state;
    const Electorate electorate(scene);
    const std::unique_ptr<Observer> keeper = kept ? settings_.keeper(scene, *kept) : nullptr;
    Watch watch(scene, electorate, base.since, keeper.get(), given_up_);
    const RunResult run = go(watch);
    if (keeper && settings_.kept) settings_.kept(*keeper, run);
    const StageResult& last = run.stages.back();
    SafetyTrial trial;
    trial.factor = factor, trial.from = from;
    trial.stage = last.name;
    trial.time = state.time;
    trial.steps = state.step;
    trial.displacement = watch.farthest();
    trial.block = scene.blocks.name[watch.block()];
    trial.unbalanced = last.unbalanced;
    trial.closure = run.closure();
    if (watch.failed()) {
      trial.outcome = "displacement limit";
    } else if (run.mechanism) {
      trial.outcome = "mechanism";
    } else if (run.failure.empty() && !run.interrupted) {
      trial.outcome = "at rest", trial.stands = true;
    } else if (!run.no_rest) {
      throw NumericalError(
          fmt::format("trial at {} {:g} says nothing of safety: {}", name_of(input_.by), factor,
                      run.interrupted ? "it was stopped before it came to rest or failed" : run.failure));
    } else {
      trial.stands = watch.only_needles_move(scene.model.stages.back().unbalanced);
      trial.outcome = trial.stands ? "needles move" : "no rest";
    }
    return {trial, nullptr};
  }

  const PreparedRun& prepared_;
  const Workers& workers_;
  const SafetySettings& settings_;
  const SafetyInput& input_;
  const std::vector<JointProperty> full_;  // strength at the end of the stages, not divided
  SafetyResult result_;
  std::atomic<bool> given_up_ = false;  // nobody asks for it any more
  std::shared_ptr<const Base> base_, before_,
      failed_from_;  // now; of the last trial that stands, and that fails
};

}  // namespace

int safety_stages(const Model& model) {
  return model.safety.at < 0 ? leading_static_stages(model) : model.safety.at + 1;
}

void check_safety(const PreparedRun& prepared) {
  const Model& model = prepared.scene.model;
  if (leading_static_stages(model) == 0) {
    Findings findings(model.file, model.text);
    findings.error(model.stages.empty() ? model.safety.where : model.stages[0].where, "stage",
                   "the first stage is not static: there is no rest by which a trial could be judged",
                   "begin with a stage of kind = \"static\"");
    findings.throw_if_errors();
  }
  const Layout& cut = prepared.scene.layout;
  if (cut.slivers_merged + cut.slivers_deleted > 0 && !model.safety.accept_merged) {
    Findings findings(model.file, model.text);
    findings.error(model.cut.where_slivers, "cut.slivers",
                   fmt::format("{} slivers are merged and {} deleted: the block that fails may be among them",
                               cut.slivers_merged, cut.slivers_deleted),
                   "use slivers = \"keep\", with elasticity = \"implicit\" if the step is too short; or, if "
                   "you know that they do not matter, safety.accept_merged = true");
    findings.throw_if_errors();
  }
}

SafetyResult seek_safety(const PreparedRun& prepared, const Workers& workers,
                         const SafetySettings& settings) {
  check_safety(prepared);
  return Search(prepared, workers, settings).run();
}

const char* name_of(SafetyBy by) {
  constexpr const char* kName[] = {"factor of safety", "load factor", "tilt [deg]", "acceleration [g]"};
  return kName[place_of(by)];
}

}  // namespace talus
