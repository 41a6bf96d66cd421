#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lobe {

/// A cosine transform of n_phi/2 + 1 equispaced azimuths, factorised for kernels/products/isotropic.clh.
///
/// Folding the points about their middle (f[k] + f[L-k] and f[k] - f[L-k]) separates even from odd orders; folding the
/// sums again, as long as that pays, separates the orders by their powers of two. Each class of orders then needs a
/// dense matrix over its own points only: about a third of the operations of the whole matrix. The inverse is the
/// transpose: dense matrices, then unfolding.
struct CosinePlan {
  /// Outputs of a strip.
  static constexpr std::size_t kStrip = 6;

  /// Up to kStrip consecutive outputs from a run of inputs; `entry` is the place of its coefficients, kStrip (zeros
  /// behind the last output) for each input. Laid out as in kernels/products/isotropic.clh.
  struct Strip {
    std::uint32_t output, input, inputs, entry;
  };

  /// One direction of the transform. The strips' outputs ascend and leave no gap.
  struct Direction {
    std::vector<Strip> strips;
    std::vector<double> coefficients;
  };

  std::size_t points;  ///< n_phi/2 + 1: azimuths, and orders
  std::size_t levels;  ///< how often to fold
  Direction forward;   ///< F^m = integral of f cos(m dphi): orders, in the plan's sequence, from folded points
  Direction inverse;   ///< the Fourier series of f: folded points from orders
  std::vector<unsigned> orders;  ///< the order m at each place of the plan's sequence

  /// First place of the sequence behind strip `strip` of the forward direction.
  [[nodiscard]] std::size_t end_order(std::size_t strip) const {
    return strip + 1 < forward.strips.size() ? forward.strips[strip + 1].output : points;
  }
};

/// \param azimuths n_phi, even and at least 2
[[nodiscard]] CosinePlan make_cosine_plan(std::size_t azimuths);

/// cos(m k pi / half) to the last bit, for any m and k.
[[nodiscard]] double cosine_of(std::size_t m, std::size_t k, std::size_t half);

}  // namespace lobe
