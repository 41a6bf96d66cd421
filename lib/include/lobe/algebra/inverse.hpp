#pragma once

#include <optional>
#include <vector>

#include "lobe/core/estimate.hpp"
#include "lobe/core/progress.hpp"
#include "lobe/table/least_value.hpp"
#include "lobe/table/table.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// Options for solving an equation between tables.
struct SolveOptions {
  /// Weight lambda of |X| in |F o X - G|^2 + lambda^2 |X|^2; without it lambda is chosen, see Regularisation.
  std::optional<double> lambda;
  bool exact_grid = false;         ///< refuse tables on different grids instead of interpolating the second
  ProgressCallback progress = {};  ///< told of the progress; may cancel
};

/// Ways of choosing lambda.
enum class Regularisation {
  given,
  none,             ///< lambda = 0: the errors of F and G change X by less than a tenth of X
  discrepancy,      ///< |F o X - G| is as large as the stated errors of F and G allow (Morozov 1966)
  cross_validation  ///< least generalised cross validation (Golub, Heath, Wahba 1979), since errors are unknown
};

/// Properties of the solution in one channel.
struct ChannelSolution {
  Regularisation regularisation = Regularisation::none;  ///< how lambda was chosen
  double lambda = 0;                                     ///< weight that was used
  double discrepancy = 0;                                ///< |F o X - G|, Hilbert-Schmidt norm
  double relative_discrepancy = 0;  ///< discrepancy over |G|; NaN with delta parts, whose norm is infinite
  double expected_discrepancy = 0;  ///< discrepancy that the stated errors of F and G allow; NaN where unknown
  double norm = 0;                  ///< |X|, Hilbert-Schmidt norm of the smooth part
  double condition = 0;             ///< ratio of the largest to the smallest singular value of F on this grid
  double amplification = 0;         ///< largest |change of X| / |change of G|
  std::size_t kept = 0;             ///< number of singular values of F above lambda, with multiplicity
  std::size_t components = 0;       ///< number of all singular values
  PlacedValue least_value;          ///< least value of X
};

/// A solution and its properties.
struct Solution {
  BrdfTable table;                        ///< the solution X
  std::vector<ChannelSolution> channels;  ///< one per channel of the table
};

/// Solves F o X = G for a reflectance X: finds the X that minimises |F o X - G|^2 + lambda^2 |X|^2 (Tikhonov 1963). For
/// isotropic tables singular values are computed separately for each azimuthal order. Compositions of discrete
/// operators are exact, so a G composed on this grid is recovered to rounding if F is well conditioned and lambda = 0.
/// Components that F does not let through (singular values below rounding) are left out of X.
///
/// X need be neither reciprocal nor positive. The errors of its values bound, to first order, what the errors of F and
/// G change in the X for this lambda on this grid, `amplification` times as much in the norm of point light; NaN where
/// they are unknown. They leave out the loss by regularisation, about which F and G say nothing.
/// \throws ArgumentError for grids or channels that do not fit and for lambda < 0; NumericError if G has delta parts
///   that no X produces, and if F or G is zero; Cancelled
[[nodiscard]] Solution solve(const BrdfTable& f, const BrdfTable& g, const SolveOptions& options = {});

}  // namespace lobe
