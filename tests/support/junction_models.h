#pragma once
// Pieces of models in which blocks meet at junctions of joints, and a run that the audit must find valid.

#include <memory>

#include "support/box_polygon.h"
#include "support/model_text.h"
#include "support/run_case.h"
#include "support/tolerance.h"
#include "talus/base/angle.h"
#include "talus/results/auditor.h"

namespace talus::test::junction {

inline const double kMu = std::tan(30 * kDegree);
inline constexpr double kG = 10;
inline const std::string kHard;
inline const std::string kElastic = "normal_stiffness = \"20 GPa/m\"\nshear_stiffness = \"20 GPa/m\"";

inline std::string head(const std::string& joint, double gravity, double friction, double poisson = 0.2) {
  return fmt::format(
      "talus = 1\n[model]\ngravity = [0, {}]\n[material.m]\ndensity = 2500\nyoung = \"20 GPa\"\npoisson = "
      "{}\n"
      "[joint.j]\nfriction_angle = \"{} deg\"\n{}\n[contact]\njoint = \"j\"\n[joint.glue]\nkind = "
      "\"bonded\"\n",
      -gravity, poisson, friction, joint);
}

inline std::string constant(const std::string& name, double value) {
  return fmt::format("[history.{0}]\ntime = [0, 1]\nvalue = [{1:.17g}, {1:.17g}]\n", name, value);
}

inline std::string on_edge(const std::string& name, Vec2 from, Vec2 to, const std::string& what) {
  return fmt::format("[[load]]\nname = \"{}\"\nedge = [{}, {}]\n{}\n", name, point_text(from), point_text(to),
                     what);
}

// Implicit elasticity: steps are as long as what happens asks for.
inline std::string stage(const std::string& name, bool dynamic, double duration, double step,
                         const std::string& more = "") {
  return fmt::format(
      "[[stage]]\nname = \"{}\"\nkind = \"{}\"\nduration = {}\ntime_step = {}\nelasticity = "
      "\"implicit\"\n{}\n",
      name, dynamic ? "dynamic" : "static", duration, step, more);
}

inline std::string between(const std::string& name, const std::string& first, const std::string& second) {
  return fmt::format("[[monitor]]\nname = \"{}\"\ncontact = [\"{}\", \"{}\"]\n", name, first, second);
}

// Runs a case with the audit, which must find it valid, or else is shown.
inline CaseResult audited(const std::string& text, const std::function<void(const Instant&)>& watch = nullptr,
                          bool must_be_valid = true, audit::Report* told = nullptr) {
  std::unique_ptr<Auditor> auditor;
  audit::Report report;
  std::vector<std::string> names;
  int64_t count = 0;
  CaseResult result = run_case(text, {}, [&](const Instant& i) {
    if (!auditor) auditor = std::make_unique<Auditor>(i.scene);
    auditor->at(i, count++ % 20 == 0 || i.last);
    if (watch) watch(i);
    if (i.last) report = auditor->report(), names = i.scene.blocks.name;
  });
  std::string found;
  for (const std::string& line : report.lines(names)) found += line + "\n";
  if (!found.empty()) fmt::print("audit: {}", found);
  INFO(found);
  if (must_be_valid) CHECK(report.valid());
  if (told) *told = report;
  return result;
}

inline std::vector<double> sum(std::vector<double> a, const std::vector<double>& b) {
  for (size_t i = 0; i < a.size(); ++i) a[i] += b[i];
  return a;
}

// The row at a time.
inline size_t row_at(const CaseResult& r, double time) {
  const auto& t = r.column("t [s]");
  return static_cast<size_t>(std::lower_bound(t.begin(), t.end(), time) - t.begin());
}

// The time from a row to the end.
inline double time_from(const CaseResult& r, size_t row) {
  return r.column("t [s]").back() - r.column("t [s]")[row];
}

// Start of the last dynamic stage: histories of a run with a static stage before.
inline double stage_begins(const CaseResult& r, double duration) {
  return r.column("t [s]").back() - duration;
}

}  // namespace talus::test::junction
