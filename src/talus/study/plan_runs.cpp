#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "talus/base/error.h"
#include "talus/base/index.h"
#include "talus/base/text_file.h"
#include "talus/record/history_file.h"
#include "talus/record/measures.h"
#include "talus/record/response_spectrum.h"
#include "talus/schema/units.h"
#include "talus/study/study.h"

namespace talus::study {

namespace {

// Acceleration of a motion: a column of that name, or what a record gives.
record::Motion motion_of(const std::filesystem::path& path) {
  const std::string text = read_text_file(path), name = path.string();
  try {
    const record::HistoryColumn a = record::read_history_text(name, text, "acceleration");
    if (a.time.size() > 2) {
      const double dt = (a.time.back() - a.time.front()) / static_cast<double>(a.time.size() - 1);
      for (size_t i = 1; i < a.time.size(); ++i)
        if (std::abs(a.time[i] - a.time[i - 1] - dt) > 1e-3 * dt)
          throw InputError(
              fmt::format("{}: its times are not even: talus record makes an even motion of it", name));
      return record::integrate(a.value, dt);
    }
  } catch (const InputError&) {  // no table with such a column: a record, or wrong as that
  }
  const record::Record record = record::read_record_text(name, text);
  return record::integrate(record::acceleration_of(record), record.dt);
}

double measured(const Axis& axis, const std::filesystem::path& path) {
  const record::Motion motion = motion_of(path);
  const double found = axis.measure == "Sa"
                           ? record::response_spectrum(motion.acceleration, motion.dt, {axis.period})[0]
                       : axis.measure == "PGV" ? record::measure(motion).pgv
                                               : record::measure(motion).pga;
  if (!(found > 0))
    throw InputError(
        fmt::format("{}: its {} is {:g}: it cannot be scaled", path.string(), axis.measure, found));
  return found;
}

}  // namespace

std::vector<PlannedRun> plan_runs(const Study& study) {
  const std::vector<Axis>& axes = study.axes;
  // measures[axis][file] of axes that scale
  std::vector<std::vector<double>> measures(axes.size());
  std::vector<size_t> motion(axes.size());
  for (size_t a = 0; a < axes.size(); ++a) {
    if (axes[a].measure.empty()) continue;
    motion[a] = std::find_if(axes.begin(), axes.end(),
                             [&](const Axis& other) { return other.name == axes[a].motion; }) -
                axes.begin();
    for (const auto& path : axes[motion[a]].paths) measures[a].push_back(measured(axes[a], path));
  }
  size_t combinations = 1;
  bool sampled = false;
  for (const Axis& a : axes) a.sampled ? void(sampled = true) : void(combinations *= a.values.size());
  const size_t samples = sampled ? static_cast<size_t>(study.samples) : 1;

  std::vector<PlannedRun> runs;
  for (size_t c = 0; c < combinations; ++c)
    for (size_t s = 0; s < samples; ++s) {
      PlannedRun run;
      run.number = count_of(runs);
      std::vector<size_t> chosen(axes.size());
      size_t rest = c;
      for (size_t a = axes.size(); a-- > 0;) {  // the last listed key goes fastest
        if (axes[a].sampled) {
          chosen[a] = s;
        } else {
          chosen[a] = rest % axes[a].values.size();
          rest /= axes[a].values.size();
        }
      }
      run.overrides = study.set;
      for (size_t a = 0; a < axes.size(); ++a) {
        const AxisValue& value = axes[a].values[chosen[a]];
        run.values.push_back(value);
        std::string toml = value.toml;
        if (!axes[a].measure.empty()) {
          const Dimension dimension =
              axes[a].measure == "PGV" ? Dimension::kVelocity : Dimension::kAcceleration;
          const double target = parse_quantity(value.shown + " " + axes[a].unit, dimension).value;
          toml = fmt::format("{}", target / measures[a][chosen[motion[a]]]);
        }
        run.overrides.push_back(axes[a].key + "=" + toml);
      }
      runs.push_back(std::move(run));
    }
  return runs;
}

}  // namespace talus::study
