#include "talus/run/saved_state.h"

#include <fmt/format.h>

#include "talus/base/error.h"
#include "talus/base/version.h"

namespace talus {

namespace {

// A field that is added to one of these and not saved would be lost: whoever adds one comes by here.
static_assert(sizeof(Contact) == 104 && sizeof(ContactPair) == 192 && sizeof(FaceState) == 80 &&
                  sizeof(WorkDone) == 80 && sizeof(State) == 856 && sizeof(BoltNode) == 56 &&
                  sizeof(BoltSegment) == 72 && sizeof(BoltCrossing) == 120 && sizeof(Bolt) == 96,
              "a field was added: save it in exchange_state(), then correct the size here");

void exchange_contacts(Exchange& x, State& s) {
  x("state.candidates.displacement", s.candidates.displacement);
  x("state.candidates.strain_part", s.candidates.strain_part);
  x("state.candidates.skin", s.candidates.skin);
  x("state.candidates.reach", s.candidates.reach);
  x("state.candidates.neighbours.begin", s.candidates.neighbours.begin);
  x("state.candidates.neighbours.block", s.candidates.neighbours.block);
  x("state.candidates.rebuilds", s.candidates.rebuilds);
  x.each("state.pairs", s.pairs, [](auto& field, ContactPair& p) {
    field("a", p.a), field("b", p.b), field("begin", p.begin), field("count", p.count);
    field("face", p.face), field("from_start", p.from_start), field("shares_face", p.shares_face),
        field("reuse", p.reuse);
    field("margin", p.margin), field("arm", p.arm), field("turn", p.turn);
    field("cover_0", p.cover[0]), field("cover_1", p.cover[1]), field("cover_place", p.cover_place),
        field("cover_turn", p.cover_turn);
  });
  x.each("state.contacts", s.contacts, [](auto& field, Contact& c) {
    field("block_a", c.key.block_a), field("vertex", c.key.vertex);
    field("block_b", c.key.block_b), field("edge", c.key.edge);
    field("joint", c.joint), field("partner", c.partner), field("memory", c.memory);
    field("length", c.length), field("force", c.force), field("allowed", c.allowed), field("toes", c.toes);
    field("side_lo", c.face.side_lo), field("side_hi", c.face.side_hi), field("face_end", c.face.end);
    field("stretch", c.stretch), field("anchor", c.anchor);
    field("slip", c.slip), field("slip_signed", c.slip_signed), field("touched", c.touched);
  });
}

void exchange_bolts(Exchange& x, std::vector<Bolt>& bolts) {
  x.each("state.bolts", bolts, [](auto& field, Bolt& b) {
    field("input", b.input), field("anchored", b.anchored), field("share", b.share);
    field("rupture_strain", b.rupture_strain);
  });
  for (size_t i = 0; i < bolts.size(); ++i) {
    const std::string name = fmt::format("state.bolts.{}", i);
    x.each(name + ".nodes", bolts[i].nodes, [](auto& field, BoltNode& n) {
      field("block", n.block), field("arm", n.arm), field("stiffness", n.stiffness);
      field("limit", n.limit), field("plastic", n.plastic), field("slip", n.slip);
    });
    x.each(name + ".segments", bolts[i].segments, [](auto& field, BoltSegment& s) {
      field("length", s.length), field("stiffness", s.stiffness), field("gauge", s.gauge);
      field("yield", s.yield), field("start", s.start), field("plastic", s.plastic);
      field("stretch", s.stretch), field("force", s.force), field("crossing", s.crossing);
      field("yielded", s.yielded), field("ruptured", s.ruptured);
    });
    x.each(name + ".crossings", bolts[i].crossings, [](auto& field, BoltCrossing& c) {
      field("segment", c.segment), field("direction_a", c.direction[0]), field("direction_b", c.direction[1]),
          field("apart", c.apart);
      field("row_stiffness", c.row_stiffness), field("most", c.most);
      field("shear_stiffness", c.shear_stiffness), field("shear_yield", c.shear_yield);
      field("shear_plastic", c.shear_plastic), field("shear", c.shear), field("row", c.row);
    });
  }
}

void exchange_plan(auto& field, StagePlan& p) {
  field("dt", p.dt), field("plan_steps", p.steps), field("dt_bound", p.dt_bound);
  field("bound_block", p.bound_block), field("bound_column", p.bound_column);
  field("dt_undamped", p.dt_undamped), field("clamp_dt", p.clamp_dt);
  field("clamped", p.clamped), field("largest_clamp", p.largest_clamp);
}

}  // namespace

void exchange_state(Exchange& x, State& s) {
  x("state.time", s.time), x("state.step", s.step);
  x("state.history_time", s.history_time), x("state.dt_before", s.dt_before);
  x("state.displacement", s.displacement), x("state.strain_part", s.strain_part);
  x("state.angle", s.angle), x("state.rate", s.rate), x("state.contact_force", s.contact_force);
  x("state.bond_force", s.bond_force);
  x.each("state.face", s.face, [](auto& field, FaceState& f) {
    field("broken", f.broken), field("broken_step", f.broken_step);
    field("offset", f.offset), field("mean_force", f.mean_force), field("slip", f.slip);
  });
  x("state.support_force", s.support_force), x("state.support_hold", s.support_hold);
  x("state.boundary_force", s.boundary_force), x("state.boundary_static", s.boundary_static);
  x("state.boundary_hold", s.boundary_hold), x("state.tie_force", s.tie_force);
  x("state.column_displacement", s.column_displacement), x("state.column_rate", s.column_rate);
  exchange_bolts(x, s.bolts);
  exchange_contacts(x, s);
  x("state.initial_stress", s.initial_stress), x("state.kept_force", s.kept_force);
  x("state.relaxed", s.relaxed);
  x("state.displacement_start", s.displacement_start), x("state.strain_part_start", s.strain_part_start);
  x("state.work", s.work), x("state.energy_start", s.energy_start);
  x("state.largest_kinetic", s.largest_kinetic);
  x("state.rest.steps", s.rest.steps), x("state.rest.best", s.rest.best),
      x("state.rest.before", s.rest.before);
  x("state.rest.sharper", s.rest.sharper), x("state.rest.stuck", s.rest.stuck);
}

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
      saved.state.face.size() != fresh.face.size() ||
      saved.state.support_force.size() != fresh.support_force.size() ||
      saved.state.boundary_force.size() != fresh.boundary_force.size() ||
      saved.standing.result.stages.empty())
    throw InputError(fmt::format(
        "{}: error: the state does not fit the model, which this program cuts or supports otherwise ({} "
        "blocks now, {} then). Run the model anew\n",
        path.string(), fresh.displacement.size(), saved.state.displacement.size()));
  return saved;
}

}  // namespace talus
