#pragma once
// Help on options in words: what a value is, what it may be, what it is without.

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace talus::app {

/// Checks of numbers that say in words what is wrong.
CLI::Validator not_negative();
CLI::Validator above_zero();

/// What an option may be, where it is one of some words; else none.
std::vector<std::string> choices_of(const CLI::Option& option);

/// "--time-unit s|ms", "--frames COUNT": no names of types, ranges and defaults in the text.
class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_option_opts(const CLI::Option* option) const override;
  std::string make_option_desc(const CLI::Option* option) const override;
};

}  // namespace talus::app
