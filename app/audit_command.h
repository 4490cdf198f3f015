#pragma once
// `talus audit`: are the forces of a run what its polygons say?

#include <string>

namespace talus::app {

/// Exit code: 0 valid, also with warnings; 8 not valid.
int audit_command(const std::string& folder, int threads);

}  // namespace talus::app
