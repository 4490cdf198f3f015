#include "talus/schema/expression.h"

#include <fmt/format.h>
#include <muParser.h>

#include <algorithm>
#include <cmath>

namespace talus {

std::vector<double> evaluate_expression(const std::string& formula, const std::vector<double>& times,
                                        std::string& trouble) {
  std::vector<double> values;
  try {
    double t = 0;
    mu::Parser parser;
    parser.DefineVar("t", &t);
    parser.SetExpr(formula);
    for (const double time : times) {
      t = time;
      values.push_back(parser.Eval());
      if (!std::isfinite(values.back())) {
        trouble = fmt::format("the formula is not finite at t = {:g} s", time);
        return {};
      }
    }
  } catch (const mu::Parser::exception_type& e) {
    trouble = fmt::format("the formula cannot be read: {} (at character {})", e.GetMsg(), e.GetPos() + 1);
    return {};
  }
  return values;
}

std::set<std::string> names_in_formula(const std::string& formula) {
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  const auto digit = [](char c) { return c >= '0' && c <= '9'; };
  std::set<std::string> names;
  for (size_t at = 0; at < formula.size();) {
    size_t end = at;
    if (letter(formula[at])) {
      while (end < formula.size() && (letter(formula[end]) || digit(formula[end]) || formula[end] == '.'))
        ++end;
      names.insert(formula.substr(at, end - at));
    } else {
      // 2e3 holds no name
      while (end < formula.size() &&
             (digit(formula[end]) || (end > at && (letter(formula[end]) || formula[end] == '.'))))
        ++end;
    }
    at = std::max(end, at + 1);
  }
  return names;
}

double evaluate_with(const std::string& formula, const std::map<std::string, double>& values,
                     std::string& trouble) {
  double value = std::nan("");
  try {
    mu::Parser parser;
    parser.DefineNameChars("0123456789_.abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ");
    for (const auto& [name, number] : values) parser.DefineConst(name, number);
    parser.SetExpr(formula);
    value = parser.Eval();
    if (!std::isfinite(value)) trouble = fmt::format("\"{}\" is not finite", formula);
  } catch (const mu::Parser::exception_type& e) {
    trouble = fmt::format("\"{}\" cannot be read: {} (at character {})", formula, e.GetMsg(), e.GetPos() + 1);
  }
  return trouble.empty() ? value : std::nan("");
}

}  // namespace talus
