#pragma once

#include <optional>
#include <vector>

#include "lobe/core/estimate.hpp"
#include "lobe/core/progress.hpp"
#include "lobe/table/least_value.hpp"
#include "lobe/table/table.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// How an equation between tables is solved.
struct SolveOptions {
  /// Weight of |X| in |F o X - G|^2 + lambda^2 |X|^2; none: chosen, see Regularisation.
  std::optional<double> lambda;
  bool exact_grid = false;         ///< refuse tables on different grids instead of interpolating the second
  ProgressCallback progress = {};  ///< told of the progress; may cancel
};

/// How lambda was chosen.
enum class Regularisation {
  given,
  none,             ///< 0: what the errors of F and G make of X is below a tenth of X
  discrepancy,      ///< |F o X - G| is as large as the stated errors of F and G let it be (Morozov 1966)
  cross_validation  ///< least generalised cross validation (Golub, Heath, Wahba 1979): errors are not known
};

/// What is known of the solution in one channel.
struct ChannelSolution {
  Regularisation regularisation = Regularisation::none;  ///< how lambda was chosen
  double lambda = 0;                                     ///< the weight that was taken
  double discrepancy = 0;                                ///< |F o X - G|, Hilbert-Schmidt
  double relative_discrepancy = 0;                       ///< over |G|; NaN with delta parts, whose norm is infinite
  double expected_discrepancy = 0;                       ///< what the stated errors of F and G allow; NaN where unknown
  double norm = 0;                                       ///< |X|, Hilbert-Schmidt, of the smooth part
  double condition = 0;                                  ///< largest over smallest singular value of F on this grid
  double amplification = 0;                              ///< largest |change of X| / |change of G|
  std::size_t kept = 0;                                  ///< singular values of F above lambda, with multiplicity
  std::size_t components = 0;                            ///< all of them
  PlacedValue least_value;                               ///< of X
};

/// A solution and what is known of it.
struct Solution {
  BrdfTable table;                        ///< X
  std::vector<ChannelSolution> channels;  ///< one per channel of the table
};

/// The X of least |F o X - G|^2 + lambda^2 |X|^2 (Tikhonov 1963): which reflectance composed with F gives G? Singular
/// values are taken apart by azimuthal order for isotropic tables. Compositions of discrete operators are exact, so a
/// G that was composed on this grid is recovered to rounding where F is well conditioned and lambda = 0; what F does
/// not let through (singular values below rounding) is left out of X.
///
/// X need be neither reciprocal nor positive. Errors of its values are unknown (NaN): they are those of G times up to
/// `amplification`, and beyond the loss by regularisation, which nothing in F and G tells.
/// \throws ArgumentError for grids or channels that do not fit and for lambda < 0; NumericError where G has delta parts
///   that no X gives, and where F or G is zero; Cancelled.
[[nodiscard]] Solution solve(const BrdfTable& f, const BrdfTable& g, const SolveOptions& options = {});

}  // namespace lobe
