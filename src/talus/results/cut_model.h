#pragma once
// A model cut into blocks for its own sake: what `talus cut` tells and writes.

#include <string>
#include <vector>

#include "talus/cut/layout.h"
#include "talus/maps/expand.h"
#include "talus/output/result_folder.h"

namespace talus {

struct CutModel {
  maps::ExpandedModel expanded;
  Model model;
  Cut cut;
  Layout layout;
  std::string summary, report;  // cut.json, report.txt
};

/// Reads the maps of a model, reads and checks it, and cuts its regions; a blocks file that it names is not read.
/// @param findings  out: of the text, and, where that has no error, of the text without maps; also when it throws
/// Throws InputError with all findings, FileError of the maps.
CutModel cut_model(const std::string& file, const std::string& text,
                   const std::vector<std::string>& overrides, std::vector<Findings>& findings);

/// cut.json, model.toml, blocks.json, blocks.csv, slivers.csv, report.txt and pictures: the cut, and with maps these
/// before and after cleaning.
void write_cut(const CutModel& cut, ResultFolder& folder);

}  // namespace talus
