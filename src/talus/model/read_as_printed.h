#pragma once
// What the equations of Zhao et al. 2016 as printed do not know (`model.formulation = "as_printed"`).

#include "talus/model/model.h"

namespace talus {

class Findings;

/// @pre  all sections of `model` have been read
void refuse_as_printed(const Model& model, Findings& findings);

}  // namespace talus
