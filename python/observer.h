#pragma once
// What a function in Python sees of a run, instant by instant.

#include "arrays.h"

#include <atomic>
#include <chrono>
#include <memory>

namespace talus::python {

/// Shows a Python function the instants, and hears Ctrl-C.
class PyObserver : public Observer {
 public:
  PyObserver(std::shared_ptr<Memory> memory, py::object function, int64_t every, Observer* next)
      : memory_(std::move(memory)), function_(std::move(function)), every_(every), next_(next) {
    const State& s = memory_->state;
    displacement_ = s.displacement.data(), strain_part_ = s.strain_part.data(), rate_ = s.rate.data();
  }

  void stage_is_followed(const Scene& scene, int stage, const StagePlan& plan,
                         const std::string& why) override {
    if (next_) next_->stage_is_followed(scene, stage, plan, why);
  }
  void blocks_are_left_out(const Scene& scene, int stage, const std::string& who) override {
    if (next_) next_->blocks_are_left_out(scene, stage, who);
  }
  void stage_begins(const Scene& scene, int stage, const StagePlan& plan) override {
    if (next_) next_->stage_begins(scene, stage, plan);
  }
  void at(const Instant& now) override;
  void fails(const Instant& now) override {
    if (next_) next_->fails(now);
  }
  bool stop() override;
  bool wants_state() override { return next_ && next_->wants_state(); }
  bool wants_copy() override { return next_ && next_->wants_copy(); }
  void hold_state(const Standing& standing, const State& state) override {
    if (next_) next_->hold_state(standing, state);
  }
  void keep_state(const Standing& standing, const State& state) override {
    if (next_) next_->keep_state(standing, state);
  }

  // From any thread.
  void interrupt() { stopped_ = true; }
  // No more calls.
  void mute() { listens_ = false; }
  // No more results: of a run that is over.
  void leave_results() { next_ = nullptr; }
  // Passes on what the function has thrown, or KeyboardInterrupt. With the GIL.
  void throw_if_error();

 private:
  std::shared_ptr<Memory> memory_;
  py::object function_;
  int64_t every_;
  Observer* next_;
  const Vec2* displacement_ = nullptr;
  const Mat2* strain_part_ = nullptr;
  const BlockRate* rate_ = nullptr;
  bool listens_ = !function_.is_none();
  std::atomic<bool> stopped_ = false;
  std::unique_ptr<py::error_already_set> error_;
  std::chrono::steady_clock::time_point asked_ = std::chrono::steady_clock::now();
};

/// Instant.
void bind_instants(py::module_& m);

/// Terms of the ledger that are shown.
py::dict energy_of(const Energy& energy);

}  // namespace talus::python
