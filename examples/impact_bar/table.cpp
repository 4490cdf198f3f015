// Compares runs of impact_bar.toml with the exact solution: prints a table and writes exact.csv beside each
// run. Usage: impact_bar_table DIR:E:V0 ...     (folder of results, Young's modulus [Pa], velocity [m/s])

#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <string>

#include "exact.h"
#include "measure.h"
#include "talus/base/error.h"
#include "talus/output/files.h"

namespace {

using talus::example::BarImpact;

int print_table(int argc, char** argv) {
  fmt::print("{:<12} | {:^26} | {:^26} | {:^26} | {:^26}\n", "", "second peak of the mean [N]",
             "impulse [N s]", "separation [ms]", "rebound [m/s]");
  fmt::print("{:<12}", "case");
  for (int i = 0; i < 4; ++i) fmt::print(" | {:>9} {:>9} {:>6}", "computed", "exact", "error");
  fmt::print("\n");
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const size_t second = argument.rfind(':'), first = argument.rfind(':', second - 1);
    if (first == std::string::npos || second == std::string::npos)
      throw talus::Error(talus::kExitUsage, "usage: impact_bar_table DIR:E:V0 ...");
    const std::string folder = argument.substr(0, first);
    const talus::example::BarCase bar{std::stod(argument.substr(first + 1)),
                                      std::stod(argument.substr(second + 1))};
    const talus::CsvTable run = talus::read_csv(folder + "/histories.csv");
    const talus::example::BarMeasures m = measure(bar, run);
    talus::write_file(folder + "/exact.csv", exact_csv(bar));

    const auto row = [](double computed, double exact) {
      fmt::print(" | {:9.5g} {:9.5g} {:5.1f}%", computed, exact, 100 * (computed / exact - 1));
    };
    fmt::print("{:<12}", folder.substr(folder.rfind('/') + 1));
    row(m.second_peak * bar.force_unit(), m.exact_second_peak * bar.force_unit());
    row(m.impulse * bar.impulse_unit(), m.exact_impulse * bar.impulse_unit());
    row(1e3 * m.separation * bar.time_unit(), 1e3 * m.exact_separation * bar.time_unit());
    row(m.rebound * bar.velocity, m.exact_rebound * bar.velocity);
    fmt::print("\n");
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return print_table(argc, argv);
  } catch (const talus::Error& e) {
    fmt::print(stderr, "impact_bar_table: {}\n", e.what());
    return e.code();
  } catch (const std::exception& e) {
    fmt::print(stderr, "impact_bar_table: {}\n", e.what());
    return 1;
  }
}
