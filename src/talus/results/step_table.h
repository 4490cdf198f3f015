#pragma once
// The columns of steps.csv: contacts, solver and energy of each step.

#include "talus/output/columns.h"
#include "talus/run/instant.h"

namespace talus {

const Columns<Instant>& step_columns();

}  // namespace talus
