#pragma once
// Runs a model text in memory and keeps its histories as a table.

#include <doctest/doctest.h>

#include <cstdlib>

#include <functional>
#include <string>
#include <vector>

#include "support/formulation.h"
#include "talus/talus.h"

namespace talus::test {

struct CaseResult {
  CsvTable table;
  RunResult run;
  State state;  // after the last step

  const std::vector<double>& column(const std::string& name) const { return table.column(name); }
};

/// Collects the histories; `watch`, when given, sees every instant.
class MemoryObserver : public Observer {
 public:
  MemoryObserver(const Scene& scene, std::function<void(const Instant&)> watch)
      : histories_(scene, [this](const std::vector<double>& row) { keep(row); }), watch_(std::move(watch)) {
    table.columns = texts_of(histories_.columns());
    table.values.resize(table.columns.size());
  }
  void at(const Instant& instant) override {
    histories_.at(instant, true);
    if (watch_) watch_(instant);
    if (instant.last) histories_.finish();
  }

  CsvTable table;

 private:
  void keep(const std::vector<double>& row) {
    for (size_t i = 0; i < row.size(); ++i) table.values[i].push_back(row[i]);
  }
  Histories histories_;
  std::function<void(const Instant&)> watch_;
};

/// TALUS_TEST_SOLVER=gauss_seidel runs every case by that solver unless it names one itself.
/// @param prepare  may change the state before the first step
/// @param file     the model's own path, where it names other files
inline CaseResult run_case(const std::string& model, const std::vector<std::string>& overrides = {},
                           const std::function<void(const Instant&)>& watch = nullptr,
                           const std::function<void(const Scene&, State&)>& prepare = nullptr,
                           const std::string& file = "case.toml") {
  Findings findings(file, model);
  std::vector<std::string> all = overrides;
  if (const char* solver = std::getenv("TALUS_TEST_SOLVER");
      solver && model.find("method =") == std::string::npos && model.find("smoothed") == std::string::npos)
    all.insert(all.begin(), std::string("solver.method=") + solver);
  if (other_formulation() == "as_printed" && model.find("\nmethod =") != std::string::npos)
    all.push_back("solver.method=\"newton\"");  // it has no other
  PreparedRun prepared = by_formulation(all, [&] { return prepare_run(file, model, all, findings); });
  CaseResult result;
  result.state = start_state(prepared.scene);
  if (prepare) prepare(prepared.scene, result.state);
  MemoryObserver observer(prepared.scene, watch);
  result.run = run_stages(prepared.scene, prepared.plans, result.state, observer);
  result.table = observer.table;
  if (!result.run.failure.empty() && !other_formulation().empty())
    print_reason("not computed", result.run.failure);
  INFO(result.run.failure);
  REQUIRE(result.run.failure.empty());
  CHECK(result.run.failed_steps == 0);
  CHECK(result.run.loose_steps == 0);
  return result;
}

}  // namespace talus::test
