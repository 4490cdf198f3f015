#include "talus/results/step_table.h"

#include <fmt/format.h>

#include <algorithm>

namespace talus {

const Columns<Instant>& step_columns() {
  using I = Instant;
  static const Columns<Instant> columns = [] {
    const auto count = [](auto n) { return static_cast<double>(n); };
    Columns<Instant> out{
        {"t", "s", [](const I& i) { return i.state.time; }},
        {"dt", "s", [](const I& i) { return i.work.clock.dt; }},
        {"contacts", "", [count](const I& i) { return count(i.report.contacts); }},
        {"closed contacts", "", [count](const I& i) { return count(i.report.closed); }},
        {"islands", "", [count](const I& i) { return count(i.report.solve.islands); }, Over::kWorst},
        {"largest island", "points", [count](const I& i) { return count(i.report.solve.largest_island); },
         Over::kWorst},
        {"iterations", "", [count](const I& i) { return count(i.report.solve.iterations); }, Over::kWorst},
        {"contact error", "m", [](const I& i) { return i.report.error.worst; }, Over::kWorst},
        {"drift", "m", [](const I& i) { return i.report.drift; }, Over::kWorst},
        {"failed steps", "", [](const I& i) { return i.report.failed ? 1.0 : 0.0; }, Over::kSum},
        {"loose steps", "", [](const I& i) { return i.report.loose ? 1.0 : 0.0; }, Over::kSum},
        {"unbalanced", "", [](const I& i) { return i.report.unbalanced; }},
        {"broken faces", "",
         [count](const I& i) {
           return count(std::count_if(i.state.face.begin(), i.state.face.end(),
                                      [](const FaceState& f) { return f.broken; }));
         }},
        {"kinetic energy", "J", [](const I& i) { return i.report.energy.kinetic; }},
        {"strain energy", "J", [](const I& i) { return i.report.energy.strain; }},
        {"gravity work", "J", [](const I& i) { return i.report.energy.gravity; }}};
    for (size_t cause = 0; cause < std::size(kCauseName); ++cause)
      out.push_back({fmt::format("{} work", kCauseName[cause]), "J",
                     [cause](const I& i) { return i.report.energy.work.by[cause]; }});
    out.push_back({"energy left over", "J", [](const I& i) { return i.report.energy.left_over; }});
    return out;
  }();
  return columns;
}

}  // namespace talus
