#pragma once
// Stages along a path: histories that go on from balance to balance. Theory: docs/theory.md 14.7.

#include <vector>

#include "talus/step/scene.h"

namespace talus {

/// Where the histories stand at the balances of a stage along a path, rising [s]: at its beginning, at the ends of its
/// increments, and where a history that something follows in it turns. Empty: the stage has no path.
std::vector<double> path_goals(const Scene& scene, int stage);

/// Whether a support, a load or a driven block that acts in the stage follows a history.
bool follows_history(const Scene& scene, int stage);

/// The farthest that the model prescribes of a place while its histories go on from one time to another [m].
double prescribed_way(const Scene& scene, double from, double to);

}  // namespace talus
