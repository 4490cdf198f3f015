#pragma once
// What a run will take, known before its first step: counts, memory and output size.

#include "talus/run/plan.h"

namespace talus {

struct Prediction {
  int blocks = 0, bond_faces = 0, contacts = 0, supported = 0;
  int boundary = 0;   // points and ties
  double memory = 0;  // [bytes] of the run, without the program itself
  double output = 0;  // [bytes] of all result files
  int64_t frames = 0, history_rows = 0, step_rows = 0;
};

Prediction predict(const Scene& scene, const std::vector<StagePlan>& plans);

}  // namespace talus
