#pragma once

#include <vector>

#include "lobe/study/published.hpp"
#include "study/read/toml_reader.hpp"

namespace lobe {

/// Reads a [[published]] table of a study file: figures of one quantity, one per row, or a single one without rows.
/// \throws ArgumentError "FILE:LINE:COLUMN: ..." for anything wrong.
[[nodiscard]] std::vector<PublishedFigure> read_published(const toml::table& table);

}  // namespace lobe
