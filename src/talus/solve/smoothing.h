#pragma once
// The paper's smoothing of contact rows, as numbers. Theory: docs/theory.md section 5.

namespace talus {

/// The paper's smoothing of contact rows (its eqs 26, 27, units corrected): normal law
/// min(a, b) - eps log1p(exp(-|a - b| / eps)) of a = e / Wii and b = p, friction p_t = -(2/pi) mu p_n
/// atan(u_t / width).
struct Smoothing {
  bool on = false;
  double impulse = 0;   // epsilon_1 over the kick [N s]
  double velocity = 0;  // epsilon_2 per step [m/s]
};

}  // namespace talus
