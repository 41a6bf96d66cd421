#pragma once

namespace [[gnu::visibility("default")]] lobe {

/// The work that a table is made for, which limits how fine a grid may be that nobody asked for.
enum class TableUse {
  values,        ///< work that grows with the number of values: sums, repairs, products
  decomposition  ///< eigenvalues and solutions, which take far longer of general tables
};

}  // namespace lobe
