#pragma once
// One column of a file as a history over time, for `file` and `column` of [history.NAME] in a model.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace talus::record {

struct HistoryColumn {
  std::vector<double> time;   // [s] rising
  std::vector<double> value;  // SI
  std::string title;          // of the column
};

/// What a model says of a file that does not say it itself.
struct Bare {
  std::optional<double> dt;  // [s] of values without times
  std::string unit;          // of values whose title names none
};

/// Reads a column from the text of a file. A table (CSV with titles) needs a column of time, whose steps may
/// be uneven; records of the other formats (PEER, K-NET, JMA) are read as talus record reads them. Units come
/// from the title: those of motion (units.h), "rad", "rad/s", "-", and the SI units N, Pa. Throws InputError
/// (file:line) as read_record() does.
/// @param column  title, title without unit, or quantity ("acceleration"); "": the only one beside the time
/// @param bare    with a step: a file of values alone
HistoryColumn read_history_text(const std::string& file, const std::string& text, const std::string& column,
                                const Bare& bare = {});

}  // namespace talus::record
