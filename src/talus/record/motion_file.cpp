#include "talus/record/motion_file.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "talus/base/version.h"
#include "talus/record/response_spectrum.h"

namespace talus::record {

namespace {

nlohmann::ordered_json json_of(const Measures& m) {
  return {{"pga [m/s2]", m.pga},
          {"pga_time [s]", m.pga_time},
          {"pgv [m/s]", m.pgv},
          {"pgd [m]", m.pgd},
          {"arias [m/s]", m.arias},
          {"significant_duration [s]", m.significant_duration},
          {"end_velocity [m/s]", m.end_velocity},
          {"end_displacement [m]", m.end_displacement},
          {"highest_frequency [Hz]", m.highest_frequency}};
}

}  // namespace

std::string motion_csv(const Motion& m) {
  std::string out = "time [s],acceleration [m/s2],velocity [m/s],displacement [m]\n";
  // times are printed to twelve digits: 0.06 and not 0.060000000000000005; the step comes back to 1e-12 of
  // itself
  for (size_t i = 0; i < m.size(); ++i)
    fmt::format_to(std::back_inserter(out), "{:.12g},{},{},{}\n", static_cast<double>(i) * m.dt,
                   m.acceleration[i], m.velocity[i], m.displacement[i]);
  return out;
}

std::string spectrum_csv(const Motion& m) {
  constexpr double kShortest = 0.02, kLongest = 10;  // [s]
  constexpr int kPeriods = 200;
  const std::vector<double> periods = spectrum_periods(kShortest, kLongest, kPeriods);
  const std::vector<double> sa = response_spectrum(m.acceleration, m.dt, periods);
  std::string out = "period [s],sa [m/s2]\n";
  for (size_t i = 0; i < periods.size(); ++i) out += fmt::format("{:.9g},{:.9g}\n", periods[i], sa[i]);
  return out;
}

std::string record_json(const Account& a) {
  nlohmann::ordered_json j;
  j["program"] = fmt::format("talus {}", kVersion);
  j["source"] = a.source;
  if (!a.hash.empty()) {
    j["source_hash"] = a.hash;
    j["format"] = a.format;
    j["title"] = a.title;
    j["unit"] = a.unit;
    j["offset_removed [SI]"] = a.offset;
  }
  j["standard_gravity [m/s2]"] = kStandardGravity;
  j["samples"] = a.samples;
  j["time_step [s]"] = a.dt;
  j["steps"] = nlohmann::ordered_json::array();
  for (const Step& step : a.steps) {
    nlohmann::ordered_json s{{"name", step.name}};
    for (const auto& [name, value] : step.numbers) s[name] = value;
    j["steps"].push_back(s);
  }
  if (!a.before.empty()) j["before"] = json_of(a.before[0]);
  j["after"] = json_of(a.after);
  return j.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace talus::record
