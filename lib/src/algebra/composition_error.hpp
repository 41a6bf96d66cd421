#pragma once

#include <cstdint>
#include <vector>

#include "lobe/algebra/algebra.hpp"

namespace lobe {

/// Bounds on the errors of a composition, as BrdfTable has them, [channel][ring_in][ring_out].
struct CompositionErrors {
  std::vector<double> largest;  ///< over azimuth
  std::vector<double> even;     ///< even_error; empty where nothing tells it from the largest
  std::vector<double> odd;      ///< odd_part; empty with the former
};

/// Bounds on the error of a composition's values: that of its quadrature over X, and what the operands' errors make of
/// it.
///
/// Where the formulas of the operands are known, the quadrature is repeated with more than twice the resolution of X at
/// the same L and V (for some rings where the table is large) and the difference times a safety factor taken. Else, on
/// gauss grids, what the differences from rules of every second and of every fourth ring and azimuth leave to expect;
/// of general tables at a few L per ring. Else unknown: NaN.
/// \param f the first operand, of the grid, form and number of channels of g
/// \param product values of the product of their smooth parts
[[nodiscard]] CompositionErrors composition_error(const Device& device, const BrdfTable& f, const BrdfTable& g,
                                                  const TableValues& product, Precision precision);

/// Errors of the product caused by the operands' errors and rounding, whatever its quadrature:
/// [channel][ring_in][ring_out].
[[nodiscard]] std::vector<double> propagated_error(const BrdfTable& f, const BrdfTable& g, Precision precision);

/// Bytes that the estimate takes at its peak.
[[nodiscard]] std::uint64_t composition_error_bytes(const Device& device, const BrdfTable& f, const BrdfTable& g,
                                                    Precision precision);

}  // namespace lobe
