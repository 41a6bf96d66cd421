#pragma once

#include <vector>

#include "lobe/core/estimate.hpp"
#include "lobe/core/progress.hpp"
#include "lobe/device/device.hpp"
#include "lobe/table/least_value.hpp"
#include "lobe/table/table.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// Options for a square root.
struct SquareRootOptions {
  /// Eigenvalues down to -tolerance * |T| count as zero; in [0, 1).
  double tolerance = 1e-10;
  ProgressCallback progress = {};  ///< told of the progress; may cancel
};

/// Whether an operator is positive semi-definite.
enum class Definiteness {
  semi_definite,  ///< no eigenvalue below -tolerance * |T|
  indefinite,     ///< some eigenvalue is negative by more than its error
  undecided       ///< some eigenvalues are negative, all within their errors
};

/// Properties of one channel and its root.
struct ChannelRoot {
  Definiteness definiteness = Definiteness::semi_definite;  ///< whether the reciprocal part has a root at all
  Estimate norm;                                            ///< |T| in L^2
  Estimate smallest;                                        ///< smallest eigenvalue of the reciprocal part
  /// Hilbert-Schmidt norm of half of T less its adjoint; 0 if T is reciprocal within its errors
  Estimate skew;
  Estimate distance;                ///< Hilbert-Schmidt distance of T to the nearest self-composition
  Estimate relative_distance;       ///< distance over the norm of T; NaN with delta parts, whose norm is infinite
  PlacedValue least_value;          ///< least value of the root
  Estimate largest_albedo;          ///< largest albedo of the root
  double largest_albedo_theta = 0;  ///< angle of that albedo, radians
};

/// A root and its properties.
struct SquareRoot {
  BrdfTable table;                    ///< the root
  std::vector<ChannelRoot> channels;  ///< one per channel of the table
};

/// Computes the self-adjoint X >= 0 with X o X = T if T >= 0. Otherwise X o X is the operator nearest to T in the
/// Hilbert-Schmidt norm that has such a root: T without the negative part of its spectrum, and of a T that is not
/// reciprocal its reciprocal part, half of T and of its adjoint, without that (Higham 1988). The root is
/// reciprocal; its least value and its largest albedo tell whether it is a reflectance.
///
/// Delta parts have exact roots: on even and odd azimuthal orders they multiply by retro + mirror and retro - mirror,
/// and so do the roots of both. The smooth part is the rest of the root of the whole operator.
///
/// The errors of the root's values are their changes against the root on a finer grid (that of spectrum()),
/// interpolated. If the table's formulas are unknown, and above 128 rings, they are the changes against a coarser grid,
/// of two thirds of the rings and azimuths, and bounds by the errors of the values. Of operators that are constant on
/// cells, they are these bounds alone. The square root is ill-conditioned at 0: eigenvalues below rounding, 1e-16 |T|,
/// are taken as 0, which loses components of up to 1.5e-8 |T|^1/2.
/// \throws ArgumentError as spectrum(); NumericError for delta parts with |mirror| > retro, which have no root; DeviceError; Cancelled
[[nodiscard]] SquareRoot square_root(const Device& device, const BrdfTable& table,
                                     const SquareRootOptions& options = {});

}  // namespace lobe
