#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "lobe/core/estimate.hpp"
#include "lobe/core/progress.hpp"
#include "lobe/device/device.hpp"
#include "lobe/table/table.hpp"

namespace lobe {

/// What of a spectrum is computed.
struct SpectrumOptions {
  /// Values of at least threshold * |T| count for the numerical rank; in (0, 1).
  double threshold = 1e-3;
  /// Compare with a finer grid where the formulas of the table are known; without it errors are judged by the table
  /// alone.
  bool refine = true;
  ProgressCallback progress = {};  ///< told of the progress; may cancel
};

/// The values of one azimuthal order m: those of functions g(theta) cos(m phi) and g(theta) sin(m phi).
struct OrderSpectrum {
  std::size_t order = 0;         ///< m; 0 for general tables
  std::size_t multiplicity = 1;  ///< of each value: 1 for m = 0 and m = n_phi/2, else 2
  std::vector<Estimate> values;  ///< by falling magnitude
};

/// A sum over the spectrum beside the integral it must be equal to. The sum is exact for the discrete operator, so that
/// `deviation` is rounding; the error of the integral is that of the grid and of the values.
struct SumRule {
  double sum = 0;        ///< over the values of the operator
  Estimate integral;     ///< over directions
  double deviation = 0;  ///< |sum - integral|
};

/// What is left of a distribution of light after composing, when components weaker than level * |T| are lost in noise.
struct DecayPoint {
  double level = 0;            ///< of the noise, relative to |T|
  double components = 0;       ///< values above level * |T|, with multiplicity; infinity with delta parts above it
  std::size_t last_order = 0;  ///< the largest azimuthal order among them; 0 for general tables
  double bits = 0;             ///< sum of log2(1 + (value / (level |T|))^2) / 2 over all components, Shannon's capacity
};

/// The spectrum of one channel, and what follows from it.
struct ChannelSpectrum {
  bool is_self_adjoint = true;        ///< eigenvalues; else singular values
  double reciprocity_defect = 0;      ///< |T - T*| / (2 |T|), Hilbert-Schmidt norms of the smooth parts
  std::vector<OrderSpectrum> orders;  ///< m = 0 .. n_phi/2; of general tables a single one, called 0
  Estimate norm;                      ///< |T| in L^2: the largest magnitude
  Estimate smallest;                  ///< smallest eigenvalue
  /// Root of the sum of squares of the negative eigenvalues; infinity where delta parts have such, as a mirror beside a
  /// weaker RRIM part has.
  Estimate negative_norm;
  SumRule trace;                   ///< sum of the values; integral of f(L,L) dmu. Only of self-adjoint operators
  SumRule hilbert_schmidt;         ///< sum of squares; integral of f^2 dmu dmu
  double effective_rank = 0;       ///< exp of the entropy of value^2 / sum of value^2
  double participation_ratio = 0;  ///< (sum of value^2)^2 / sum of value^4
  double numerical_rank = 0;       ///< values of at least threshold * |T|
  double white_share = 0;          ///< mean of value^2 over all components of the grid
  std::vector<DecayPoint> decay;   ///< at levels 1e-1, 1e-2, ... 1e-6
};

/// The spectrum of a table, one per channel.
struct Spectrum {
  double threshold = 0;                   ///< that of the options
  std::vector<ChannelSpectrum> channels;  ///< one per channel of the table
};

/// Eigenvalues of the symmetrised operator D^1/2 f D^1/2 + delta parts, D = diag(weights): for isotropic tables apart
/// for each azimuthal order (blocks of n_theta x n_theta), for general ones of the dense matrix. A table that is not
/// reciprocal within its stated errors (or 1e-10) has no such eigenvalues; its singular values stand instead.
///
/// Both sum rules hold for the smooth part: what delta parts add to the sums is taken off, because it is infinite.
/// Effective rank, participation ratio and numerical rank are infinite with delta parts (the last one, if they exceed
/// the threshold).
///
/// Errors: where formulas are known (table.source) all is computed once more from them on a gauss grid of 2.4 times as
/// many rings and three times as many azimuths (above 128 rings: of half as many), and the change of each value and its
/// neighbours in rank and order counts twice (once). Else no value moves by more than the norm of the error's operator
/// (Weyl's inequality), for which that of the table's bounds stands; to that comes the error of the grid, by the change
/// of each value's function in an embedded rule, and the size of the last azimuthal orders. NaN where errors of
/// the table are unknown.
/// \throws ArgumentError for an inconsistent table or a threshold out of range; NumericError when the decomposition
///   fails; DeviceError; Cancelled.
[[nodiscard]] Spectrum spectrum(const Device& device, const BrdfTable& table, const SpectrumOptions& options = {});

/// Bytes that spectrum() and square_root() take at their peak beside the table.
/// \param table a shape is enough
[[nodiscard]] std::uint64_t spectrum_bytes(const BrdfTable& table);

}  // namespace lobe
