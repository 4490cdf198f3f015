#include "talus/run/branch.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "talus/base/error.h"
#include "talus/base/text.h"
#include "talus/base/text_file.h"

namespace talus {

namespace {

// "load.wind.pressure" -> "load", "wind"
struct Path {
  std::string section, name;
};

// Names in the text of a value, "[ 'rest', 'shake' ]" or "'rest'".
std::vector<std::string> names_in(const std::string& value) {
  std::vector<std::string> names;
  for (size_t at = 0; (at = value.find_first_of("'\"", at)) != std::string::npos;) {
    const size_t end = value.find(value[at], at + 1);
    if (end == std::string::npos) break;
    names.push_back(value.substr(at + 1, end - at - 1));
    at = end + 1;
  }
  return names;
}

class Sorter {
 public:
  Sorter(const ModelKeys& now, const ModelKeys& before, const std::vector<std::string>& begun, bool moved,
         bool bolted)
      : now_(now), before_(before), begun_(begun.begin(), begun.end()), moved_(moved), bolted_(bolted) {
    same_changes_ = changes(now) == changes(before);
  }

  bool is_later(const KeyDifference& d) const {
    static const std::set<std::string> kWatching{"title", "monitor", "output", "solver", "safety"};
    const auto [section, name] = path_of(d.key);
    if (kWatching.count(section)) return true;
    if (section == "stage") return !begun_.count(name);
    if (section == "history") return !moved_;
    if (section == "load") return acts_later(section, name, "stages");
    // the state holds a force for each point that they hold: none comes or goes
    if (section == "support" || section == "boundary")
      return in(now_, section, name) && in(before_, section, name) && acts_later(section, name, "stages");
    if (section == "bolt" || section == "bolt_pattern") return !bolted_ && acts_later(section, name, "stage");
    if (section == "bolt_type") return !bolted_;
    if (section == "change") return same_changes_;
    return false;
  }

 private:
  // Entries of lists know their names, which may hold dots; so may what stands behind them.
  Path path_of(const std::string& key) const {
    const size_t dot = key.find('.');
    if (dot == std::string::npos) return {key, ""};
    const std::string section = key.substr(0, dot);
    for (size_t end = key.rfind('.'); end > dot; end = key.rfind('.', end - 1)) {
      const std::string name = key.substr(dot + 1, end - dot - 1), own = section + "." + name + ".name";
      if (now_.count(own) || before_.count(own)) return {section, name};
    }
    const size_t next = key.find('.', dot + 1);
    return {section, next == std::string::npos ? "" : key.substr(dot + 1, next - dot - 1)};
  }

  static bool in(const ModelKeys& keys, const std::string& section, const std::string& name) {
    const std::string prefix = section + "." + name + ".";
    const auto at = keys.lower_bound(prefix);
    return at != keys.end() && at->first.rfind(prefix, 0) == 0;
  }

  // Wherever it is, now and before, it says in which stages it acts, and none of them has begun.
  bool acts_later(const std::string& section, const std::string& name, const char* key) const {
    for (const ModelKeys* keys : {&now_, &before_}) {
      if (!in(*keys, section, name)) continue;
      const auto at = keys->find(section + "." + name + "." + key);
      if (at == keys->end()) return false;
      const std::vector<std::string> stages = names_in(at->second);
      if (stages.empty() ||
          std::any_of(stages.begin(), stages.end(), [&](const auto& s) { return begun_.count(s) > 0; }))
        return false;
    }
    return true;
  }

  // The changes of stages that have begun, in their order.
  std::vector<std::string> changes(const ModelKeys& keys) const {
    std::vector<std::string> all;
    std::map<size_t, std::string> entries;  // by number
    const std::string prefix = "change.";
    for (auto at = keys.lower_bound(prefix); at != keys.end() && at->first.rfind(prefix, 0) == 0; ++at) {
      const auto [section, name] = path_of(at->first);
      entries[std::strtoul(name.c_str(), nullptr, 10)] +=
          at->first.substr(at->first.rfind('.') + 1) + "=" + at->second + ";";
    }
    for (const auto& [number, text] : entries) {
      const auto at = keys.find(fmt::format("change.{}.stage", number));
      const std::vector<std::string> stage =
          at == keys.end() ? std::vector<std::string>() : names_in(at->second);
      if (stage.size() != 1 || begun_.count(stage[0])) all.push_back(text);
    }
    return all;
  }

  const ModelKeys &now_, &before_;
  std::set<std::string> begun_;
  bool moved_, bolted_, same_changes_;
};

// Histories that begin elsewhere than before.
std::string moved_starts(const Archive& before, const std::vector<History>& now) {
  std::string out;
  for (const History& h : now) {
    const auto then = before.numbers.find(kSavedStart + h.name);
    if (then == before.numbers.end() || then->second == std::vector{h.value_at(0)}) continue;
    out += fmt::format("  history.{}: begins at {:g}, and at {} there; static stages have its first value\n",
                       h.name, h.value_at(0), fmt::join(then->second, " "));
  }
  return out;
}

}  // namespace

BranchKeys branch_keys(const ModelKeys& now, const ModelKeys& before, const std::vector<std::string>& begun,
                       bool moved, bool bolted) {
  const Sorter sorter(now, before, begun, moved, bolted);
  BranchKeys keys;
  for (const KeyDifference& d : differences(now, before))
    (sorter.is_later(d) ? keys.later : keys.earlier).push_back(d);
  return keys;
}

SavedRun branch_of(const std::string& name, const std::string& bytes, PreparedRun& prepared,
                   BranchOrigin& origin) {
  Scene& scene = prepared.scene;
  Archive archive = parse_archive(name, bytes);
  origin.state = name, origin.digest = text_hash(bytes);
  origin.model_hash = archive.texts["model.hash"];

  Standing standing;
  State state;
  std::vector<double> give;
  try {
    Loader loader(archive);
    load_standing(loader, standing);
    load_state(loader, state);
    loader(kSavedGive, give);
    if (give.size() != 2 || !(give[0] >= 0) || !(give[1] >= 0))
      throw FileError("the give of its contacts is none");
  } catch (const FileError& e) {
    throw FileError(
        fmt::format("{}: the saved state is damaged: {}. Branch off from another one", name, e.what()));
  }
  std::vector<std::string> begun;
  for (const StageResult& s : standing.result.stages) begun.push_back(s.name);
  origin.stage = begun.empty() ? "" : begun.back();
  origin.between = standing.between, origin.step = state.step, origin.time = state.time;

  const ModelKeys now = keys_in_force(scene.model.text), before = keys_in_force(archive.texts["model.text"]);
  const BranchKeys keys = branch_keys(now, before, begun, state.history_time > 0, !state.bolts.empty());
  std::string refused = difference_lines(keys.earlier);
  for (size_t i = 0; i < begun.size(); ++i)
    if (i >= scene.model.stages.size() || scene.model.stages[i].name != begun[i]) {
      refused += fmt::format("  stage.{}: is not stage {} any more\n", begun[i], i + 1);
      break;
    }
  if (archive.texts["model.shapes_hash"] != scene.model.shapes_hash)
    refused += "  a mesh: what its file holds is not what it held\n";
  if (state.history_time == 0) refused += moved_starts(archive, scene.model.histories);
  if (!refused.empty())
    throw InputError(fmt::format(
        "{}: error: no branch of it can differ in these, which say how it came to stand at {:g} s, in stage \"{}\":\n{}"
        "A branch may have other later stages, histories (while none has run), loads, supports, boundaries, bolts and changes "
        "that act in later stages alone, monitors, output and solver. For the rest run the model anew\n",
        name, origin.time, origin.stage, refused));
  for (const KeyDifference& d : keys.later) {
    origin.differs.push_back(d.text());
    origin.same_monitors = origin.same_monitors && d.key.rfind("monitor.", 0) != 0;
    origin.same_output = origin.same_output && d.key.rfind("output.", 0) != 0;
  }
  scene.give.stress = give[0], scene.give.shortest_step = give[1];
  SavedRun saved = take_state(name, std::move(archive), prepared);
  saved.standing.result.wall_seconds = saved.standing.result.cpu_seconds = 0;
  return saved;
}

}  // namespace talus
