#pragma once
// The public face of the library: read a model, run it, look at what happens at every step.
//
//   struct Fastest : talus::Observer {
//     void at(const talus::Instant& now) override {
//       for (size_t i = 0; i < now.state.rate.size(); ++i)
//         speed = std::max(speed, talus::norm(talus::rate_now(now.work, now.state, i).a));  // [m/s]
//     }
//     double speed = 0;
//   };
//
//   talus::Findings findings("model.toml", text);
//   talus::PreparedRun run = talus::prepare_run("model.toml", text, {}, findings);  // or InputError
//   talus::State state = talus::start_state(run.scene);
//   Fastest observer;  // or a talus::Recorder, which writes a folder of results
//   talus::RunResult result = talus::run_stages(run.scene, run.plans, state, observer);
//
// Compiled and run by tests/unit/test_talus_h.cpp.

#include "talus/base/error.h"
#include "talus/base/version.h"
#include "talus/results/recorder.h"
#include "talus/run/run.h"
#include "talus/run/safety.h"
#include "talus/run/sliver_offer.h"
