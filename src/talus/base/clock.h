#pragma once
// Wall time, for what is shown and measured; nothing that is computed depends on it.

#include <chrono>

namespace talus {

/// Seconds since some fixed moment.
inline double wall_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Adds the time of its life to `seconds`.
class Timed {
 public:
  explicit Timed(double& seconds) : seconds_(seconds), start_(wall_now()) {}
  ~Timed() { seconds_ += wall_now() - start_; }
  Timed(const Timed&) = delete;
  Timed& operator=(const Timed&) = delete;

 private:
  double& seconds_;
  double start_;
};

}  // namespace talus
