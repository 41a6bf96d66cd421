#pragma once

#include <string>

namespace [[gnu::visibility("default")]] lobe {

/// A JSON Schema (draft 7) of study files: the keys of every table, what values they take, the models of the catalogue
/// with their parameters, ranges and defaults. Editors complete and check by it what names it in a first line
/// "#:schema PATH". It is made from the tables that load_study() reads by. What it accepts may still be refused: it
/// does not compare values with each other, such as the lengths of rows and columns.
[[nodiscard]] std::string study_schema();

}  // namespace lobe
