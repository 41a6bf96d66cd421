#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "lobe/device/device.hpp"
#include "lobe/hemisphere/grid.hpp"
#include "lobe/model/material.hpp"
#include "lobe/table/brdf_function.hpp"
#include "lobe/table/table.hpp"
#include "lobe/table/table_use.hpp"
#include "table/lobe_tabulator.hpp"

namespace lobe {

/// Whether a grid resolves several reflectances; else the first one found that it does not resolve.
struct GridVerdict {
  bool is_resolved = true;
  double error = 0;   ///< BrdfTable::resolution_error
  std::string worst;  ///< its name
};

/// Judges grids by what is to be tabulated on them.
class GridJudge {
 public:
  /// \param materials prepared
  /// \param functions have to live as long
  GridJudge(const Device& device, std::span<const Material> materials, std::span<const BrdfFunction> functions,
            const TabulateOptions& options);

  [[nodiscard]] GridVerdict verdict(const HemisphereGrid& grid) const;
  /// Whether all tables on product grids are isotropic.
  [[nodiscard]] bool is_isotropic() const;
  [[nodiscard]] bool has_functions() const { return !functions_.empty(); }

 private:
  std::vector<LobeTabulator> tabulators_;
  std::span<const BrdfFunction> functions_;
  double tolerance_;
  std::size_t cell_points_;
};

/// The public function of this name, of reflectances without grids of their own.
/// \param materials prepared
[[nodiscard]] HemisphereGrid resolving_grid(const Device& device, std::span<const Material> materials,
                                            std::span<const BrdfFunction> functions, const HemisphereGrid& start,
                                            TableUse use, const TabulateOptions& options);

/// The next one of the series gauss:8x16, 12x24, 16x32, 24x48 ...
[[nodiscard]] HemisphereGrid next_gauss(const HemisphereGrid& grid);

}  // namespace lobe
