#pragma once
// [history.NAME] given by `file` and `column`: a column of a CSV or a strong-motion record.

#include <string>

#include "talus/model/model.h"
#include "talus/schema/read_section.h"

namespace talus {

/// Fills time and value [SI] of `history` from the file; what is wrong with it becomes a finding at its key.
/// @param folder  that the path counts from
/// @return the content of the file, which belongs to the hash of the model; "" when it could not be read
std::string read_history_file(const Fields& fields, const std::string& folder, History& history,
                              Findings& findings);

}  // namespace talus
