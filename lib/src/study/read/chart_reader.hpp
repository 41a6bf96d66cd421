#pragma once

#include "lobe/study/chart.hpp"
#include "study/read/toml_reader.hpp"

namespace lobe {

/// Reads a [[chart]] table of a study file.
/// \throws ArgumentError "FILE:LINE:COLUMN: ..." for anything wrong.
[[nodiscard]] Chart read_chart(const toml::table& table);

}  // namespace lobe
