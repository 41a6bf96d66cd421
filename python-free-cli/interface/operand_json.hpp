#pragma once

#include "interface/operand.hpp"
#include "interface/report.hpp"

namespace lobe::cli {

/// Description of an operand: formulas with their values, remarks on a file, or the header of a table with its name.
[[nodiscard]] Json operand_json(const Operand& operand);

/// Adds what an operand is to an answer, as "material", "function" or "table".
void add_operand(Json& answer, const Operand& operand);

}  // namespace lobe::cli
