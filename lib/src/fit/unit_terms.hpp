#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "lobe/metric/metric.hpp"
#include "lobe/model/material.hpp"
#include "metric/products.hpp"

namespace lobe {

/// Whether two terms of families differ at most in scale.
[[nodiscard]] bool are_alike(const Term& a, const Term& b);

/// Materials as sums of the same terms: those around a point of a family differ in a scale or in the shape of one term,
/// so that the terms are fewer.
struct UnitTerms {
  std::vector<Material> terms;           ///< each of one term with scale 1, no two alike
  std::vector<Eigen::MatrixXd> factors;  ///< by channel: materials x terms
};

/// \param channels of the target; scales of one channel serve all
[[nodiscard]] UnitTerms unit_terms(std::span<const Material> materials, std::size_t channels);

/// Products among a target, number 0, and materials, of those among the target and their terms. Quadratures that are
/// the same sum for all pairs give what they give for the materials themselves but for rounding, which is relative to
/// the squares of norms; where materials differ in shape alone, to their distance. Terms that a material lacks do not
/// count, whatever they are.
[[nodiscard]] ChannelProducts products_of_sums(const ChannelProducts& products, const Eigen::MatrixXd& factors);

/// Products of a metric; distances that are no numbers stay so.
[[nodiscard]] ChannelProducts products_of(const Metric& metric);

}  // namespace lobe
