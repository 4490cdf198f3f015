#pragma once
// What summary.json says of itself and of the tables beside it, so that what was changed afterwards is known as such.

#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace talus {

/// Files of a run whose size and digest stand in its summary: its tables, and the model.
inline constexpr std::array<const char*, 9> kMarkedFiles{"model.toml", "histories.csv", "steps.csv",
                                                         "joints.csv", "slips.csv",     "bolts.csv",
                                                         "blocks.csv", "monitors.csv",  "spectra.csv"};

/// The text of summary.json, with a digest of all that stands before it.
std::string sealed_summary(nlohmann::ordered_json summary);

/// Whether the summary is what a run wrote when it ended.
bool is_sealed(nlohmann::ordered_json summary);

/// Why the summary, or a file that it marks, is not what the run wrote; "" when all are, or it has no seal: of a run that
/// has not ended, or an older talus. Throws FileError.
std::string seal_defect(const std::filesystem::path& folder, const nlohmann::ordered_json& summary);

}  // namespace talus
