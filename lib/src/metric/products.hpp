#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "device/tabulate_patch_light.hpp"
#include "lobe/device/device.hpp"
#include "lobe/metric/metric.hpp"
#include "metric/slab_store.hpp"
#include "model/lobes.hpp"

namespace lobe {

/// Products and squared distances of the materials in one channel, or in their weighted sum; bounds of their errors.
struct ChannelProducts {
  Eigen::MatrixXd gram, gram_error;                          ///< f_i . f_j
  Eigen::MatrixXd squared_distance, squared_distance_error;  ///< |f_i - f_j|^2
};

/// Accumulates what slabs of a quadrature rule contribute to the products of all channels and of their weighted sum.
class ProductSums {
 public:
  /// \param slabs slabs that are known or left to others, for integrators that take them; none: there are none
  ProductSums(const LobeSet& lobes, std::vector<double> channel_weights, const SlabStore* slabs = nullptr);

  /// A slab's products of lobes at successive levels of refinement, coarse to fine, at least two. The finest count.
  /// Their error is bounded by the difference of the last two levels, and by a tenth of the difference before that: two
  /// levels may agree by accident in single entries, three hardly do.
  /// \param safety a factor of that bound, for levels that approach their limit slowly
  void add_lobe_products(const std::vector<Eigen::MatrixXd>& levels, double safety = 1);

  /// Adds the difference of products of lobes between two quadratures as an error; the products stay.
  /// \param safety a factor of that error
  void add_lobe_change(const Eigen::MatrixXd& coarse, const Eigen::MatrixXd& fine, double safety = 1);

  /// Adds products F F^T from factors F; squared distances are then taken from differences of rows.
  /// \param safety as for add_lobe_products()
  void add_lobe_factors(const std::vector<Eigen::MatrixXd>& levels, double safety = 1);

  /// Adds products of integrals: of the sums of rows of F, lobes x slabs. The error of a distance is that of the slabs,
  /// without regard to its sign in each: integrals agree by accident where slabs cancel.
  /// \param safety as for add_lobe_products()
  void add_lobe_integrals(const std::vector<Eigen::MatrixXd>& levels, double safety = 1);

  /// One per channel, then the weighted sum.
  [[nodiscard]] std::vector<ChannelProducts>& totals() { return totals_; }
  [[nodiscard]] const std::vector<double>& channel_weights() const { return weights_; }
  [[nodiscard]] const SlabStore* slabs() const { return slabs_; }

 private:
  template <typename Combine, typename Add>
  void add_levels(const std::vector<Eigen::MatrixXd>& levels, const Combine& combine, const Add& add);

  const LobeSet& lobes_;
  std::vector<double> weights_;
  const SlabStore* slabs_;
  std::vector<ChannelProducts> totals_;
};

/// Factor of error estimates by which the levels of these lobes approach their limit more slowly than others.
[[nodiscard]] double level_safety(const LobeSet& lobes);

/// How many levels of refinement are worth their time for these lobes: those of jumps between nodes hardly converge.
[[nodiscard]] int most_levels(const LobeSet& lobes);

/// Adds to errors what levels do not tell of jumps between nodes (LobeSet::hides_jumps).
void add_hidden_jumps(const LobeSet& lobes, ChannelProducts& total);

/// Two materials of a channel whose squared distance is lost in the cancellation of products.
struct ClosePair {
  std::size_t channel;
  Eigen::Index i, j;
};

/// The pairs whose squared distance is at most `share` of the sum of their squared norms.
[[nodiscard]] std::vector<ClosePair> find_close_pairs(ProductSums& sums, double share);

/// f_i - f_j of each pair as a combination of lobes, pairs x lobes; terms that cancel exactly are dropped.
[[nodiscard]] Eigen::SparseMatrix<double, Eigen::RowMajor> differences(const LobeSet& lobes,
                                                                       std::span<const ClosePair> pairs);

/// Replaces the squared distances of pairs by integrals of their differences, and puts the combined ones together anew.
/// \param rounding relative error of the samples of a material
void replace_distances(ProductSums& sums, std::span<const ClosePair> pairs,
                       const Eigen::SparseMatrix<double, Eigen::RowMajor>& differences, const Eigen::VectorXd& squared,
                       const Eigen::VectorXd& squared_error, double rounding);

/// Integral of f_i f_j dmu dmu by half-difference quadrature (numerics: lighting `point`).
/// \throws NumericError, DeviceError, Cancelled
void integrate_point_products(const Device& device, const LobeSet& lobes, const MetricOptions& options,
                              ProductSums& sums, WorkDone& work);

/// Slabs of its rule, which are refined independently: `sums` may have a store of them.
[[nodiscard]] std::size_t point_slabs(const LobeSet& lobes, const MetricOptions& options);

/// Integral of a_i a_j dmu by albedo quadrature (lighting `daylight`).
/// \throws NumericError, DeviceError, Cancelled
void integrate_daylight_products(const Device& device, const LobeSet& lobes, const MetricOptions& options,
                                 ProductSums& sums, WorkDone& work);

/// Slabs of its rule, as point_slabs().
[[nodiscard]] std::size_t daylight_slabs(const LobeSet& lobes, const MetricOptions& options);

/// Integral of C_{f_i,f_j} W dmu dmu for the W of patch lights (lighting `patches`). In double precision.
/// \throws NumericError, DeviceError, Cancelled
void integrate_patch_products(const Device& device, const LobeSet& lobes, const Lighting& lighting,
                              const MetricOptions& options, ProductSums& sums, WorkDone& work);

/// (Integral of f_i dmu dmu)(integral of f_j dmu dmu) by albedo quadrature (lighting `mean-albedo`).
/// \throws NumericError, DeviceError, Cancelled
void integrate_mean_albedo_products(const Device& device, const LobeSet& lobes, const MetricOptions& options,
                                    ProductSums& sums, WorkDone& work);

/// The discs whose common areas make the W of patch lights.
[[nodiscard]] std::vector<LightDisc> light_discs(std::span<const PatchShare> shares);

/// Integral of W(X, Y) dmu(Y) at a point of the base plane, for the W of patch lights.
[[nodiscard]] double light_response(std::span<const PatchShare> shares, double distance);

/// How many successive levels of a slab the error estimate looks at.
inline constexpr std::size_t kLevelsKept = 3;

/// Share of the change before the last in the error estimate of a slab, against levels that agree by accident.
inline constexpr double kEarlierShare = 0.1;

/// Share of the slabs' worst relative differences that the error estimates of every product and every squared distance
/// carry, against entries in which levels agree by accident. Of 7140 distances under point light, 21 were off by up to
/// 18 of estimates without it.
inline constexpr double kCommonShare = 0.1;

/// Adds kCommonShare of a relative difference to the errors of products and squared distances.
/// \param difference sum of the slabs' worst relative differences
void add_common_share(double difference, ChannelProducts& total);

/// |fine - coarse| relative to the reference products.
[[nodiscard]] Eigen::ArrayXXd relative_differences(const Eigen::MatrixXd& fine, const Eigen::MatrixXd& coarse,
                                                   const Eigen::MatrixXd& reference);

/// The largest of these; the stopping rule of every slab.
[[nodiscard]] double relative_difference(const Eigen::MatrixXd& fine, const Eigen::MatrixXd& coarse,
                                         const Eigen::MatrixXd& reference);

/// \throws NumericError naming two lobes whose product is no finite number
void require_finite(const Eigen::MatrixXd& products, const LobeSet& lobes, const Lighting& lighting);

/// \throws Cancelled when the callback says so
void report_progress(const MetricOptions& options, const Lighting& lighting, double fraction);

}  // namespace lobe
