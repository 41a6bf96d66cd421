#pragma once

#include <functional>
#include <span>
#include <utility>

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

}  // namespace lobe::test
