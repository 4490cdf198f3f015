#include "talus/results/prediction.h"

#include <algorithm>

#include "talus/base/error.h"
#include "talus/base/index.h"
#include "talus/corners/follow.h"
#include "talus/output/paraview_view.h"
#include "talus/results/histories.h"
#include "talus/results/step_table.h"

namespace talus {

namespace {

// Measured sizes of one cell or item in result files [bytes], from runs of the examples.
constexpr double kCsvCell = 23, kVtkCorner = 102, kVtkBlock = 185, kVtkContact = 229, kVtkFile = 2600,
                 kJointRow = 200, kPictureFile = 51e3;
// Of the state at the end of a stage, and of each block in it: 0.44 MB of 185 blocks, 1.46 MB of 1,000 [bytes].
constexpr double kSavedFile = 220e3, kSavedBlock = 1200;

int64_t rows_of(double duration, int64_t steps, double interval) {
  if (interval <= 0) return steps;
  return static_cast<int64_t>(std::min(static_cast<double>(steps), duration / interval));
}

}  // namespace

Prediction predict(const Scene& scene, const std::vector<StagePlan>& plans) {
  TALUS_ASSERT(plans.size() == scene.model.stages.size());
  Prediction p;
  p.blocks = scene.blocks.count;
  p.bond_faces = count_of(scene.bonds.faces);
  p.supported = count_of(scene.supported);
  p.boundary = static_cast<int>(scene.boundaries.points.size() + scene.boundaries.ties.size());
  const State state = start_state(scene);
  p.contacts = count_of(find_contacts(scene.blocks, scene.bonds, state, 0.02 * smallest_size(scene.blocks)));

  const OutputInput& out = scene.model.output;
  p.frames = 1;
  for (size_t i = 0; i < plans.size(); ++i) {
    const double duration = scene.model.stages[i].duration;
    if (plans[i].balances > 0) {  // most are found in two steps
      p.history_rows += plans[i].balances, p.step_rows += 2 * plans[i].balances;
      p.frames += out.field_interval > 0 ? plans[i].balances : 1;
      continue;
    }
    p.history_rows += rows_of(duration, plans[i].steps, out.history_interval);
    p.step_rows += rows_of(duration, plans[i].steps, out.steps_interval);
    p.frames += std::max<int64_t>(
        1, out.field_interval > 0 ? rows_of(duration, plans[i].steps, out.field_interval) : 1);
  }
  ++p.history_rows, ++p.step_rows;

  const double corners = static_cast<double>(scene.blocks.arm.size());
  const double points = 2.0 * p.bond_faces + p.contacts + p.supported + p.boundary;
  const auto breakable = std::count_if(scene.bonds.faces.begin(), scene.bonds.faces.end(),
                                       [](const BondFace& f) { return !f.unbreakable; });
  const double joint_rows =
      (2.0 * static_cast<double>(breakable) + p.contacts) * static_cast<double>(plans.size());
  const double columns = static_cast<double>(Histories(scene, nullptr).columns().size());
  const double frame = kVtkCorner * corners + kVtkBlock * p.blocks + kVtkContact * points + 2 * kVtkFile;
  p.output =
      kCsvCell * (columns * static_cast<double>(p.history_rows) +
                  static_cast<double>(step_columns().size()) * static_cast<double>(p.step_rows)) +
      frame * static_cast<double>(p.frames) + kJointRow * joint_rows + 5000 +
      2 * (kPictureFile + 50 * corners + 60.0 * p.blocks) +
      static_cast<double>(plans.size()) * (kSavedFile + kSavedBlock * p.blocks) +
      static_cast<double>(paraview_view().size());  // tables, frames, summary, two pictures, states, the view
  // blocks, state, pairs; per point its row, memory and place in the sweeps; for Newton also about 16 x 2
  // entries of W, its factor and copies
  const auto hard = std::count_if(scene.bonds.faces.begin(), scene.bonds.faces.end(), [&](const BondFace& f) {
    return f.unbreakable || !scene.laws[f.joint].is_soft(0);
  });
  const bool factors = chosen_solver(scene.model, static_cast<size_t>(points),
                                     {.hard_ties = 2 * static_cast<size_t>(hard)}) == SolverKind::kNewton;
  // the factor of steps from rest: 10 kB a block at 5,000 of them, 13 at 50,000
  const bool from_rest = std::any_of(scene.model.stages.begin(), scene.model.stages.end(),
                                     [](const StageInput& s) { return s.from_rest; });
  p.memory = (from_rest ? 14600.0 : 1600.0) * p.blocks + 32 * corners +
             points * (600 + (factors ? 2 * 32 * 16 * 6 : 0));
  return p;
}

}  // namespace talus
