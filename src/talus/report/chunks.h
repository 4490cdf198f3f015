#pragma once
// Where the page keeps its data: texts in elements of their own, which an index names by number. Not for use outside
// report/.

#include <fmt/format.h>

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace talus::report {

/// Data as elements of the page; others name them by number.
class Chunks {
 public:
  int add(const std::string& text) {
    html_ += fmt::format("<script type=\"text/plain\" id=\"talus-{}\">{}</script>\n", count_, text);
    return count_++;
  }
  const std::string& html() const { return html_; }

 private:
  std::string html_;
  int count_ = 0;
};

/// What the page has to know of results in general: columns, quantities, names and colours.
nlohmann::ordered_json words_of_results();

/// The page with its data and their index in place. Throws FileError when it has no place for them.
std::string filled_page(const std::string& page, const Chunks& chunks, const nlohmann::ordered_json& index);

}  // namespace talus::report
