#include "talus/audit/findings.h"

#include <fmt/format.h>

#include <algorithm>

#include "talus/base/index.h"

namespace talus::audit {

namespace {

constexpr std::array<const char*, kDefects> kKey{
    "prescribed_overlap", "unexplained_overlap", "deep_closure", "force_vanished", "crossed",
    "covered_side",       "force_across_gap",    "no_joint",     "normal_law",     "energy_law",
    "shear_law",          "closing_work",        "joint_work",   "failed_steps",   "loose_steps"};

// What a kind of defect is called in lines for readers.
constexpr std::array<const char*, kDefects> kTitle{"overlap of prescribed blocks",
                                                   "unexplained overlap",
                                                   "deep closure",
                                                   "force that vanished",
                                                   "block that went through",
                                                   "force on a covered side",
                                                   "force across a gap",
                                                   "force without a joint",
                                                   "normal force off the joint's law",
                                                   "force off the overlap's energy",
                                                   "force beyond the joint's law",
                                                   "work of closing contacts",
                                                   "work of elastic joints",
                                                   "failed steps",
                                                   "loose steps"};

void exchange_finding(auto& x, const std::string& name, auto& f) {
  x(name + ".defect", f.defect), x(name + ".invalid", f.invalid);
  x(name + ".block_a", f.block_a), x(name + ".block_b", f.block_b);
  x(name + ".time", f.time), x(name + ".place", f.place);
  x(name + ".share", f.share), x(name + ".text", f.text);
}

}  // namespace

const char* key_of(Defect defect) { return kKey[place_of(defect)]; }

std::string pair_text(const std::vector<std::string>& names, int block_a, int block_b) {
  const auto name = [&names](int i) { return "\"" + names[i] + "\""; };
  if (block_a < 0) return "";
  return block_b < 0 ? name(block_a) : name(block_a) + " and " + name(block_b);
}

void Report::add(const Finding& f) {
  Entry& e = entries_[place_of(f.defect)];
  if (e.count == 0 || (f.invalid && !e.invalid)) e.first = f;
  if (e.count == 0 || (f.invalid && !e.worst.invalid) ||
      (f.invalid == e.worst.invalid && f.share > e.worst.share))
    e.worst = f;
  ++e.count;
  e.invalid = e.invalid || f.invalid;
}

bool Report::valid() const { return invalid_kinds() == 0; }

int Report::invalid_kinds() const {
  return static_cast<int>(
      std::count_if(entries_.begin(), entries_.end(), [](const Entry& e) { return e.invalid; }));
}

int Report::warning_kinds() const {
  return static_cast<int>(std::count_if(entries_.begin(), entries_.end(),
                                        [](const Entry& e) { return e.count > 0 && !e.invalid; }));
}

std::vector<std::string> Report::lines(const std::vector<std::string>& names) const {
  std::vector<std::string> out;
  for (const bool invalid : {true, false}) {
    for (size_t d = 0; d < kDefects; ++d) {
      const Entry& e = entries_[d];
      if (e.count == 0 || e.invalid != invalid) continue;
      const Finding& w = e.worst;
      std::string line = fmt::format("{}: {}: ", invalid ? "NOT VALID" : "warning", kTitle[d]);
      const std::string pair = pair_text(names, w.block_a, w.block_b);
      if (!pair.empty())
        line += fmt::format("{} at t = {:.6g} s, ({:.6g}, {:.6g}): ", pair, w.time, w.place.x, w.place.y);
      line += w.text;
      if (e.count > 1)
        line += fmt::format(
            "; the worst of {}, first {} t = {:.6g} s", e.count,
            pair_text(names, e.first.block_a, e.first.block_b) + (pair.empty() ? "at" : " at"), e.first.time);
      out.push_back(line);
    }
  }
  return out;
}

template <class X, class Self>
void Report::exchange(X& x, Self& self, const std::string& name) {
  x(name + ".frames", self.frames), x(name + ".steps", self.steps);
  x(name + ".patches_by_energy", self.patches_by_energy);
  x(name + ".unexplained_share", self.unexplained_share),
      x(name + ".unexplained_area", self.unexplained_area);
  x(name + ".closure_share", self.closure_share), x(name + ".slack", self.slack);
  for (size_t d = 0; d < kDefects; ++d) {
    const std::string entry = name + "." + kKey[d];
    x(entry + ".count", self.entries_[d].count), x(entry + ".invalid", self.entries_[d].invalid);
    exchange_finding(x, entry + ".worst", self.entries_[d].worst);
    exchange_finding(x, entry + ".first", self.entries_[d].first);
  }
}

void Report::save(Saver& to, const std::string& name) const { exchange(to, *this, name); }
void Report::load(Loader& from, const std::string& name) { exchange(from, *this, name); }

bool Report::fits(int blocks) const {
  const auto known = [blocks](int i) { return i >= -1 && i < blocks; };
  const auto right = [&](const Finding& f) {
    return f.defect != Defect::kCount && known(f.block_a) && known(f.block_b);
  };
  return std::all_of(entries_.begin(), entries_.end(), [&](const Entry& e) {
    return e.count == 0 || (e.count > 0 && right(e.worst) && right(e.first));
  });
}

}  // namespace talus::audit
