#pragma once
// What a run answers, as numbers under names that formulas take: from its summary.json.

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "talus/study/study.h"

namespace talus::study {

using Numbers = std::map<std::string, double>;

/// Numbers of a summary: of each monitor in its last stage NAME.QUANTITY.at_start, .at_end, .least, .greatest, .largest
/// (of both the greater size), .residual, .time_of_least, .time_of_greatest; of stage S as S.NAME..., NAME.peak_velocity,
/// NAME.first_touch, NAME.last_touch; joints.*, moved.*, blocks.*, contacts.*, energy_closure, solver.*. What no formula
/// can name in a name stands as _.
Numbers numbers_of(const nlohmann::json& summary);

/// The same names with values of 1, of monitors with these columns ("top.displacement_x [m]") and these stages: whether a
/// formula can be read before anything is run.
/// @param sets  what edges were cut along
Numbers possible_numbers(const std::vector<std::string>& columns, const std::vector<std::string>& stages,
                         const std::vector<std::string>& sets = {});

/// Values of the answers of a study, each may name those before it. NaN where a number that it names is not there.
/// @param trouble  of the last one that could not be evaluated
std::vector<double> evaluate_answers(const Study& study, Numbers& numbers, std::string& trouble);

/// Units of answers that are one number alone, from a summary that has it; those that are known stay.
void add_units(const Study& study, const nlohmann::json& summary, std::vector<std::string>& units);

/// Whether the run is in a state of damage: 1, 0, or -1 where what it names is not finite or not there.
/// @param trouble  as above
int is_damaged(const DamageState& state, const Numbers& numbers, std::string& trouble);

/// Findings for answers and states of damage that name what there is not. @param numbers  that are possible
void check_formulas(const Study& study, Numbers numbers, Findings& findings);

}  // namespace talus::study
