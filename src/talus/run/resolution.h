#pragma once
// Whether blocks are small enough for the waves that a run sends through them: blocks per wavelength of the
// highest frequency that matters. Theory: docs/theory.md 4.17.

#include <string>
#include <vector>

#include "talus/step/scene.h"

namespace talus {

/// Fewer blocks per wavelength than this are a warning: there waves of bonded blocks run 1.7 % too fast.
inline constexpr double kFewestPerWavelength = 10;

/// What a history prescribes or pushes.
enum class InputKind { kAcceleration, kVelocity, kDisplacement, kForce };

/// Frequency [Hz] below which record::kVelocityShare of the integral of |V(f)|^2 lies; V is the spectrum of
/// the velocity: of the history itself, its integral (acceleration) or its derivative (displacement). Forces
/// and pressures stand for the velocity they send out. 0 when nothing changes. A curve that does not begin
/// and end near zero is held at both ends, as in the run, and freed of the straight line between its ends:
/// its jump is no part of it.
double highest_frequency(const History& history, InputKind kind);

/// Largest acceleration that histories prescribe, of loads and of the motion of supports, driven blocks and boundaries [m/s2].
double largest_input(const Model& model);

/// Speed of the slowest plane wave through the ground, of any direction [m/s].
double slowest_wave(const Ground& ground);

/// Steps to the shortest period of a history: fewer make of it another one.
inline constexpr double kStepsPerPeriod = 10;

/// How one history's waves stand to the worst block.
struct Resolution {
  int history = -1;
  double frequency = 0;       // highest that matters [Hz]
  int block = -1;             // the one with the fewest to a wavelength
  double size = 0;            // of it: square root of its area [m]
  double speed = 0;           // slowest wave there, joints included [m/s]
  double per_wavelength = 0;  // blocks
  std::string left_out;       // joints whose stiffness has no one direction and spacing, "" without any
};

/// One for each history that shakes or pushes anything, in the order of the model; none when no block deforms
/// or no stage is dynamic.
std::vector<Resolution> resolutions(const Scene& scene);

/// A line for each.
std::string resolution_report(const Scene& scene);

/// Warns, at the history, of fewer than kFewestPerWavelength blocks.
void check_resolution(const Scene& scene, Findings& findings);

}  // namespace talus
