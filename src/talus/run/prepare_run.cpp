// From a model file to what is run, and to where.

#include <algorithm>

#include "talus/base/error.h"
#include "talus/cut/check_places.h"
#include "talus/model/read_model.h"
#include "talus/run/check_monitors.h"
#include "talus/run/plausible.h"
#include "talus/run/resolution.h"
#include "talus/run/run.h"

namespace talus {

PreparedRun prepare_run(const std::string& file, const std::string& text,
                        const std::vector<std::string>& overrides, Findings& findings, Cut* keep) {
  PreparedRun run;
  Model model = read_model(file, text, overrides, findings);
  if (!model.shapes_readable) findings.throw_if_errors();
  if (model.stages.empty())
    findings.error({1, 1, ""}, "stage", "the file has no [[stage]]: nothing would be run",
                   "add [[stage]] with name, kind = \"dynamic\" and duration");
  const int errors = findings.error_count();
  Cut cut = cut_or_read(model, findings);
  if (findings.error_count() > errors)
    findings.throw_if_errors();  // without blocks all else would look wrong
  Layout layout = checked_layout(model, cut, findings);
  check_monitors(model, layout, findings);
  if (keep) *keep = std::move(cut);
  findings.throw_if_errors();
  run.scene = build_scene(std::move(model), std::move(layout), findings);
  findings.throw_if_errors();
  choose_elasticity(run.scene);
  run.plans = plan_stages(run.scene, findings);
  check_resolution(run.scene, findings);
  check_plausible(run.scene, run.plans, findings);
  findings.throw_if_errors();
  return run;
}

size_t stages_until(const Model& model, const std::string& name) {
  const auto of_name = [&name](const StageInput& stage) { return stage.name == name; };
  const auto at = std::find_if(model.stages.begin(), model.stages.end(), of_name);
  return at == model.stages.end() ? 0 : at - model.stages.begin() + 1;
}

void end_after(PreparedRun& prepared, size_t stages) {
  TALUS_ASSERT(stages > 0 && stages <= prepared.plans.size());
  // hard contacts give by the shortest step of the whole
  ContactGive& give = prepared.scene.give;
  for (const StagePlan& plan : prepared.plans)
    give.shortest_step = give.shortest_step > 0 ? std::min(give.shortest_step, plan.dt) : plan.dt;
  prepared.plans.resize(stages);
}

}  // namespace talus
