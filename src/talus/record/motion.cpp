#include "talus/record/motion.h"

#include "talus/base/error.h"

namespace talus::record {

// Eq. 11.1.
Motion integrate(std::vector<double> acceleration, double dt) {
  TALUS_ASSERT(dt > 0);
  Motion m{dt, std::move(acceleration), {}, {}};
  const std::vector<double>& a = m.acceleration;
  m.velocity.assign(a.size(), 0);
  m.displacement.assign(a.size(), 0);
  for (size_t i = 0; i + 1 < a.size(); ++i) {
    m.velocity[i + 1] = m.velocity[i] + 0.5 * dt * (a[i] + a[i + 1]);
    m.displacement[i + 1] = m.displacement[i] + dt * m.velocity[i] + dt * dt * (2 * a[i] + a[i + 1]) / 6;
  }
  return m;
}

std::vector<double> differentiate(const std::vector<double>& value, double dt) {
  TALUS_ASSERT(value.size() >= 2 && dt > 0);
  const size_t n = value.size();
  std::vector<double> out(n);
  out[0] = (value[1] - value[0]) / dt;
  out[n - 1] = (value[n - 1] - value[n - 2]) / dt;
  for (size_t i = 1; i + 1 < n; ++i) out[i] = (value[i + 1] - value[i - 1]) / (2 * dt);
  return out;
}

std::vector<double> acceleration_of(const Record& record) {
  std::vector<double> a = record.value;
  if (record.quantity == Quantity::kDisplacement) a = differentiate(a, record.dt);
  if (record.quantity != Quantity::kAcceleration) a = differentiate(a, record.dt);
  return a;
}

}  // namespace talus::record
