#include "talus/run/saved_state.h"

#include <fmt/format.h>

#include "talus/base/error.h"
#include "talus/base/version.h"
#include "talus/blocks/state_fields.h"
#include "talus/blocks/validate.h"

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

template <HasFields T>
void exchange_value(Exchange& x, const std::string& name, std::vector<T>& list);

// A value under its name, down to the fields of structs and of lists of structs.
template <class T>
void exchange_value(Exchange& x, const std::string& name, T& value) {
  if constexpr (HasFields<T>)
    each_field(value,
               [&](const char* field, auto& member) { exchange_value(x, name + "." + field, member); });
  else
    x(name, value);
}

// The fields of a list as columns; lists in its elements by themselves.
template <HasFields T>
void exchange_value(Exchange& x, const std::string& name, std::vector<T>& list) {
  x.each(name, list, [](auto& column, T& element) {
    each_field(element, [&](const char* field, auto& member) {
      if constexpr (!kIsList<std::remove_reference_t<decltype(member)>>) column(field, member);
    });
  });
  for (size_t i = 0; i < list.size(); ++i)
    each_field(list[i], [&](const char* field, auto& member) {
      if constexpr (kIsList<std::remove_reference_t<decltype(member)>>)
        exchange_value(x, fmt::format("{}.{}.{}", name, i, field), member);
    });
}

void exchange_plan(auto& field, StagePlan& p) {
  field("dt", p.dt), field("plan_steps", p.steps), field("dt_bound", p.dt_bound);
  field("bound_block", p.bound_block), field("bound_column", p.bound_column);
  field("dt_undamped", p.dt_undamped), field("clamp_dt", p.clamp_dt);
  field("clamped", p.clamped), field("largest_clamp", p.largest_clamp);
}

}  // namespace

void exchange_state(Exchange& x, State& s) { exchange_value(x, "state", s); }

void exchange_standing(Exchange& x, Standing& standing) {
  RunResult& r = standing.result;
  x("run.between_stages", standing.between);
  x.each("run.stages", r.stages, [](auto& field, StageResult& s) {
    exchange_plan(field, s.plan);
    field("kind", s.kind), field("steps", s.steps), field("begin", s.begin), field("end", s.end);
    field("unbalanced", s.unbalanced), field("at_rest", s.at_rest);
  });
  for (size_t i = 0; i < r.stages.size(); ++i) x(fmt::format("run.stages.name.{}", i), r.stages[i].name);
  x("run.steps", r.steps), x("run.failed_steps", r.failed_steps);
  x("run.second_solver_steps", r.second_solver_steps), x("run.iterations", r.iterations);
  for (size_t k = 1; k < kSolverName.size(); ++k)
    x(fmt::format("run.{}_steps", kSolverName[k]), r.steps_by[k]);
  x("run.most_contacts", r.most_contacts), x("run.most_iterations", r.most_iterations);
  x("run.worst_error", r.worst_error), x("run.worst_error_time", r.worst_error_time);
  x("run.worst_error_row", r.worst_error_row), x("run.deepest_drift", r.deepest_drift);
  x("run.closed_share", r.closed_share), x("run.closed_time", r.closed_time),
      x("run.closed_row", r.closed_row);
  x("run.energy", r.energy);
  x("run.largest_left_over", r.largest_left_over), x("run.largest_energy", r.largest_energy);
  x("run.wall_seconds", r.wall_seconds), x("run.cpu_seconds", r.cpu_seconds);
}

Archive run_archive(const Scene& scene, const Standing& standing, const State& state) {
  Archive archive;
  archive.numbers["format"] = {kStateFormat};
  archive.texts["program"] = fmt::format("talus {}", kVersion);
  archive.texts["model.hash"] = scene.model.hash;
  archive.texts["model.text"] = scene.model.text;
  Exchange exchange(archive, true);
  exchange_state(exchange, const_cast<State&>(state));           // saving changes nothing
  exchange_standing(exchange, const_cast<Standing&>(standing));  // the same
  return archive;
}

std::string folder_of_saved(const std::filesystem::path& saved, const std::string& expected) {
  namespace fs = std::filesystem;
  std::error_code ec;
  const fs::path folder = fs::absolute(saved, ec).lexically_normal().parent_path().parent_path();
  if (!fs::exists(saved, ec)) throw FileError(fmt::format("{}: there is no such file", saved.string()));
  if (!fs::exists(folder / "histories.csv", ec))
    throw FileError(fmt::format(
        "{}: does not lie in the folder saved/ of a run: its results would not be found to go on with",
        saved.string()));
  if (!expected.empty() && !fs::equivalent(folder, expected, ec))
    throw FileError(
        fmt::format("{}: belongs to the results in {}, not in {}. Leave out -o; to keep the old results, "
                    "copy the folder first",
                    saved.string(), folder.string(), expected));
  return folder.string();
}

SavedRun read_saved_run(const std::filesystem::path& path, const Scene& scene) {
  SavedRun saved;
  saved.archive = read_archive(path);
  Archive& a = saved.archive;
  const double format = a.numbers.count("format") ? a.numbers["format"].at(0) : 0;
  if (format != kStateFormat)
    throw InputError(fmt::format(
        "{}: error: the state is in format {:g}, written by {}; this program (talus {}) reads format {}. "
        "Go on with the program that wrote it, or run the model anew\n",
        path.string(), format, a.texts["program"], kVersion, kStateFormat));
  if (a.texts["model.hash"] != scene.model.hash) {
    const std::string differ = model_difference(scene.model.text, a.texts["model.text"]);
    throw InputError(fmt::format(
        "{}: error: the state is of another model than {}:\n{}Run the model anew, or put it back as it was\n",
        path.string(), scene.model.file,
        differ.empty() ? "  no key differs, but comments or a file that the model reads do\n" : differ));
  }
  Exchange exchange(a, false);
  exchange_state(exchange, saved.state);
  exchange_standing(exchange, saved.standing);
  const State fresh = start_state(scene);
  if (saved.state.displacement.size() != fresh.displacement.size() ||
      saved.state.face.size() != fresh.face.size() || saved.state.supports.size() != fresh.supports.size() ||
      saved.state.boundaries.size() != fresh.boundaries.size() ||
      saved.state.ties.size() != fresh.ties.size() ||
      saved.state.column_rate.size() != fresh.column_rate.size() || saved.standing.result.stages.empty())
    throw InputError(fmt::format(
        "{}: error: the state does not fit the model, which this program cuts or supports otherwise ({} "
        "blocks now, {} then). Run the model anew\n",
        path.string(), fresh.displacement.size(), saved.state.displacement.size()));
  try {
    validate(saved.state, scene.blocks);
  } catch (const std::logic_error& e) {
    throw InputError(
        fmt::format("{}: error: the state is damaged: {}. Go on from another one, or run the model anew\n",
                    path.string(), e.what()));
  }
  return saved;
}

}  // namespace talus
