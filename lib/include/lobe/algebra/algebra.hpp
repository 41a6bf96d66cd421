#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "lobe/core/progress.hpp"
#include "lobe/device/device.hpp"
#include "lobe/table/table.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// Options for compositions.
struct ComposeOptions {
  Precision precision =
      Precision::double_precision;  ///< arithmetic of the products; single: matrices of doubles, products in float
  /// Whether to refuse operands on different grids instead of bringing the second onto the grid of the first.
  bool exact_grid = false;
  /// Whether to accept a grid that does not resolve an operand retabulated on it; the result is marked.
  bool allow_unresolved = false;
  /// Whether to integrate over directions X that resolve the operands instead of the nodes of the grid, if both are
  /// formulas on a gauss or uniform grid. Values are then those of composition_at() at all nodes, whatever the grid,
  /// but operators no longer multiply exactly.
  bool resolve_formulas = false;
  /// Relative error to which the quadrature of resolve_formulas is refined, if it can be (relative_error()).
  double tolerance = 1e-5;
  /// Whether to estimate the quadrature error; without it the errors of the result are unknown (NaN).
  bool estimate_error = true;
  ProgressCallback progress = {};  ///< told of the progress; may cancel
};

/// The composition C_{f,g}(L,V) = integral of f(L,X) g(X,V) dmu(X) (Neumann 2001, eq. 1.21), which is the operator
/// product T_f T_g. Delta parts are composed exactly. If one operand is general, so is the result. A single channel
/// serves all channels of the other operand.
/// Discrete operators multiply exactly: products are associative and semi-symmetric, C_{f,g}(L,V) = C_{g,f}(V,L), the
/// latter bit for bit if f and g are symmetric.
/// \throws ArgumentError for grids or channels that do not fit; DeviceError; Cancelled
[[nodiscard]] BrdfTable compose(const Device& device, const BrdfTable& f, const BrdfTable& g,
                                const ComposeOptions& options = {});

/// Composes f with itself `times` times: T_f^(times+1).
/// \param times at least 1
/// \throws ArgumentError for 0 times; as compose()
[[nodiscard]] BrdfTable self_compose(const Device& device, const BrdfTable& f, unsigned times = 1,
                                     const ComposeOptions& options = {});

/// Peak memory of compose() in bytes, on host and device, beside its two operands; the result is included.
[[nodiscard]] std::uint64_t compose_bytes(const Device& device, const BrdfTable& f, const BrdfTable& g,
                                          const ComposeOptions& options = {});

/// The mixture sum of weight_k f_k. Tables on other grids than the first are resampled onto its grid, unless
/// exact_grid.
/// \throws ArgumentError if there are no tables, if the numbers of weights and tables differ, and for grids or channels
///   that do not fit
[[nodiscard]] BrdfTable mix(std::span<const double> weights, std::span<const BrdfTable> tables,
                            bool exact_grid = false);

/// Scales a table by a factor: values, their errors and delta parts.
/// \throws ArgumentError if the factor is not finite, or the table inconsistent
[[nodiscard]] BrdfTable scale(BrdfTable table, double factor);

/// Transposes a table to f(V, L), the adjoint operator.
/// \throws ArgumentError if the table is inconsistent
[[nodiscard]] BrdfTable transpose(const BrdfTable& table);

/// An inequality between the albedos of a composition and its factors, evaluated where it is closest to failing.
struct BoundCheck {
  std::string_view name;    ///< "albedo in (1.23)", "albedo out (1.23)" or "mean albedo (1.25)"
  std::size_t channel = 0;  ///< channel of the table, counted from 0
  double excess = 0;        ///< distance of the albedo from its bounds; below 0 it lies inside
  double error = 0;         ///< error of the albedo; NaN where unknown
  double theta = 0;         ///< angle at which it is evaluated, radians; NaN for means

  /// Whether the albedo is outside its bounds by more than its error. An unknown error proves nothing.
  [[nodiscard]] bool is_violated() const { return excess > error; }
};

/// Checks the bounds on a composition's albedos (Neumann 2001, eq. 1.23, for light and viewer, and 1.25), using
/// table.factors.
/// \param albedos albedos of the table
/// \return three checks per channel; none for a table that is not a composition
[[nodiscard]] std::vector<BoundCheck> check_bounds(const BrdfTable& table, const TableAlbedo& albedos);

}  // namespace lobe
