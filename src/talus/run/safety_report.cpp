// What `talus safety` tells of its trials: a table, safety.csv and safety.json.

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "talus/base/index.h"
#include "talus/base/version.h"
#include "talus/output/text_table.h"
#include "talus/run/safety.h"

namespace talus {

std::string safety_line(const SafetyTrial& t) {
  return fmt::format("  {:>9.5f}  {:<6}  {:<18}  {:>9.4g}  {:>8}  {:>10.3e}  {:>10.3e}  {}\n", t.factor,
                     t.stands ? "stands" : "fails", t.outcome, t.time, t.steps, t.unbalanced, t.displacement,
                     t.block);
}

namespace {

// Whether the trial that failed first did so by want of rest, though hardly more moved in it than in the one that stands:
// then it may be the way to rest that failed, and not what is built.
const SafetyTrial* doubtful(const SafetyResult& r) {
  constexpr double kHardlyMore = 10;
  const auto at = [&r](double factor, bool stands) -> const SafetyTrial* {
    for (const SafetyTrial& t : r.trials)
      if (t.factor == factor && t.stands == stands) return &t;
    return nullptr;
  };
  // ways are counted from before anything was raised
  const auto way = [&at](const SafetyTrial& t) {
    const SafetyTrial* before = t.from > 0 ? at(t.from, true) : nullptr;
    return t.displacement - (before && before->from > 0 ? before->displacement : 0);
  };
  const SafetyTrial *failed = at(r.fails, false), *stood = at(r.stands, true);
  if (r.fails <= 0 || !failed || failed->outcome != "no rest") return nullptr;
  if (stood && way(*failed) > kHardlyMore * way(*stood)) return nullptr;
  return failed;
}

}  // namespace

namespace {

// What holds and loads the model in the stage in which the question is asked: names.
nlohmann::ordered_json what_acts(const Model& model) {
  const int stage = safety_stages(model) - 1;
  nlohmann::ordered_json out = {{"stage", model.stages[stage].name}};
  const auto list = [&](const char* kind, const auto& items) {
    nlohmann::ordered_json names = nlohmann::ordered_json::array();
    for (const auto& item : items)
      if (item.acts_in(stage)) names.push_back(item.name);
    out[kind] = names;
  };
  list("supports", model.supports), list("boundaries", model.boundaries), list("loads", model.loads);
  out["bolts"] = nlohmann::ordered_json::array();
  for (const BoltInput& bolt : model.bolts)
    if (bolt.stage <= stage) out["bolts"].push_back(bolt.name);
  return out;
}

}  // namespace

std::string safety_text(const Model& model, const SafetyResult& r) {
  const char* what = name_of(model.safety.by);
  int loose = 0;
  for (const SafetyTrial& t : r.trials) loose += t.outcome == "needles move";
  std::string out;
  if (r.status == SafetyStatus::kBelow && r.stands > 0)
    out = fmt::format(
        "{}: between {:g} and {:g}, and sought no further below safety.lowest; give a smaller one\n", what,
        r.stands, r.fails);
  else if (r.status == SafetyStatus::kBelow)
    out = fmt::format("{}: below {:g}, the lowest tried; give a smaller safety.lowest\n", what, r.fails);
  else if (r.status == SafetyStatus::kAbove)
    out = fmt::format("{}: above {:g}, the highest tried; give a larger safety.highest\n", what, r.stands);
  else
    out = fmt::format("{}: {:.4f} (stands at {:.5f}, fails at {:.5f}; {} trials)\n", what, r.factor(),
                      r.stands, r.fails, r.trials.size());
  if (r.coarse > 0)
    out += std::abs(r.coarse - r.factor()) <= model.safety.tolerance
               ? "by rungs twice as long the same within the tolerance\n"
               : fmt::format(
                     "by rungs twice as long {:.4f}: what slips on the way makes a difference of {:.2g} %\n",
                     r.coarse, 100 * std::abs(r.coarse / r.factor() - 1));
  if (const SafetyTrial* t = doubtful(r))
    out += fmt::format(
        "DOUBTFUL: the trial at {:g} failed because it did not come to rest; \"{}\" had moved by {:.3g} m, hardly more than where it stands. "
        "The answer may be too low: compare with a shorter stage.time_step, integration = \"implicit\", and joints without stiffness\n",
        t->factor, t->block, t->displacement);
  if (loose > 0)
    out += fmt::format(
        "in {} trials needles moved that do not vote (docs/theory.md 14.8): if they matter, give "
        "safety.displacement_limit\n",
        loose);
  return out;
}

std::string safety_csv(const SafetyResult& r) {
  std::string out =
      "factor,stands,outcome,stage,time [s],steps,unbalanced,displacement [m],block,energy_closure,from\n";
  for (const SafetyTrial& t : r.trials)
    out += fmt::format("{:.17g},{},{},{},{:.17g},{},{:.17g},{:.17g},{},{:.17g},{:.17g}\n", t.factor,
                       t.stands ? 1 : 0, table_cell(t.outcome), table_cell(t.stage), t.time, t.steps,
                       t.unbalanced, t.displacement, table_cell(t.block), t.closure, t.from);
  return out;
}

std::string safety_json(const Model& model, const SafetyResult& r) {
  using nlohmann::ordered_json;
  constexpr const char* kBy[] = {"strength", "load", "tilt", "acceleration"};
  constexpr const char* kStatus[] = {"found", "below", "above"};
  ordered_json j = {{"program", fmt::format("talus {}", kVersion)},
                    {"model_file", std::filesystem::path(model.file).filename().string()},
                    {"model_hash", model.hash},
                    {"title", model.title},
                    {"answer", safety_text(model, r)},
                    {"acts", what_acts(model)},
                    {"by", kBy[place_of(model.safety.by)]},
                    {"status", kStatus[place_of(r.status)]}};
  if (r.status == SafetyStatus::kFound)
    j[model.safety.by == SafetyBy::kStrength ? "factor_of_safety" : name_of(model.safety.by)] = r.factor();
  if (r.stands > 0) j["stands_at"] = r.stands;
  if (r.status != SafetyStatus::kAbove) j["fails_at"] = r.fails;
  if (r.coarse > 0) j["factor_by_longer_rungs"] = r.coarse;
  j["tolerance"] = model.safety.tolerance;
  ordered_json names = ordered_json::array();
  for (const int i : model.safety.joints) names.push_back(model.joints[i].name);
  j["joints"] = model.safety.joints.empty() ? ordered_json("all") : names;
  j["trials"] = ordered_json::array();
  for (const SafetyTrial& t : r.trials)
    j["trials"].push_back({{"factor", t.factor},
                           {"stands", t.stands},
                           {"outcome", t.outcome},
                           {"stage", t.stage},
                           {"time [s]", t.time},
                           {"steps", t.steps},
                           {"unbalanced", t.unbalanced},
                           {"displacement [m]", t.displacement},
                           {"block", t.block},
                           {"energy_closure", t.closure},
                           {"from", t.from}});
  return j.dump(2) + "\n";
}

}  // namespace talus
