#pragma once
// The paper's smoothing of contact rows, as numbers. Theory: docs/theory.md section 5.

namespace talus {

/// The paper's smoothing of contact rows (its eqs 26, 27, units corrected): normal law
/// min(a, b) - eps log1p(exp(-|a - b| / eps)) of a = e / Wii and b = p, friction p_t = -(2/pi) mu p_n
/// atan(u_t / width).
/// As printed, the normal law takes the smaller of a gap in metres and a force in newtons, and epsilon_1 is a bare
/// number: min(e dt, p/dt_kick).
struct Smoothing {
  bool on = false;
  bool printed = false;
  double impulse = 0;   // epsilon_1 over the kick [N s]
  double velocity = 0;  // epsilon_2 per step [m/s]
  double dt = 0, dt_kick = 0;
};

}  // namespace talus
