// What a run does: solver, stages, monitors, output.

#include "talus/model/schema_tables.h"

namespace talus {

std::vector<SectionSpec> run_sections() {
  return {
      {"solver",
       SectionShape::kTable,
       "Solution of the contact constraint equations.",
       {{.name = "method",
         .type = K::kChoice,
         .default_text = "\"auto\"",
         .choices = {"auto", "newton", "gauss_seidel"},
         .doc = "`newton`: semismooth, per island of touching blocks. `gauss_seidel`: projected, point by "
                "point, by all threads. `auto`: what is faster for the number of contact points "
                "(docs/performance.md has the table)."},
        {.name = "second_solver",
         .type = K::kBool,
         .default_text = "true",
         .doc = "A step that misses the tolerance is tried by the other method (by Newton up to 8000 contact "
                "points)."},
        {.name = "jacobian",
         .type = K::kChoice,
         .default_text = "\"analytic\"",
         .choices = {"analytic", "difference"},
         .doc = "Sparse analytic Jacobian, or the difference quotients of the paper (dense: small models "
                "only)."},
        {.name = "tolerance",
         .range = {.min = 0, .max = 1e-2, .min_open = true},
         .default_text = "1e-8",
         .doc = "Largest contact error of a step, as share of the smallest block's size."},
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
         .doc = "A step that misses the tolerance ends the run, or is counted and reported."}}},

      {"stage",
       SectionShape::kList,
       "Stages in the order they run.",
       {{.name = "name", .type = K::kText, .required = true, .doc = "Unique name."},
        {.name = "kind",
         .type = K::kChoice,
         .required = true,
         .choices = {"static", "dynamic"},
         .doc = "`dynamic`: in true time for `duration`. `static`: damped until at rest, at most for "
                "`duration`."},
        {.name = "duration",
         .dimension = D::kTime,
         .range = kPositive,
         .required = true,
         .doc = "Length; for a static stage the limit after which the run stops with an error."},
        {.name = "time_step",
         .type = K::kQuantityAuto,
         .dimension = D::kTime,
         .range = kPositive,
         .default_text = "\"auto\"",
         .doc = "Time step, rounded down so that the stage ends on a step. \"auto\": `safety` times the "
                "stable limit "
                "of the stiffest block."},
        {.name = "safety",
         .range = {.min = 0, .max = 1, .min_open = true, .max_open = true},
         .default_text = "0.8",
         .doc = "With \"auto\": share of the stable limit."},
        {.name = "elasticity",
         .type = K::kChoice,
         .default_text = "\"explicit\"",
         .choices = {"explicit", "implicit"},
         .doc =
             "`explicit`: central differences, with a stable limit. `implicit`: each block's own elasticity "
             "is part of its mass matrix (theory 4.9), so that no block limits the time step; \"auto\" is "
             "then the time in which a wave crosses two blocks of median size."},
        {.name = "moment_clamp",
         .type = K::kBool,
         .default_text = "false",
         .doc =
             "With a given `time_step`: raise the moment of inertia of blocks too thin for it (counted and "
             "reported; refused where a block of median size would need it, and on masonry, whose bricks "
             "rock)."},
        {.name = "damping_mass",
         .dimension = D::kRate,
         .range = kNonNegative,
         .default_text = "\"0 1/s\"",
         .doc =
             "Mass-proportional damping: force = -damping_mass x mass x velocity. An oscillation of angular "
             "frequency w gets the damping ratio damping_mass / (2 w)."},
        {.name = "damping_stiffness",
         .dimension = D::kTime,
         .range = kNonNegative,
         .default_text = "\"0 s\"",
         .doc = "Stiffness-proportional damping: stress = damping_stiffness x elastic stiffness x strain "
                "rate, in "
                "blocks, not in joints. An oscillation of angular frequency w gets the damping ratio "
                "damping_stiffness x w / 2. It shortens the stable time step (`talus check` says by how "
                "much) unless "
                "`elasticity` is implicit."},
        {.name = "damping_local",
         .range = {.min = 0, .max = 1, .max_open = true},
         .doc = "Local damping: share of a block's unbalanced force that opposes its motion. Default 0.8 in "
                "static, "
                "0 in dynamic stages."},
        {.name = "unbalanced",
         .range = {.min = 0, .max = 0.1, .min_open = true},
         .default_text = "1e-5",
         .doc = "Static stages: at rest when the largest unbalanced force of a block, as share of the mean "
                "force on "
                "blocks, and the share of its peak velocity left are below this."}}},

      {"monitor",
       SectionShape::kList,
       "Columns of histories.csv. Give one of `point`, `block`, `support`, `contact`.",
       {{.name = "name",
         .type = K::kText,
         .required = true,
         .doc = "Unique name; first part of the column titles."},
        {.name = "point",
         .type = K::kVector,
         .dimension = D::kLength,
         .doc = "Displacement and velocity of the material point that is here at the start."},
        {.name = "block", .type = K::kText, .doc = "Cauchy stress of the block of this name."},
        {.name = "support",
         .type = K::kName,
         .refers_to = "support",
         .doc = "Reaction: force of this support on the blocks."},
        {.name = "contact",
         .type = K::kNames,
         .refers_to = "block, grid or region",
         .doc = "Contact force of the second on the first of two blocks or grids, and its impulse."},
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
         .doc = "Spacing of the rows of histories.csv; 0: every step. Rows are values of single steps, not "
                "means: faster motion is aliased, impulses stay exact."},
        {.name = "steps_interval",
         .dimension = D::kTime,
         .range = kNonNegative,
         .default_text = "\"0 s\"",
         .doc = "Spacing of the rows of steps.csv (worst values since the row before); 0: every step."},
        {.name = "field_interval",
         .dimension = D::kTime,
         .range = kNonNegative,
         .default_text = "\"0 s\"",
         .doc = "Spacing of the ParaView frames; 0: only the start and the end of each stage."}}},
  };
}

}  // namespace talus
