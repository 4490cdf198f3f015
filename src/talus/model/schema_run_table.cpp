// What a run does: solver, monitors, output.

#include "talus/model/schema_tables.h"
#include "talus/model/solver_kind.h"

namespace talus {

std::vector<SectionSpec> run_sections() {
  return {
      {"solver",
       SectionShape::kTable,
       "Solution of the contact constraint equations.",
       {key("method", Choices{{kSolverName.begin(), kSolverName.end()}}, to(&SolverInput::method),
            "`newton`: semismooth, per island of touching blocks. `gauss_seidel`: projected, point by "
            "point, by all threads. `primal_newton`: semismooth in the velocities of the blocks, for large "
            "compressed masses whose joints have stiffness. `pivoting`: Lemke's method, for small models. `auto`: what is faster for the number of contact "
            "points (docs/performance.md has the table)."),
        key("second_solver", K::kBool, to(&SolverInput::second_solver),
            "A step that misses the tolerance is tried by another method (by `newton` up to 8000 contact "
            "points, by `primal_newton` where joints have stiffness and sweeps are slow, last by `pivoting` "
            "where it is small)."),
        key("jacobian", Choices{{"analytic", "difference"}}, to(&SolverInput::jacobian),
            "Sparse analytic Jacobian, or the difference quotients of the paper (dense: small models "
            "only)."),
        key("tolerance", Range{.min = 0, .max = 1e-2, .min_open = true}, to(&SolverInput::tolerance),
            "Largest contact error of a step, as share of the size of the smallest block, or of a tenth "
            "of the median block's, where slivers are smaller than that: what all solvers aim at."),
        key("limit", Range{.min = 0, .max = 1e-2, .min_open = true}, Default{"1e-5"},
            "Largest contact error that a step may keep where no solver reaches the tolerance, as share of the same size; at least "
            "`tolerance`, which it is where none is given and that is larger. Such steps are loose: counted and told, with a warning where they are 1 % of all. Of the exact law "
            "(`contact.law`) alone."),
        key("max_iterations", K::kInteger, Range{.min = 1, .max = 10000}, to(&SolverInput::max_iterations),
            "Most Newton iterations of a step."),
        key("max_sweeps", K::kInteger, Range{.min = 1, .max = 1e7}, to(&SolverInput::max_sweeps),
            "Most Gauss-Seidel sweeps of a step."),
        key("on_failure", Choices{{"stop", "continue"}}, Default{"\"stop\""},
            "A step whose error is above `limit` ends the run, or is counted and reported: then the run is not valid.")}},

      {"monitor",
       SectionShape::kList,
       "Columns of histories.csv. Give one of `point`, `centroid`, `convergence`, `crack`, `block`, `support`, `contact`, `bolt`. What each came to, stage by "
       "stage, is in monitors.csv and summary.json.",
       {key("name", K::kText, kRequired, to(&MonitorInput::name),
            "Unique name; first part of the column titles."),
        key("point", K::kVector, D::kLength,
            "Displacement, velocity and acceleration of the material point that is here at the start. summary.json "
            "holds its peak velocity in dynamic stages (`monitors`). The acceleration is that of the point itself, also where "
            "the rest is relative; steps from rest have none."),
        key("centroid", K::kText, RefersTo{"block, grid or region"},
            "The same of the centre of mass of a block or of all blocks of a group, and their rotation (mean by "
            "mass, counter-clockwise, since the start)."),
        key("relative_to", K::kText, RefersTo{"support, free-field boundary, block, grid or region"},
            kNoDefault, to(&MonitorInput::relative_to),
            "With `point` or `centroid`: displacement and velocity less the mean ones of the points of a support or of "
            "the blocks of that name, or less those of a free field at the height of the point."),
        key("relative_to_point", K::kVector, D::kLength,
            "With `point` or `centroid`: less those of the material point that is here at the start."),
        key("relative_to_points", K::kPoints, D::kLength, kNoDefault, to(&MonitorInput::relative_to_points),
            "With `point` or `centroid`: less the mean of those of these material points [[x, y], ...]."),
        key("convergence", K::kPoints, D::kLength,
            "Two points [[x0, y0], [x1, y1]]: by how much they have come nearer to each other, > 0 nearer."),
        key("crack", K::kPoints, D::kLength,
            "Two points [[x0, y0], [x1, y1]] on either side of a crack: how far the second has moved from the first along the "
            "line between them at the start (opening), and to the left of it (sliding). Put them into the two blocks beside one joint, on a "
            "line across it: on a diagonal, opening and sliding mix once blocks have gone far."),
        key("spectrum", K::kBool, to(&MonitorInput::spectrum),
            "With `point` or `centroid`: response spectra (damping 5 %, 0.02 to 5 s) of its acceleration in dynamic stages, in spectra.csv."),
        key("block", K::kText, "Cauchy stress of the block of this name."),
        key("support", K::kName, RefersTo{"support"}, "Reaction: force of this support on the blocks."),
        key("contact", K::kNames, RefersTo{"block, grid or region"},
            "Contact force of the second on the first of two blocks or grids, and its impulse."),
        key("bolt", K::kName, RefersTo{"bolt"},
            "Of a bolt or of a whole bolt_pattern: the largest tension and shear force, the largest "
            "elongation of a piece, and how many pieces have ruptured; of one bolt, before spacing."),
        key("window", D::kTime, kNonNegative, to(&MonitorInput::window),
            "With `contact`: also the force as mean over a window of this length centred on each time.")}},

      {"output",
       SectionShape::kTable,
       "What is written, and how often.",
       {key("history_interval", D::kTime, kNonNegative, to(&OutputInput::history_interval),
            "Spacing of the rows of histories.csv, from the beginning of each stage on, linear between the two steps about a row; 0: "
            "every step. Rows are no means: faster motion is aliased, impulses stay exact."),
        key("steps_interval", D::kTime, kNonNegative, to(&OutputInput::steps_interval),
            "Spacing of the rows of steps.csv (worst values since the row before); 0: every step."),
        key("field_interval", D::kTime, kNonNegative, to(&OutputInput::field_interval),
            "Spacing of the ParaView frames; 0: only the start and the end of each stage."),
        key("save_interval", D::kTime, kNonNegative, to(&OutputInput::save_interval),
            "Wall time between saved states, from which `talus run --from` goes on; the last two stay. "
            "0: only at the ends of stages."),
        key("audit", K::kBool, to(&OutputInput::audit),
            "Polygons, points and forces are audited in every step, at every frame and at the end of each "
            "stage; a run that is not valid ends with exit code 8. false: `valid` in summary.json is null."),
        key("audit_interval", D::kTime, kNonNegative, to(&OutputInput::audit_interval),
            "Spacing of audits of all polygons; 0: at every frame. Steps and the ends of stages are always "
            "audited."),
        key("pictures", K::kBool, to(&OutputInput::pictures),
            "The blocks at the start and at the end as blocks_start.svg and blocks_end.svg. Thousands of short "
            "runs are quicker without.")}},

      {"safety",
       SectionShape::kTable,
       "How `talus safety` seeks what a model just bears. By strength: tan(friction angle), cohesion and tensile strength "
       "of joints, peak and residual, are divided by a factor F, that rises from 1 in the state in which the static stages "
       "before the first dynamic one have ended, rung by rung of a ladder (1, 1.1, 1.2 ... 2, 2.2 ... 4, 4.4 ...), each from "
       "rest to rest; behind the first rung that fails it is halved. What does not stand at 1 is run with its strength "
       "doubled (again and again), then lowered. By load, tilt or acceleration: the stages are run once without it, then it "
       "is raised from rest to rest, in a stage like the last of them: doubled (from 1/16 of the load, 1 degree, 1/64 of gravity) "
       "until something fails, from what stood before that by the same ladder, and halved behind its first rung that fails. Other verbs ignore it.",
       {key("by", Choices{{"strength", "load", "tilt", "acceleration"}}, to(&SafetyInput::by),
            "`strength`: factor of safety. `load`: factor on `load`. `tilt`: angle [deg] by which gravity is turned towards +x, as "
            "on a table that is tilted. `acceleration`: horizontal body "
            "force towards +x as share of the weight."),
        key("load", K::kName, RefersTo{"load"}, "With `by = \"load\"`: the load that is raised."),
        key("from", Choices{{"rest", "start"}}, to(&SafetyInput::from_start),
            "With `by = \"strength\"`. `rest`: strength is lowered where the stages have ended, with all their supports in. "
            "`start`: each trial runs the stages anew with its strength, and the factor is sought by halving between `lowest`, "
            "which must stand, and `highest`, which must fail: what is put in late does not help what has slid before."),
        key("at", K::kName, RefersTo{"stage"},
            "The static stage in whose end the question is asked: supports and openings of later ones are not yet there. "
            "None: the last before the first dynamic one."),
        key("lowest", kPositive,
            "What fails at or below it, as the first rung that does, is told as below it, and sought no further. None: 0.5; tilt 1, "
            "acceleration 0.01. From `start`: what should stand, tried first."),
        key("highest", kPositive,
            "The last rung: what still stands there is told as above it. None: 4; tilt 60, acceleration 1. From `start`: what "
            "should fail, tried second; the answer may then depend on `lowest` and `highest` by some percent. Try two brackets."),
        key("tolerance", Range{.min = 1e-6, .max = 10},
            "Difference of the last that stands and the first that fails at which the search ends. None: 0.01; tilt 0.05, acceleration 0.001."),
        key("displacement_limit", K::kQuantityAuto, D::kLength, kPositive, to(&SafetyInput::displacement),
            "A trial has failed when some block has moved this far since strength was first lowered or anything raised, and from "
            "`start` since the start of a stage. \"auto\": a tenth of its own size (the square root of its area), and at least of the "
            "median block's but no more than half its own, if it still moves. Needles (below 1e-4 of "
            "the median block's area or 0.002 of its thickness) do not vote then."),
        key("accept_merged", K::kBool, to(&SafetyInput::accept_merged),
            "Whether to seek the factor of a model in which slivers were merged or deleted "
            "(`cut.slivers`), which may hide the block that fails."),
        key("joints", K::kTexts,
            "Names of the joints whose strength is reduced; none: all but bonded ones.")}},
  };
}

}  // namespace talus
