#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "lobe/core/progress.hpp"
#include "lobe/device/device.hpp"
#include "lobe/table/table.hpp"

namespace lobe {

/// How compositions are computed.
struct ComposeOptions {
  Precision precision =
      Precision::double_precision;  ///< of the products; single: matrices of doubles, products in float
  /// Refuse operands on different grids instead of bringing the second onto the grid of the first.
  bool exact_grid = false;
  /// Accept that the grid does not resolve an operand that is tabulated anew on it; the result is marked.
  bool allow_unresolved = false;
  /// Where both operands are formulas on a gauss or uniform grid: integrate over directions X that resolve them, not
  /// over the nodes of the grid. Values are then those of composition_at() at all nodes, whatever the grid; operators
  /// no longer multiply exactly.
  bool resolve_formulas = false;
  /// With resolve_formulas: the relative error that quadrature is refined to, if it can be (relative_error()).
  double tolerance = 1e-5;
  /// Estimate the quadrature error; without it the errors of the result are unknown (NaN).
  bool estimate_error = true;
  ProgressCallback progress = {};  ///< told of the progress; may cancel
};

/// The composition C_{f,g}(L,V) = integral of f(L,X) g(X,V) dmu(X) (Neumann 2001, eq. 1.21): the operator product
/// T_f T_g, with delta parts composed exactly. If one operand is general so is the result. A single channel serves all
/// channels of the other operand.
/// Discrete operators multiply exactly: products are associative and semi-symmetric, C_{f,g}(L,V) = C_{g,f}(V,L), the
/// latter bit for bit when f and g are symmetric.
/// \throws ArgumentError for grids or channels that do not fit; DeviceError; Cancelled.
[[nodiscard]] BrdfTable compose(const Device& device, const BrdfTable& f, const BrdfTable& g,
                                const ComposeOptions& options = {});

/// f composed with itself `times` times: T_f^(times+1).
/// \param times >= 1
[[nodiscard]] BrdfTable self_compose(const Device& device, const BrdfTable& f, unsigned times = 1,
                                     const ComposeOptions& options = {});

/// Bytes of host and device memory that compose() takes at its peak beside its two operands, the result included.
[[nodiscard]] std::uint64_t compose_bytes(const Device& device, const BrdfTable& f, const BrdfTable& g,
                                          const ComposeOptions& options = {});

/// Sum of weight_k f_k. Tables on other grids than the first are resampled onto its grid unless exact_grid.
/// \throws ArgumentError for no tables, other numbers of weights than tables, grids or channels that do not fit.
[[nodiscard]] BrdfTable mix(std::span<const double> weights, std::span<const BrdfTable> tables,
                            bool exact_grid = false);

/// f times a factor: values, their errors and delta parts.
[[nodiscard]] BrdfTable scale(BrdfTable table, double factor);

/// f(V, L): the adjoint operator.
[[nodiscard]] BrdfTable transpose(const BrdfTable& table);

/// An inequality between the albedos of a composition and those of its factors, judged where it is closest to failing.
struct BoundCheck {
  std::string_view name;    ///< "albedo in (1.23)", "albedo out (1.23)" or "mean albedo (1.25)"
  std::size_t channel = 0;  ///< channel of the table, from 0 on
  double excess = 0;        ///< how far the albedo is outside its bounds; below 0: inside
  double error = 0;         ///< error of the albedo; NaN where unknown
  double theta = 0;         ///< where, radians; NaN for means

  /// Outside the bounds by more than the error. An unknown error proves nothing.
  [[nodiscard]] bool is_violated() const { return excess > error; }
};

/// Checks the bounds of a composition's albedos (Neumann 2001, eq. 1.23, for light and viewer, and 1.25) against
/// table.factors.
/// \param albedos of the table
/// \return three checks per channel; none for a table that is no composition
[[nodiscard]] std::vector<BoundCheck> check_bounds(const BrdfTable& table, const TableAlbedo& albedos);

}  // namespace lobe
