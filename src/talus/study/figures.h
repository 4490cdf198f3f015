#pragma once
// What a study leaves to look at: tables, figures, and the page that shows them.

#include <filesystem>
#include <string>
#include <vector>

#include "talus/study/gather.h"

namespace talus::study {

/// Writes the figures, as SVG and PNG; gives their names without ending, in the order of the page.
std::vector<std::string> write_figures(const Study& study, const Gathered& found,
                                       const std::filesystem::path& folder);

/// study.html: results, figures, and a table whose rows open the runs.
std::string study_page(const Study& study, const Gathered& found, const std::vector<std::string>& figures);

/// Writes results.csv, fragility.csv, sensitivity.csv, figures/ and study.html into the folder.
void write_results(const Study& study, const Gathered& found, const StudyFolder& folder);

}  // namespace talus::study
