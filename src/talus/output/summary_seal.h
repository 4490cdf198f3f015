#pragma once
// What summary.json says of itself and of the tables beside it, so that what was changed afterwards is known as such.

#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace talus {

/// Tables of a run whose size and digest stand in its summary.
inline constexpr std::array<const char*, 8> kMarkedTables{"histories.csv", "steps.csv",  "joints.csv",
                                                          "slips.csv",     "bolts.csv",  "blocks.csv",
                                                          "monitors.csv",  "spectra.csv"};

/// The text of summary.json, with a digest of all that stands before it.
std::string sealed_summary(nlohmann::ordered_json summary);

/// Why the summary, or a table beside it, is not what the run wrote; "" when all are, or it is of a talus that did not seal.
/// Throws FileError.
std::string seal_defect(const std::filesystem::path& folder, nlohmann::ordered_json summary);

}  // namespace talus
