#pragma once
// One column of a file as a history over time, for `file` and `column` of [history.NAME] in a model.

#include <filesystem>
#include <string>
#include <vector>

namespace talus::record {

struct HistoryColumn {
  std::vector<double> time;   // [s] rising
  std::vector<double> value;  // SI
  std::string title;          // of the column
};

/// Reads a column from the text of a file. A table (CSV with titles) needs a column of time, whose steps may
/// be uneven; records of the other formats (PEER, K-NET, JMA) are read as talus record reads them. Units come
/// from the title: those of motion (units.h), "rad", "rad/s", "-", and the SI units N, Pa. Throws InputError
/// (file:line) as read_record() does.
/// @param column  title, title without unit, or quantity ("acceleration"); "": the only one beside the time
HistoryColumn read_history_text(const std::string& file, const std::string& text, const std::string& column);

}  // namespace talus::record
