#pragma once
// The public face of the library: read a model, run it, look at what happens at every step.
//
//   talus::Findings findings("model.toml", text);
//   auto run = talus::prepare_run("model.toml", text, {}, findings);   // throws InputError with all findings
//   talus::State state = talus::start_state(run.scene);
//   MyObserver observer;                                               // or talus::Recorder for a result
//   folder talus::RunResult result = talus::run_stages(run.scene, run.plans, state, observer);

#include "talus/base/error.h"
#include "talus/base/version.h"
#include "talus/run/recorder.h"
#include "talus/run/run.h"
#include "talus/run/safety.h"
#include "talus/run/sliver_offer.h"
