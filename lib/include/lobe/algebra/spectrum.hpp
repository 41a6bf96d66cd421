#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "lobe/core/estimate.hpp"
#include "lobe/core/progress.hpp"
#include "lobe/device/device.hpp"
#include "lobe/table/table.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// Options for a spectrum.
struct SpectrumOptions {
  /// Values count for the numerical rank if they are at least threshold * |T|; in (0, 1).
  double threshold = 1e-3;
  /// Whether to compare with a finer grid, if the table's formulas are known. Otherwise errors are estimated from the
  /// table alone.
  bool refine = true;
  ProgressCallback progress = {};  ///< told of the progress; may cancel
};

/// Spectral values of one azimuthal order m, which belong to functions g(theta) cos(m phi) and g(theta) sin(m phi).
struct OrderSpectrum {
  std::size_t order = 0;         ///< m; 0 for general tables
  std::size_t multiplicity = 1;  ///< multiplicity of each value: 1 for m = 0 and m = n_phi/2, else 2
  std::vector<Estimate> values;  ///< values by falling magnitude
};

/// A sum over the spectrum beside the integral that it must equal. The sum is exact for the discrete operator, so
/// `deviation` is rounding; the error of the integral is due to the grid and the values.
struct SumRule {
  double sum = 0;        ///< sum over the values of the operator
  Estimate integral;     ///< integral over directions
  double deviation = 0;  ///< |sum - integral|
};

/// Information left in a light distribution after composing, if components weaker than level * |T| are lost in noise.
struct DecayPoint {
  double level = 0;       ///< noise level, relative to |T|
  double components = 0;  ///< number of values above level * |T|, with multiplicity; may be infinite with delta parts
  std::size_t last_order = 0;  ///< the largest azimuthal order among them; 0 for general tables
  double bits = 0;             ///< sum over all components of log2(1 + (value / (level |T|))^2) / 2, Shannon's capacity
};

/// The spectrum of one channel, and quantities derived from it.
struct ChannelSpectrum {
  bool is_self_adjoint = true;        ///< whether the values are eigenvalues; otherwise they are singular values
  double reciprocity_defect = 0;      ///< |T - T*| / (2 |T|), Hilbert-Schmidt norms of the smooth parts
  std::vector<OrderSpectrum> orders;  ///< m = 0 .. n_phi/2; general tables have a single one, numbered 0
  Estimate norm;                      ///< |T| in L^2, the largest magnitude
  Estimate smallest;                  ///< smallest eigenvalue
  /// Root of the sum of squares over the negative eigenvalues. It is infinite if delta parts have negative eigenvalues,
  /// as a mirror beside a weaker RRIM part has.
  Estimate negative_norm;
  SumRule trace;                   ///< sum of the values = integral of f(L,L) dmu; for self-adjoint operators only
  SumRule hilbert_schmidt;         ///< sum of squares = integral of f^2 dmu dmu
  double effective_rank = 0;       ///< exp of the entropy of value^2 / sum of value^2
  double participation_ratio = 0;  ///< (sum of value^2)^2 / sum of value^4
  double numerical_rank = 0;       ///< number of values that are at least threshold * |T|
  double white_share = 0;          ///< mean of value^2 over all components of the grid
  std::vector<DecayPoint> decay;   ///< decay at the levels 1e-1, 1e-2, ... 1e-6
};

/// The spectrum of a table.
struct Spectrum {
  double threshold = 0;                   ///< threshold in the options
  std::vector<ChannelSpectrum> channels;  ///< one per channel of the table
};

/// Computes the eigenvalues of the symmetrised operator D^1/2 f D^1/2 + delta parts, with D = diag(weights). Isotropic
/// tables are decomposed for each azimuthal order (blocks of n_theta x n_theta), general ones as a dense matrix. A
/// table that is not reciprocal within its stated errors (or 1e-10) has no such eigenvalues; its singular values are
/// returned instead.
///
/// Both sum rules hold for the smooth part: the contribution of delta parts is subtracted, because it is infinite.
/// Effective rank, participation ratio and numerical rank are infinite with delta parts (the last one, if they exceed
/// the threshold).
///
/// Errors: if formulas are known (table.source), everything is computed once more from them on a gauss grid with 2.4
/// times as many rings and three times as many azimuths (above 128 rings: half as many). The change of each value and
/// its neighbours in rank and order counts twice (once). Otherwise no value moves by more than the norm of the error's
/// operator (Weyl's inequality), which is replaced by the norm of the table's bounds. The error of the grid is added,
/// estimated from the change of each value's function in an embedded rule and from the size of the last azimuthal
/// orders. Errors are NaN if those of the table are unknown.
/// \throws ArgumentError for an inconsistent table or a threshold out of range; NumericError if the decomposition
///   fails; DeviceError; Cancelled
[[nodiscard]] Spectrum spectrum(const Device& device, const BrdfTable& table, const SpectrumOptions& options = {});

/// Peak memory of spectrum() and square_root() in bytes, beside the table.
/// \param table its shape is enough
[[nodiscard]] std::uint64_t spectrum_bytes(const BrdfTable& table);

}  // namespace lobe
