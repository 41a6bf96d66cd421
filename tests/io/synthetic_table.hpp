#pragma once

#include "lobe/table/table.hpp"

namespace lobe::test {

/// A table by a formula, with a lobe about the mirror direction; its errors are 1e-9, those of the first ring unknown.
[[nodiscard]] BrdfTable synthetic_table(const HemisphereGrid& grid, TableForm form, std::size_t channels = 1);

/// The same with everything a table can have.
[[nodiscard]] BrdfTable synthetic_composition(const HemisphereGrid& grid, TableForm form, std::size_t channels = 1);

}  // namespace lobe::test
