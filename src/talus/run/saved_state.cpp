#include "talus/run/saved_state.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "talus/base/error.h"
#include "talus/base/version.h"
#include "talus/blocks/state_fields.h"
#include "talus/blocks/validate.h"
#include "talus/model/model_keys.h"
#include "talus/run/validate_loaded.h"

namespace talus {

namespace {

template <class T>
concept HasFields = requires(T& value) {
  each_field(value, [](const char*, auto&) {});
};

template <class T>
inline constexpr bool kIsList = false;
template <class T>
inline constexpr bool kIsList<std::vector<T>> = true;

// A member that is a list goes by itself, not as a column.
template <class T>
inline constexpr bool kIsListMember = kIsList<std::remove_cvref_t<T>>;

void exchange_list(auto& x, const std::string& name, auto& list);

// A value under its name, down to the fields of structs and of lists of structs.
void exchange_value(auto& x, const std::string& name, auto& value) {
  using T = std::remove_cvref_t<decltype(value)>;
  if constexpr (HasFields<T>) {
    each_field(value,
               [&](const char* field, auto& member) { exchange_value(x, name + "." + field, member); });
  } else if constexpr (kIsList<T>) {
    if constexpr (HasFields<typename T::value_type>)
      exchange_list(x, name, value);
    else
      x(name, value);
  } else {
    x(name, value);
  }
}

// The fields of a list of structs as columns; lists in its elements by themselves.
void exchange_list(auto& x, const std::string& name, auto& list) {
  x.each(name, list, [](auto& column, auto& element) {
    each_field(element, [&](const char* field, auto& member) {
      if constexpr (!kIsListMember<decltype(member)>) column(field, member);
    });
  });
  for (size_t i = 0; i < list.size(); ++i)
    each_field(list[i], [&](const char* field, auto& member) {
      if constexpr (kIsListMember<decltype(member)>)
        exchange_value(x, fmt::format("{}.{}.{}", name, i, field), member);
    });
}

void exchange_plan(auto& field, auto& p) {
  field("dt", p.dt), field("plan_steps", p.steps), field("dt_bound", p.dt_bound);
  field("bound_block", p.bound_block), field("bound_column", p.bound_column);
  field("dt_undamped", p.dt_undamped), field("clamp_dt", p.clamp_dt);
  field("clamped", p.clamped), field("largest_clamp", p.largest_clamp);
  field("dt_follow", p.dt_follow), field("steps_follow", p.steps_follow);
  field("bound_follow", p.bound_follow), field("plan_balances", p.balances);
}

void exchange_standing(auto& x, auto& standing) {
  auto& r = standing.result;
  x("run.between_stages", standing.between);
  x.each("run.stages", r.stages, [](auto& field, auto& s) {
    exchange_plan(field, s.plan);
    field("kind", s.kind), field("steps", s.steps), field("begin", s.begin), field("end", s.end);
    field("unbalanced", s.unbalanced), field("at_rest", s.at_rest);
    field("steps_from_rest", s.steps_from_rest), field("followed_from", s.followed_from);
    field("left_out_share", s.left_out_share), field("balances", s.balances);
  });
  for (size_t i = 0; i < r.stages.size(); ++i) {
    x(fmt::format("run.stages.name.{}", i), r.stages[i].name);
    x(fmt::format("run.stages.followed_because.{}", i), r.stages[i].followed_because);
    x(fmt::format("run.stages.left_out.{}", i), r.stages[i].left_out);
  }
  x("run.steps", r.steps), x("run.failed_steps", r.failed_steps);
  x("run.loose_steps", r.loose_steps), x("run.ringing_steps", r.ringing_steps);
  x("run.second_solver_steps", r.second_solver_steps), x("run.iterations", r.iterations);
  for (size_t k = 1; k < kSolverName.size(); ++k)
    x(fmt::format("run.{}_steps", kSolverName[k]), r.steps_by[k]);
  x("run.most_contacts", r.most_contacts), x("run.most_iterations", r.most_iterations);
  x("run.worst_error", r.worst_error), x("run.worst_error_time", r.worst_error_time);
  x("run.worst_error_row", r.worst_error_row), x("run.deepest_drift", r.deepest_drift);
  x("run.closed_share", r.closed_share), x("run.closed_time", r.closed_time),
      x("run.closed_row", r.closed_row);
  x("run.jolt", r.jolt), x("run.jolt_time", r.jolt_time), x("run.jolt_row", r.jolt_row);
  x("run.penalty", r.penalty), x("run.cut_steps", r.cut_steps), x("run.parts", r.parts);
  x("run.penetration", r.penetration), x("run.condition", r.condition);
  x("run.energy", r.energy);
  x("run.largest_left_over", r.largest_left_over), x("run.largest_energy", r.largest_energy);
  x("run.wall_seconds", r.wall_seconds), x("run.cpu_seconds", r.cpu_seconds);
}

}  // namespace

void save_state(Saver& to, const State& state) { exchange_value(to, "state", state); }
void load_state(Loader& from, State& state) { exchange_value(from, "state", state); }
void save_standing(Saver& to, const Standing& standing) { exchange_standing(to, standing); }
void load_standing(Loader& from, Standing& standing) { exchange_standing(from, standing); }

Archive run_archive(const Scene& scene, const Standing& standing, const State& state) {
  Archive archive;
  archive.texts["program"] = fmt::format("talus {}", kVersion);
  archive.texts["model.hash"] = scene.model.hash;
  archive.texts["model.text"] = scene.model.text;
  archive.texts["model.shapes_hash"] = scene.model.shapes_hash;
  for (const History& h : scene.model.histories) archive.numbers[kSavedStart + h.name] = {h.value_at(0)};
  archive.numbers[kSavedGive] = {scene.give.stress, scene.give.shortest_step};
  Saver saver(archive);
  save_state(saver, state);
  save_standing(saver, standing);
  return archive;
}

namespace {

std::filesystem::path folder_above(const std::filesystem::path& saved) {
  std::error_code ec;
  return std::filesystem::absolute(saved, ec).lexically_normal().parent_path().parent_path();
}

}  // namespace

std::string folder_of_saved(const std::filesystem::path& saved) {
  namespace fs = std::filesystem;
  std::error_code ec;
  const fs::path folder = folder_above(saved);
  if (!fs::exists(saved, ec)) throw FileError(fmt::format("{}: there is no such file", saved.string()));
  if (!fs::exists(folder / "histories.csv", ec))
    throw FileError(fmt::format(
        "{}: does not lie in the folder saved/ of a run: its results would not be found to go on with",
        saved.string()));
  return folder.string();
}

bool lies_in(const std::filesystem::path& saved, const std::filesystem::path& folder) {
  std::error_code ec;
  return std::filesystem::equivalent(folder_above(saved), folder, ec);
}

namespace {

[[noreturn]] void damaged(const std::string& name, const std::string& why) {
  throw FileError(fmt::format(
      "{}: the saved state is damaged: {}. Go on from another one, or run the model anew", name, why));
}

// Results are finite, but for the limits of steps that have none; what of a State may be endless is judged with
// it.
void check_results_finite(const Archive& a) {
  for (const auto& [name, values] : a.numbers) {
    if (name.rfind("state.", 0) == 0 || name == "run.stages.dt_bound" || name == "run.stages.dt_undamped" ||
        name == "run.stages.bound_follow")
      continue;
    for (const double v : values)
      if (!std::isfinite(v)) throw std::logic_error(fmt::format("\"{}\" is {}", name, v));
  }
}

// Lists are as long as those of a run that begins.
bool fits(const State& state, const State& fresh) {
  return state.displacement.size() == fresh.displacement.size() && state.face.size() == fresh.face.size() &&
         state.supports.size() == fresh.supports.size() &&
         state.boundaries.size() == fresh.boundaries.size() && state.ties.size() == fresh.ties.size() &&
         state.column_rate.size() == fresh.column_rate.size();
}

}  // namespace

SavedRun read_saved_run(const std::filesystem::path& path, const PreparedRun& prepared) {
  return saved_run_of(path.string(), read_archive(path), prepared);
}

SavedRun saved_run_of(const std::string& name, Archive archive, const PreparedRun& prepared) {
  const Scene& scene = prepared.scene;
  if (archive.texts["model.hash"] != scene.model.hash) {
    const std::string differ = model_difference(scene.model.text, archive.texts["model.text"]);
    throw InputError(fmt::format(
        "{}: error: the state is of another model than {}:\n{}Run the model anew, or put it back as it was; with -o and a new folder "
        "the run may branch off (docs/file_format.md)\n",
        name, scene.model.file,
        differ.empty() ? "  no key differs, but comments or a file that the model reads do\n" : differ));
  }
  return take_state(name, std::move(archive), prepared);
}

SavedRun take_state(const std::string& name, Archive archive, const PreparedRun& prepared) {
  const Scene& scene = prepared.scene;
  SavedRun saved;
  saved.archive = std::move(archive);
  Archive& a = saved.archive;
  try {
    check_results_finite(a);
    Loader loader(a);
    load_state(loader, saved.state);
    load_standing(loader, saved.standing);
    const State fresh = start_state(scene);
    if (!fits(saved.state, fresh))
      throw std::logic_error(
          fmt::format("the model is cut or supported otherwise by this program ({} blocks now, {} then)",
                      fresh.displacement.size(), saved.state.displacement.size()));
    validate(saved.state, scene.blocks);
    validate_loaded(saved.standing, saved.state, prepared);
  } catch (const std::logic_error& e) {
    damaged(name, e.what());
  } catch (const FileError& e) {
    damaged(name, e.what());
  }
  return saved;
}

}  // namespace talus
