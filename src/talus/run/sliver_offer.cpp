#include "talus/run/sliver_offer.h"

#include <fmt/format.h>

#include "talus/base/index.h"
#include "talus/base/text.h"
#include "talus/cut/check_places.h"
#include "talus/run/check_monitors.h"
#include "talus/step/scene.h"

namespace talus {

namespace {

// Least gain in the step that is worth an offer.
constexpr double kWorthwhile = 1.1;

// The stage with the shortest step among those that hang on a block; -1: none does.
int shortest(const std::vector<StagePlan>& plans) {
  int least = -1;
  for (int i = 0; i < count_of(plans); ++i)
    if (plans[i].bound_block >= 0 && (least < 0 || plans[i].dt < plans[least].dt)) least = i;
  return least;
}

}  // namespace

std::vector<SliverOffer> sliver_offers(const PreparedRun& run, const Cut& cut) {
  const int stage = shortest(run.plans);
  if (cut.slivers.kept == 0 || cut.edge_line.empty() || stage < 0 ||
      run.scene.model.cut.slivers != SliverPolicy::kKeep)
    return {};
  std::vector<SliverOffer> offers;
  for (const bool everywhere : {false, true}) {
    Model model = run.scene.model;
    model.cut.slivers = SliverPolicy::kMerge;
    SliverOffer offer;
    if (everywhere)
      for (const JointSetInput& set : model.joint_sets) offer.along.push_back(set.name);
    model.cut.merge_along = offer.along;
    const Cut merged = with_slivers(model, cut);
    offer.merged = merged.slivers.merged;
    if (offer.merged == 0 || (!offers.empty() && offers[0].merged == offer.merged)) continue;
    Findings findings(model.file, model.text);
    Layout layout = checked_layout(model, merged, findings);
    check_monitors(model, layout, findings);
    if (findings.has_errors()) continue;  // a name that the model uses would be gone
    offer.stage = model.stages[stage].name;
    const Scene scene = build_scene(std::move(model), std::move(layout), findings);
    if (findings.has_errors()) continue;
    const std::vector<StagePlan> plans = plan_stages(scene, findings);
    offer.step = plans[stage].dt, offer.now = run.plans[stage].dt;
    const double least = offers.empty() ? offer.now : offers[0].step;
    if (offer.step > kWorthwhile * least) offers.push_back(offer);
  }
  return offers;
}

std::string sliver_offer_text(const std::vector<SliverOffer>& offers) {
  std::string out;
  for (const SliverOffer& o : offers) {
    const std::string names =
        o.along.empty() ? "" : fmt::format(", cut.merge_along = [\"{}\"]", fmt::join(o.along, "\", \""));
    out += fmt::format(
        "  slivers    merging {} blocks inside the rock (cut.slivers = \"merge\"{}) would allow {} for {} in "
        "\"{}\"{}\n",
        o.merged, names, readable_seconds(o.step), readable_seconds(o.now), o.stage,
        o.along.empty() ? "" : "; it interrupts joints that reach a free face");
  }
  if (!offers.empty())
    out += fmt::format("             or stage.{}.elasticity = \"implicit\": no block limits the step\n",
                       offers[0].stage);
  return out;
}

}  // namespace talus
