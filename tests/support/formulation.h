#pragma once
// The verification cases by another formulation: TALUS_TEST_FORMULATION=penalty computes each model by it, and prints
// its comparisons, why a model is refused and why a run ends, for the column of `talus verify --formulation`.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cstdlib>
#include <exception>
#include <string>
#include <vector>

namespace talus::test {

/// The formulation asked for, "" when models are computed by their own.
inline std::string other_formulation() {
  const char* name = std::getenv("TALUS_TEST_FORMULATION");
  return name ? name : "";
}

inline const char* case_name() { return doctest::getContextOptions()->currentTest->m_name; }

/// The case that ran a model last. A comparison of a case that runs none says nothing of a formulation.
inline std::string& case_with_model() {
  static std::string name;
  return name;
}
inline bool says_something() { return other_formulation().empty() || case_with_model() == case_name(); }

/// Before a comparison, where two formulations are put side by side (TALUS_TEST_PAIRED=1): the case, and whether a model
/// was run in it.
inline void print_pair() {
  if (std::getenv("TALUS_TEST_PAIRED"))
    fmt::print("pair | {} | {}\n", case_name(), case_with_model() == case_name() ? "model" : "no model");
}

/// The first line of what is wrong, without its file.
inline void print_reason(const std::string& kind, std::string why) {
  why = why.substr(0, why.find('\n'));
  if (const size_t at = why.find("error: "); at != std::string::npos) why = why.substr(at + 7);
  fmt::print("{} | {} | {}\n", kind, case_name(), why);
  std::fflush(stdout);
}

/// Runs `model()`, by the formulation asked for among the overrides, and tells why it does not.
template <class Run>
auto by_formulation(std::vector<std::string>& overrides, const Run& model) {
  const std::string name = other_formulation();
  case_with_model() = case_name();
  if (name.empty()) return model();
  overrides.push_back("model.formulation=\"" + name + "\"");
  try {
    return model();
  } catch (const std::exception& e) {
    print_reason("not computed", e.what());
    throw;
  }
}

}  // namespace talus::test
