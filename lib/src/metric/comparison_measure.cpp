#include "metric/comparison_measure.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lobe {
namespace {

using enum Comparison;

constexpr double kEpsilon = 1e-3;  // Nielsen et al. 2015

double sine(double cosine) {
  return std::sqrt(std::max(0.0, (1 - cosine) * (1 + cosine)));
}

}  // namespace

ComparisonRecipe recipe_of(Comparison comparison) {
  ComparisonRecipe recipe;
  switch (comparison) {
    case ngan_l2:
    case low_l2:
    case bieron_l2:
      break;
    case low_log:
    case bieron_log:
    case standard_log:
      recipe.map = NodeMap::log;
      break;
    case cube_root:
      recipe.term = PairTerm::two_thirds;
      recipe.is_mean = true;
      break;
    case log_relative:
      recipe.domain = ComparisonDomain::half_difference;
      recipe.map = NodeMap::log;
      recipe.is_mean = true;
      break;
    case albedo_of_difference:
      recipe.domain = ComparisonDomain::projected;
      recipe.term = PairTerm::absolute;
      recipe.is_root = false;
      break;
  }
  return recipe;
}

double scale_at(Comparison comparison, double cos_i, double cos_o) {
  if (comparison == albedo_of_difference) return 1;
  // ln(f w + e) - ln(g w + e) = ln(1 + f w/e) - ln(1 + g w/e)
  if (comparison == log_relative) return std::max(cos_i * cos_o, kEpsilon) / kEpsilon;
  return cos_i;
}

double weight_at(Comparison comparison, double cos_i, double cos_o) {
  switch (comparison) {
    case ngan_l2:
    case standard_log:
      return sine(cos_i) * sine(cos_o);
    case low_l2:
    case low_log:
      return sine(cos_i);
    case bieron_l2:
    case bieron_log:
      return cos_o * sine(cos_i) * sine(cos_o);
    case cube_root:
    case log_relative:
    case albedo_of_difference:
      break;
  }
  return 1;
}

double half_difference_density(const NodeBlock::Node& node) {
  // dmu dmu = 4 (L.H) (N.L) (N.V) sin(theta_h) sin(theta_d) dtheta_h dphi_h dtheta_d dphi_d, with 2 pi of phi_h.
  const double theta_h = std::atan(std::sqrt(node[NodeBlock::tan2_h]));
  const double cos_d = node[NodeBlock::cos_d];
  const double angles = 1 / (8 * std::numbers::pi * cos_d * node[NodeBlock::cos_i] * node[NodeBlock::cos_o] *
                             std::sin(theta_h) * sine(cos_d));
  return angles / (2 * std::sqrt(theta_h));
}

double rounding_of_integral(const ComparisonRecipe& recipe, double integral, double sizes, double relative_error) {
  switch (recipe.term) {
    case PairTerm::square: {
      // The root is a norm of f - g, which moves by at most e (|f| + |g|); the logarithm is no steeper than that.
      const double move = relative_error * std::sqrt(2 * sizes);
      return move * (2 * std::sqrt(integral) + move);
    }
    case PairTerm::absolute:
      return relative_error * sizes;
    case PairTerm::two_thirds:
      break;
  }
  constexpr double kPower = 2e-7;                                        // of the kernel's |d|^(2/3)
  return std::pow(relative_error, 2.0 / 3) * sizes + kPower * integral;  // |a + b|^(2/3) <= |a|^(2/3) + |b|^(2/3)
}

}  // namespace lobe
