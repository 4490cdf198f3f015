#pragma once
// Promises that a set of rows keeps whatever the model is: only our own mistakes break them.

#include "talus/rows/rows.h"

namespace talus {

/// Throws std::logic_error naming the row and what is wrong with it: an owner out of the order of families, a
/// block that is not there, a normal that is no unit vector, bounds or compliance below nothing, a partner
/// that is none. Numbers that are not finite pass: they come of motions that are not, and the run tells so.
/// @param blocks  how many there are
void validate(const RowSet& rows, int blocks);

}  // namespace talus
