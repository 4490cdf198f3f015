#pragma once
// What a compliant base is asked for and what level ground on it would answer: the check against the usual
// mistakes of a factor of two. Theory: docs/theory.md 4.15.

#include <string>
#include <vector>

#include "talus/step/scene.h"

namespace talus {

/// A level layer for waves that go straight up, of one kind.
struct WaveLayer {
  double height = 0, density = 0, modulus = 0;  // [m], [kg/m3], [Pa]
};

/// Motion of layers over a half-space per motion of the bare half-space (its outcrop), as amplitudes.
struct LayerResponse {
  double surface = 0, base = 0;
};

/// @param layers     upwards
/// @param impedance  rho c of the half-space [Pa s/m]
/// @param frequency  [Hz]
LayerResponse level_response(const std::vector<WaveLayer>& layers, double impedance, double frequency);

/// Frequency [Hz] of the largest Fourier amplitude of a history; 0 when it does not move.
double dominant_frequency(const History& history);

/// Lines for the user, one for each motion of each compliant base; "" without any.
std::string base_report(const Scene& scene);

}  // namespace talus
