#pragma once
// [variables] of the model file, and what stands for them in its texts: "$name" and "$(expression)".

#include "talus/schema/toml_source.h"

namespace talus {

/// parse_toml(), with the values of its variables in their places.
TomlSource read_toml(const std::string& text, const std::vector<std::string>& overrides, Findings& findings,
                     const Schema& schema = {});

/// Puts values where texts outside of [variables] hold "$name" or "$(expression)"; "$$" is a dollar sign. A text that is
/// nothing else becomes the value itself, of any type; within other text its digits are written. In expressions
/// quantities count in SI (angles in rad). Variables may stand on others.
/// Errors: a name that is no variable, variables that stand on each other in a ring, an expression that cannot be read
/// or whose value is not finite.
void put_variables(TomlSource& source, Findings& findings);

/// Warns of variables that no text uses; it is an error where one is given by --set.
void check_variables_used(const TomlSource& source, Findings& findings);

}  // namespace talus
