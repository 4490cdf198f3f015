#include "help.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>

namespace talus::app {

namespace {

constexpr size_t kShort = 36;  // characters of choices beside the name; longer ones go into the text

// CLI11 writes types as "TEXT", "FLOAT:NONNEGATIVE", "INT:INT in [0 - 1024]", "TEXT:{s,ms}".
std::string range_of(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const size_t at = type.find(" in ["), end = type.rfind(']');
  if (at != std::string::npos && end != std::string::npos) {
    std::string range = type.substr(at + 5, end - at - 5);
    if (const size_t dash = range.find(" - "); dash != std::string::npos) range.replace(dash, 3, " to ");
    return range;
  }
  if (type.find("NONNEGATIVE") != std::string::npos) return "0 or more";
  if (type.find("POSITIVE") != std::string::npos) return "above 0";
  return "";
}

// What stands for the value: a word of the option's own name.
std::string word_of(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  if (type.rfind("FLOAT", 0) == 0) return "NUMBER";
  if (type.rfind("INT", 0) == 0 || type.rfind("UINT", 0) == 0) return "COUNT";
  if (option.get_lnames().empty()) return "TEXT";
  std::string word = option.get_lnames().back();
  if (const size_t dash = word.rfind('-'); dash != std::string::npos) word = word.substr(dash + 1);
  std::transform(word.begin(), word.end(), word.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return word;
}

bool is_positional(const CLI::Option& option) {
  return option.get_lnames().empty() && option.get_snames().empty();
}

CLI::Validator number_that(bool (*fits)(double), const char* must, const char* type) {
  return CLI::Validator(
      [fits, must](std::string& text) {
        double value = 0;
        if (!CLI::detail::lexical_cast(text, value)) return fmt::format("\"{}\" is not a number", text);
        return fits(value) ? std::string() : fmt::format("{} must be {}", text, must);
      },
      type);
}

}  // namespace

CLI::Validator not_negative() {
  return number_that([](double v) { return v >= 0; }, "0 or more", "NONNEGATIVE");
}

CLI::Validator above_zero() {
  return number_that([](double v) { return v > 0; }, "above 0", "POSITIVE");
}

std::vector<std::string> choices_of(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const size_t begin = type.find(":{"), end = type.rfind('}');
  std::vector<std::string> out;
  if (begin == std::string::npos || end == std::string::npos) return out;
  std::string word;
  for (const char c : type.substr(begin + 2, end - begin - 2) + ",") {
    if (c != ',') {
      word += c;
      continue;
    }
    out.push_back(word);
    word.clear();
  }
  return out;
}

std::string HelpFormatter::make_option_opts(const CLI::Option* option) const {
  if (option->get_type_size() == 0) return "";
  std::string out;
  if (!is_positional(*option)) {
    const std::string choices = fmt::format("{}", fmt::join(choices_of(*option), "|"));
    const std::string word = choices.empty() || choices.size() > kShort ? word_of(*option) : choices;
    const bool any_number = option->get_expected_max() == CLI::detail::expected_max_vector_size;
    for (int k = 0; k < (any_number ? 1 : option->get_expected_min()); ++k) out += " " + word;
  }
  return out + (option->get_expected_max() == CLI::detail::expected_max_vector_size ? " ..." : "");
}

std::string HelpFormatter::make_option_desc(const CLI::Option* option) const {
  const std::vector<std::string> choices = choices_of(*option);
  const bool long_list = fmt::format("{}", fmt::join(choices, "|")).size() > kShort;
  const bool untold = is_positional(*option) && !choices.empty() &&
                      option->get_description().find(choices.front()) == std::string::npos;
  std::vector<std::string> more;
  if (long_list || untold) more.push_back(fmt::format("one of {}", fmt::join(choices, ", ")));
  if (const std::string range = range_of(*option); !range.empty()) more.push_back(range);
  if (!option->get_default_str().empty()) more.push_back("default " + option->get_default_str());
  if (option->get_required()) more.emplace_back("required");
  return more.empty() ? option->get_description()
                      : fmt::format("{} ({})", option->get_description(), fmt::join(more, "; "));
}

}  // namespace talus::app
