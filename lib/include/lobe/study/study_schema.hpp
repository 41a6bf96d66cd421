#pragma once

#include <string>

namespace [[gnu::visibility("default")]] lobe {

/// Writes a JSON Schema (draft 7) for study files: the keys of every table, the values they take, and the catalogue's
/// models with their parameters, ranges and defaults. Editors use it to complete and check files that name it in a
/// first line "#:schema PATH". It is generated from the tables that load_study() reads by. lobe may refuse files that
/// the schema accepts: it does not compare values with each other, such as the lengths of rows and columns.
[[nodiscard]] std::string study_schema();

}  // namespace lobe
