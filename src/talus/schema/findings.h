#pragma once
// What is wrong or doubtful in a model file: collected while it is read and checked, shown all at once.

#include <string>
#include <string_view>
#include <vector>

#include "talus/base/index.h"

namespace talus {

/// Where a key or value stands in the model file. line 0: not in the file (a default, or given by --set).
struct Where {
  int line = 0, column = 0;
  std::string override_text;  // "--set a.b=c" when the value came from there
};

enum class Severity { kError, kWarning };

struct Finding {
  Severity severity = Severity::kError;
  Where where;
  std::string key;   // dotted path, may be empty
  std::string text;  // what was found and what is allowed
  std::string hint;  // a next move, may be empty
};

class Findings {
 public:
  /// @param file  name shown in messages
  /// @param text  the whole file, from which lines are quoted
  Findings(std::string file, std::string_view text);

  void error(const Where& where, const std::string& key, const std::string& text,
             const std::string& hint = "");
  void warning(const Where& where, const std::string& key, const std::string& text,
               const std::string& hint = "");

  int error_count() const;
  int warning_count() const { return count_of(list_) - error_count(); }
  /// More than anyone reads: what takes time to find out for each is left out from here on.
  bool many() const { return list_.size() > 1000; }
  bool has_errors() const { return error_count() > 0; }
  const std::vector<Finding>& list() const { return list_; }

  /// All findings in the order of the file: "file:line:col: error: key: text", the line with a caret, the
  /// hint.
  std::string render() const;

  /// Throws InputError with render() when there is an error.
  void throw_if_errors() const;
  /// The same of warnings, too.
  void throw_if_any() const;

 private:
  std::string file_;
  std::vector<std::string> lines_;
  std::vector<Finding> list_;
};

}  // namespace talus
