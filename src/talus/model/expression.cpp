#include "talus/model/expression.h"

#include <fmt/format.h>
#include <muParser.h>

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
