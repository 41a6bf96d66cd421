#pragma once

#include <vector>

#include "lobe/core/estimate.hpp"
#include "lobe/core/progress.hpp"
#include "lobe/device/device.hpp"
#include "lobe/table/least_value.hpp"
#include "lobe/table/table.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// How a root is taken.
struct SquareRootOptions {
  /// Eigenvalues down to -tolerance * |T| count as zero; in [0, 1).
  double tolerance = 1e-10;
  ProgressCallback progress = {};  ///< told of the progress; may cancel
};

/// Whether an operator is positive semi-definite.
enum class Definiteness {
  semi_definite,  ///< no eigenvalue below -tolerance * |T|
  indefinite,     ///< an eigenvalue is negative by more than its error
  undecided       ///< negative eigenvalues, all within their errors
};

/// What is known of one channel and its root.
struct ChannelRoot {
  Definiteness definiteness = Definiteness::semi_definite;  ///< whether the channel has a root at all
  Estimate norm;                                            ///< |T| in L^2
  Estimate smallest;                                        ///< smallest eigenvalue of T
  Estimate distance;                ///< Hilbert-Schmidt distance of T to the nearest self-composition
  Estimate relative_distance;       ///< the same over the norm of T; NaN with delta parts, whose norm is infinite
  PlacedValue least_value;          ///< of the root
  Estimate largest_albedo;          ///< of the root
  double largest_albedo_theta = 0;  ///< radians
};

/// A root and what is known of it.
struct SquareRoot {
  BrdfTable table;                    ///< the root
  std::vector<ChannelRoot> channels;  ///< one per channel of the table
};

/// The self-adjoint X >= 0 with X o X = T where T >= 0, and otherwise with X o X the nearest operator to T in the
/// Hilbert-Schmidt norm that has such a root: T without the negative part of its spectrum (Higham 1988). The root is
/// reciprocal; whether it is a reflectance, its least value and its largest albedo say.
///
/// Delta parts have their exact roots: on even and odd azimuthal orders they multiply by retro + mirror and retro -
/// mirror, and so do the roots of both. The smooth part is what is left of the root of the whole operator.
///
/// Errors of the root's values are its changes against the root on a finer grid (as spectrum() has it), interpolated;
/// NaN where the formulas of the table are not known, or with more than 128 rings. The square root is ill-conditioned
/// at 0: eigenvalues below rounding, 1e-16 |T|, are taken as 0, which loses components of up to 1.5e-8 |T|^1/2.
/// \throws ArgumentError as spectrum(); NumericError for tables that are not reciprocal and for delta parts with
///   |mirror| > retro, whose root does not exist; DeviceError; Cancelled.
[[nodiscard]] SquareRoot square_root(const Device& device, const BrdfTable& table,
                                     const SquareRootOptions& options = {});

}  // namespace lobe
