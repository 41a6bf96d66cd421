#pragma once

#include <string>
#include <vector>

#include "lobe/table.hpp"

namespace lobe::cli {

/// An inequality between the albedos of a composition and those of its factors, judged where it is closest to failing.
struct BoundCheck {
  std::string name;  ///< "albedo in (1.23)"
  std::size_t channel = 0;
  double excess = 0;     ///< how far the albedo is outside its bounds; below 0: inside
  double error = 0;      ///< error bar of the albedo; NaN where unknown
  double theta_deg = 0;  ///< where; NaN for means

  /// Outside the bounds by more than the error bar. An unknown error bar proves nothing.
  [[nodiscard]] bool is_violated() const { return excess > error; }
};

/// Checks the bounds of a composition's albedos (Neumann 2001, eq. 1.23, for light and viewer, and 1.25).
/// \param albedo that of the table
/// \return three checks per channel; none for a table that is no composition
[[nodiscard]] std::vector<BoundCheck> check_bounds(const BrdfTable& table, const TableAlbedo& albedo);

/// "hold", "violated by 0.01 at 30.0° (error bar 0.002)".
[[nodiscard]] std::string bound_text(const BoundCheck& check);

}  // namespace lobe::cli
