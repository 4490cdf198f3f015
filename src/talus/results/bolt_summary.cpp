#include "talus/results/bolt_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "talus/base/index.h"

namespace talus {

BoltSummary BoltSummary::of(const std::vector<BoltLine>& lines) {
  BoltSummary s;
  std::map<std::string, int> worst;
  for (const BoltLine& line : lines) {
    int& own = worst[line.bolt];
    own = std::max(own, line.condition);
    if (line.axial > s.tension) s.tension = line.axial, s.tension_in = line.bolt;
  }
  s.bolts = count_of(worst);
  for (const auto& [bolt, condition] : worst) s.yielded += condition == 1, s.ruptured += condition == 2;
  return s;
}

namespace {

void exchange(auto& x, auto& s, const std::string& name) {
  x(name + ".bolts", s.bolts), x(name + ".yielded", s.yielded), x(name + ".ruptured", s.ruptured);
  x(name + ".tension", s.tension), x(name + ".tension_in", s.tension_in);
}

}  // namespace

void BoltSummary::save(Saver& to, const std::string& name) const { exchange(to, *this, name); }
void BoltSummary::load(Loader& from, const std::string& name) { exchange(from, *this, name); }

std::string BoltSummary::text() const {
  std::string out = fmt::format("{} of {} ruptured, {} yielded", ruptured, bolts, yielded);
  if (tension > 0) out += fmt::format("; largest tension {:.3g} kN in {}", tension / 1e3, tension_in);
  return out;
}

}  // namespace talus
