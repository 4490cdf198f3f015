#pragma once
// talus on the scenes of scenes.h: deformable blocks of 5 GPa on fixed ground, stepped one by one.

#include "measures.h"
#include "talus/talus.h"

namespace talus::bench {

struct EngineOptions {
  int threads = 1;
  int sweeps = 20;          // most to a step
  double tolerance = 1e-8;  // share of the smallest block; sweeps end earlier when it is reached
  bool implicit = true;     // block-implicit elasticity
  double stiffness = 0;     // kn = ks of all joints [Pa/m], 0: hard
  double damping_local = 0;
  bool rigid = false;
  SolverKind method = SolverKind::kGaussSeidel;
};

/// The scene as talus has it.
Scene talus_scene(const BenchScene& scene, const EngineOptions& options);

class TalusEngine : public BenchEngine {
 public:
  TalusEngine(const BenchScene& scene, const EngineOptions& options);

  std::string name() const override;
  int sweeps() const override { return scene_.model.solver.max_sweeps; }
  void set_gravity(Vec2 gravity) override { scene_.model.gravity = gravity; }
  void step(double dt) override;
  int contact_points() const override { return report_.contacts; }
  std::vector<BenchBlock> blocks() const override;
  std::vector<BenchContact> contacts() const override;

  StepSettings& settings() { return settings_; }
  Scene& scene() { return scene_; }
  const State& state() const { return state_; }
  State& state() { return state_; }
  StepWork& work() { return work_; }
  const StepReport& report() const { return report_; }
  double wall() const { return wall_; }  // of all steps [s]

 private:
  Scene scene_;
  State state_;
  StepSettings settings_;
  StepWork work_;
  StepReport report_;
  double wall_ = 0;
};

}  // namespace talus::bench
