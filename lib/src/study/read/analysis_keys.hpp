#pragma once

#include "lobe/study/study.hpp"
#include "study/read/toml_reader.hpp"

namespace lobe {

/// Reads the keys of [study] that ask for more than distances under lightings, `comparison_metrics` and
/// `approximations`, where they are given.
/// \throws ArgumentError "FILE:LINE:COLUMN: ..." for anything wrong.
void read_analyses(const toml::table& table, Study& study);

}  // namespace lobe
