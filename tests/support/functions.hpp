#pragma once

#include <cmath>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "lobe/table/brdf_function.hpp"

namespace lobe::test {

/// A reflectance of one channel by a formula.
/// \param error what it states, sr^-1; 0: none
inline BrdfFunction function_of(std::function<double(const Directions&)> formula, double error = 0) {
  BrdfFunction brdf;
  brdf.name = "formula";
  brdf.channels = {"value"};
  brdf.at = [formula = std::move(formula), error](std::span<const Directions> pairs) {
    BrdfValues values;
    values.value.resize(static_cast<Eigen::Index>(pairs.size()), 1);
    for (std::size_t i = 0; i < pairs.size(); ++i) values.value(static_cast<Eigen::Index>(i), 0) = formula(pairs[i]);
    if (error > 0) values.error = Eigen::MatrixXd::Constant(values.value.rows(), 1, error);
    return values;
  };
  return brdf;
}

/// A lobe about the mirror direction over a base, by the angles' sines alone: reciprocal and the same on both sides.
inline double glossy_at(const Directions& pair) {
  const double along = std::sin(pair.theta_in) * std::sin(pair.theta_out);
  return 0.1 + std::exp(-8 * (std::pow(std::sin(pair.theta_in), 2) + std::pow(std::sin(pair.theta_out), 2) +
                              2 * along * std::cos(pair.delta_phi)));
}

/// Channels in which glossy_at() is multiplied by 1, 2, 3.
inline BrdfFunction glossy_function(std::vector<std::string> channels) {
  BrdfFunction brdf;
  brdf.name = "glossy";
  brdf.channels = std::move(channels);
  brdf.is_bilateral = true;
  brdf.at = [count = static_cast<Eigen::Index>(brdf.channels.size())](std::span<const Directions> pairs) {
    BrdfValues found{Eigen::MatrixXd(static_cast<Eigen::Index>(pairs.size()), count), {}};
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      for (Eigen::Index c = 0; c < count; ++c) {
        found.value(static_cast<Eigen::Index>(i), c) = static_cast<double>(c + 1) * glossy_at(pairs[i]);
      }
    }
    return found;
  };
  return brdf;
}

}  // namespace lobe::test
