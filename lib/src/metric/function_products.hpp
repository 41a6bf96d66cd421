#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "lobe/core/work_done.hpp"
#include "metric/products.hpp"
#include "metric/routes.hpp"

namespace lobe {

/// Products of functions in a channel as a quadrature has them, with its errors.
struct FunctionProducts {
  ChannelProducts products;
  Eigen::VectorXd square_error;  ///< by function, the integral of its own squared errors; NaN where unknown

  /// All 0.
  explicit FunctionProducts(std::size_t functions);
};

/// With the functions' own errors and with rounding: |e_i.f_j| <= |e_i| |f_j|, and |f_i - f_j| moves by |e_i| + |e_j|
/// at most.
[[nodiscard]] ChannelProducts with_own_errors(FunctionProducts sums);

/// Products of albedos under daylight, or of mean albedos, by channel: adaptive over both directions, to
/// `options.tolerance` of each f.f where its kinks allow that.
[[nodiscard]] std::vector<FunctionProducts> integrate_albedo_products(std::span<const BrdfFunction> functions,
                                                                      std::size_t channels, const Lighting& lighting,
                                                                      const FunctionMetricOptions& options,
                                                                      WorkDone& work);

/// Products under patch lights, by channel: functions are projected on polynomials of the base plane, whose degree
/// grows with the level. As for point light the mean over both orders of the directions counts, <f eta, g eta> and <eta
/// f, eta g>, which are the same for reciprocal functions.
[[nodiscard]] std::vector<ChannelProducts> integrate_function_patches(std::span<const BrdfFunction> functions,
                                                                      std::size_t channels, const Lighting& lighting,
                                                                      const FunctionMetricOptions& options,
                                                                      WorkDone& work);

}  // namespace lobe
