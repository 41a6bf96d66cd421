#pragma once

#include "interface/operand.hpp"
#include "interface/report.hpp"

namespace lobe::cli {

/// What an operand is: formulas with their values, what a file says, or the header of a table with its name.
[[nodiscard]] Json operand_json(const Operand& operand);

/// Adds what an operand is to an answer, as "material", "function" or "table".
void add_operand(Json& answer, const Operand& operand);

}  // namespace lobe::cli
