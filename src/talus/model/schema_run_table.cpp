// What a run does: solver, monitors, output.

#include "talus/model/schema_tables.h"
#include "talus/model/solver_kind.h"

namespace talus {

std::vector<SectionSpec> run_sections() {
  return {
      {"solver",
       SectionShape::kTable,
       "Solution of the contact constraint equations.",
       {{.name = "method",
         .type = K::kChoice,
         .default_text = "\"auto\"",
         .choices = {kSolverName.begin(), kSolverName.end()},
         .doc =
             "`newton`: semismooth, per island of touching blocks. `gauss_seidel`: projected, point by "
             "point, by all threads. `primal_newton`: semismooth in the velocities of the blocks, for large "
             "compressed masses whose joints have stiffness. `pivoting`: Lemke's method, for small models. `auto`: what is faster for the number of contact "
             "points (docs/performance.md has the table)."},
        {.name = "second_solver",
         .type = K::kBool,
         .default_text = "true",
         .doc =
             "A step that misses the tolerance is tried by another method (by `newton` up to 8000 contact "
             "points, by `primal_newton` where joints have stiffness and sweeps are slow, last by `pivoting` "
             "where it is small)."},
        {.name = "jacobian",
         .type = K::kChoice,
         .default_text = "\"analytic\"",
         .choices = {"analytic", "difference"},
         .doc = "Sparse analytic Jacobian, or the difference quotients of the paper (dense: small models "
                "only)."},
        {.name = "tolerance",
         .range = {.min = 0, .max = 1e-2, .min_open = true},
         .default_text = "1e-8",
         .doc = "Largest contact error of a step, as share of the size of the smallest block, or of a tenth "
                "of the median block's, where slivers are smaller than that: what all solvers aim at."},
        {.name = "limit",
         .range = {.min = 0, .max = 1e-2, .min_open = true},
         .default_text = "1e-5",
         .doc =
             "Largest contact error that a step may keep where no solver reaches the tolerance, as share of the same size; at least "
             "`tolerance`, which it is where none is given and that is larger. Such steps are loose: counted and told, with a warning where they are 1 % of all. Of the exact law "
             "(`contact.law`) alone."},
        {.name = "max_iterations",
         .type = K::kInteger,
         .range = {.min = 1, .max = 10000},
         .default_text = "60",
         .doc = "Most Newton iterations of a step."},
        {.name = "max_sweeps",
         .type = K::kInteger,
         .range = {.min = 1, .max = 1e7},
         .default_text = "20000",
         .doc = "Most Gauss-Seidel sweeps of a step."},
        {.name = "on_failure",
         .type = K::kChoice,
         .default_text = "\"stop\"",
         .choices = {"stop", "continue"},
         .doc =
             "A step whose error is above `limit` ends the run, or is counted and reported: then the run is not valid."}}},

      {"monitor",
       SectionShape::kList,
       "Columns of histories.csv. Give one of `point`, `centroid`, `convergence`, `crack`, `block`, `support`, `contact`, `bolt`. What each came to, stage by "
       "stage, is in monitors.csv and summary.json.",
       {{.name = "name",
         .type = K::kText,
         .required = true,
         .doc = "Unique name; first part of the column titles."},
        {.name = "point",
         .type = K::kVector,
         .dimension = D::kLength,
         .doc =
             "Displacement, velocity and acceleration of the material point that is here at the start. summary.json "
             "holds its peak velocity in dynamic stages (`monitors`). The acceleration is that of the point itself, also where "
             "the rest is relative; steps from rest have none."},
        {.name = "centroid",
         .type = K::kText,
         .refers_to = "block, grid or region",
         .doc =
             "The same of the centre of mass of a block or of all blocks of a group, and their rotation (mean by "
             "mass, counter-clockwise, since the start)."},
        {.name = "relative_to",
         .type = K::kText,
         .refers_to = "support, free-field boundary, block, grid or region",
         .doc =
             "With `point` or `centroid`: displacement and velocity less the mean ones of the points of a support or of "
             "the blocks of that name, or less those of a free field at the height of the point."},
        {.name = "relative_to_point",
         .type = K::kVector,
         .dimension = D::kLength,
         .doc = "With `point` or `centroid`: less those of the material point that is here at the start."},
        {.name = "relative_to_points",
         .type = K::kPoints,
         .dimension = D::kLength,
         .doc = "With `point` or `centroid`: less the mean of those of these material points [[x, y], ...]."},
        {.name = "convergence",
         .type = K::kPoints,
         .dimension = D::kLength,
         .doc =
             "Two points [[x0, y0], [x1, y1]]: by how much they have come nearer to each other, > 0 nearer."},
        {.name = "crack",
         .type = K::kPoints,
         .dimension = D::kLength,
         .doc =
             "Two points [[x0, y0], [x1, y1]] on either side of a crack: how far the second has moved from the first along the "
             "line between them at the start (opening), and to the left of it (sliding). Put them into the two blocks beside one joint, on a "
             "line across it: on a diagonal, opening and sliding mix once blocks have gone far."},
        {.name = "spectrum",
         .type = K::kBool,
         .default_text = "false",
         .doc =
             "With `point` or `centroid`: response spectra (damping 5 %, 0.02 to 5 s) of its acceleration in dynamic stages, in spectra.csv."},
        {.name = "block", .type = K::kText, .doc = "Cauchy stress of the block of this name."},
        {.name = "support",
         .type = K::kName,
         .refers_to = "support",
         .doc = "Reaction: force of this support on the blocks."},
        {.name = "contact",
         .type = K::kNames,
         .refers_to = "block, grid or region",
         .doc = "Contact force of the second on the first of two blocks or grids, and its impulse."},
        {.name = "bolt",
         .type = K::kName,
         .refers_to = "bolt",
         .doc = "Of a bolt or of a whole bolt_pattern: the largest tension and shear force, the largest "
                "elongation of a piece, and how many pieces have ruptured; of one bolt, before spacing."},
        {.name = "window",
         .dimension = D::kTime,
         .range = kNonNegative,
         .default_text = "\"0 s\"",
         .doc =
             "With `contact`: also the force as mean over a window of this length centred on each time."}}},

      {"output",
       SectionShape::kTable,
       "What is written, and how often.",
       {{.name = "history_interval",
         .dimension = D::kTime,
         .range = kNonNegative,
         .default_text = "\"0 s\"",
         .doc =
             "Spacing of the rows of histories.csv, from the beginning of each stage on, linear between the two steps about a row; 0: "
             "every step. Rows are no means: faster motion is aliased, impulses stay exact."},
        {.name = "steps_interval",
         .dimension = D::kTime,
         .range = kNonNegative,
         .default_text = "\"0 s\"",
         .doc = "Spacing of the rows of steps.csv (worst values since the row before); 0: every step."},
        {.name = "field_interval",
         .dimension = D::kTime,
         .range = kNonNegative,
         .default_text = "\"0 s\"",
         .doc = "Spacing of the ParaView frames; 0: only the start and the end of each stage."},
        {.name = "save_interval",
         .dimension = D::kTime,
         .range = kNonNegative,
         .default_text = "\"60 s\"",
         .doc = "Wall time between saved states, from which `talus run --from` goes on; the last two stay. "
                "0: only at the ends of stages."},
        {.name = "audit",
         .type = K::kBool,
         .default_text = "true",
         .doc =
             "Polygons, points and forces are audited in every step, at every frame and at the end of each "
             "stage; a run that is not valid ends with exit code 8. false: `valid` in summary.json is null."},
        {.name = "audit_interval",
         .dimension = D::kTime,
         .range = kNonNegative,
         .default_text = "\"0 s\"",
         .doc =
             "Spacing of audits of all polygons; 0: at every frame. Steps and the ends of stages are always "
             "audited."},
        {.name = "pictures",
         .type = K::kBool,
         .default_text = "true",
         .doc =
             "The blocks at the start and at the end as blocks_start.svg and blocks_end.svg. Thousands of short "
             "runs are quicker without."}}},

      {"safety",
       SectionShape::kTable,
       "How `talus safety` seeks what a model just bears. By strength: tan(friction angle), cohesion and tensile strength "
       "of joints, peak and residual, are divided by a factor F, that rises from 1 in the state in which the static stages "
       "before the first dynamic one have ended, rung by rung of a ladder (1, 1.1, 1.2 ... 2, 2.2 ... 4, 4.4 ...), each from "
       "rest to rest; behind the first rung that fails it is halved. What does not stand at 1 is run with its strength "
       "doubled (again and again), then lowered. By load, tilt or acceleration: the stages are run once without it, then it "
       "is raised from rest to rest, in a stage like the last of them: doubled (from 1/16 of the load, 1 degree, 1/64 of gravity) "
       "until something fails, from what stood before that by the same ladder, and halved behind its first rung that fails. Other verbs ignore it.",
       {{.name = "by",
         .type = K::kChoice,
         .default_text = "\"strength\"",
         .choices = {"strength", "load", "tilt", "acceleration"},
         .doc =
             "`strength`: factor of safety. `load`: factor on `load`. `tilt`: angle [deg] by which gravity is turned towards +x, as "
             "on a table that is tilted. `acceleration`: horizontal body "
             "force towards +x as share of the weight."},
        {.name = "load",
         .type = K::kName,
         .refers_to = "load",
         .doc = "With `by = \"load\"`: the load that is raised."},
        {.name = "from",
         .type = K::kChoice,
         .default_text = "\"rest\"",
         .choices = {"rest", "start"},
         .doc =
             "With `by = \"strength\"`. `rest`: strength is lowered where the stages have ended, with all their supports in. "
             "`start`: each trial runs the stages anew with its strength, and the factor is sought by halving between `lowest`, "
             "which must stand, and `highest`, which must fail: what is put in late does not help what has slid before."},
        {.name = "at",
         .type = K::kName,
         .refers_to = "stage",
         .doc =
             "The static stage in whose end the question is asked: supports and openings of later ones are not yet there. "
             "None: the last before the first dynamic one."},
        {.name = "lowest",
         .range = kPositive,
         .doc =
             "What fails at or below it, as the first rung that does, is told as below it, and sought no further. None: 0.5; tilt 1, "
             "acceleration 0.01. From `start`: what should stand, tried first."},
        {.name = "highest",
         .range = kPositive,
         .doc =
             "The last rung: what still stands there is told as above it. None: 4; tilt 60, acceleration 1. From `start`: what "
             "should fail, tried second; the answer may then depend on `lowest` and `highest` by some percent. Try two brackets."},
        {.name = "tolerance",
         .range = {.min = 1e-6, .max = 10},
         .doc =
             "Difference of the last that stands and the first that fails at which the search ends. None: 0.01; tilt 0.05, acceleration 0.001."},
        {.name = "displacement_limit",
         .type = K::kQuantityAuto,
         .dimension = D::kLength,
         .range = kPositive,
         .default_text = "\"auto\"",
         .doc =
             "A trial has failed when some block has moved this far since strength was first lowered or anything raised, and from "
             "`start` since the start of a stage. \"auto\": a tenth of its own size (the square root of its area), and at least of the "
             "median block's but no more than half its own, if it still moves. Needles (below 1e-4 of "
             "the median block's area or 0.002 of its thickness) do not vote then."},
        {.name = "accept_merged",
         .type = K::kBool,
         .default_text = "false",
         .doc = "Whether to seek the factor of a model in which slivers were merged or deleted "
                "(`cut.slivers`), which may hide the block that fails."},
        {.name = "joints",
         .type = K::kTexts,
         .doc = "Names of the joints whose strength is reduced; none: all but bonded ones."}}},
  };
}

}  // namespace talus
