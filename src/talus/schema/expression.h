#pragma once
// Formulas of model files, evaluated by muParser.

#include <map>
#include <set>
#include <string>
#include <vector>

namespace talus {

/// Values of a formula in `t` at the given times [s].
/// @param trouble  set to what is wrong with the formula, with its position, or to the first time at which
///                 its value is not finite; the result is then empty
std::vector<double> evaluate_expression(const std::string& formula, const std::vector<double>& times,
                                        std::string& trouble);

/// Names in a formula, of functions too: letters, digits, _ and dots, no digit first.
std::set<std::string> names_in_formula(const std::string& formula);

/// Value of a formula in named numbers. Names are letters, digits, _ and dots.
/// @param trouble  set to what is wrong with the formula, with its position, or that its value is not finite;
///                 the result is then NaN
double evaluate_with(const std::string& formula, const std::map<std::string, double>& values,
                     std::string& trouble);

}  // namespace talus
