#include "interface/operand_json.hpp"

#include "interface/reading.hpp"
#include "interface/table_report.hpp"

namespace lobe::cli {

Json operand_json(const Operand& operand) {
  const Reflectance& shape = operand.shape();
  if (const BrdfFunction* function = shape.function()) return function_json(*function);
  if (const Material* formula = shape.formula()) return material_json(*formula);
  Json json{{"name", operand.label()}};
  json.update(header_json(*shape.table()));
  return json;
}

void add_operand(Json& answer, const Operand& operand) {
  const Reflectance& shape = operand.shape();
  if (const BrdfTable* table = shape.table()) {
    answer["table"] = header_json(*table);
  } else {
    answer[operand.is_formula() ? "material" : "function"] = operand_json(operand);
  }
}

}  // namespace lobe::cli
