#include "metric/comparison_measure.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lobe {
namespace {

using enum Comparison;

constexpr double kEpsilon = 1e-3;  // Nielsen et al. 2015, Lavoue et al. 2021

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
    case cube_root_l2:
      recipe.map = NodeMap::cube_root;
      recipe.is_mean = true;
      break;
    case cube_root_log:
      recipe.map = NodeMap::cube_root_log;
      recipe.term = PairTerm::absolute;
      recipe.is_mean = true;
      recipe.is_root = false;
      break;
  }
  return recipe;
}

double scale_at(Comparison comparison, double cos_i, double cos_o) {
  if (comparison == albedo_of_difference || comparison == cube_root_l2) return 1;
  // ln(f w + e) - ln(g w + e) = ln(1 + f w/e) - ln(1 + g w/e)
  if (comparison == log_relative) return std::max(cos_i * cos_o, kEpsilon) / kEpsilon;
  if (comparison == cube_root_log) {
    // The same of f^(1/3), so that f has the cube.
    const double w = std::max(cos_i * cos_o, kEpsilon) / kEpsilon;
    return w * w * w;
  }
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
    case cube_root_l2:
    case cube_root_log:
      break;
  }
  return 1;
}

bool has_kinks(const ComparisonRecipe& recipe) {
  return recipe.term != PairTerm::square || recipe.map == NodeMap::cube_root;
}

double mapped(NodeMap map, double x) {
  switch (map) {
    case NodeMap::linear:
      break;
    case NodeMap::log:
      return std::log1p(x);
    case NodeMap::cube_root:
      return std::cbrt(x);
    case NodeMap::cube_root_log:
      return std::log1p(std::cbrt(x));
  }
  return x;
}

double mapped_error(NodeMap map, double x, double error) {
  if (map == NodeMap::linear || std::isnan(error)) return error;
  // Logarithms take nothing below 0, where they cannot be.
  const double lowest = map == NodeMap::cube_root ? x - error : std::max(x - error, 0.0);
  const double below = mapped(map, x) - mapped(map, lowest);
  const double above = map == NodeMap::log ? std::log1p(error / (1 + x)) : mapped(map, x + error) - mapped(map, x);
  return std::max(below, above);
}

double term_of(PairTerm term, double difference) {
  switch (term) {
    case PairTerm::square:
      return difference * difference;
    case PairTerm::absolute:
      return std::abs(difference);
    case PairTerm::two_thirds:
      break;
  }
  const double root = std::cbrt(difference);
  return root * root;
}

double value_error(PairTerm term, double integral, double f_error, double g_error) {
  if (term != PairTerm::square) return f_error + g_error;
  const double move = std::sqrt(f_error) + std::sqrt(g_error);
  return move * (2 * std::sqrt(integral) + move);
}

double half_difference_density(const NodeBlock::Node& node) {
  // dmu dmu = 4 (L.H) (N.L) (N.V) sin(theta_h) sin(theta_d) dtheta_h dphi_h dtheta_d dphi_d, with 2 pi of phi_h.
  const double theta_h = std::atan(std::sqrt(node[NodeBlock::tan2_h]));
  const double cos_d = node[NodeBlock::cos_d];
  // A cosine of 1 stands for angles below 1.5e-8, of which no integral is made.
  if (cos_d >= 1 || theta_h <= 0) return 0;
  const double angles = 1 / (8 * std::numbers::pi * cos_d * node[NodeBlock::cos_i] * node[NodeBlock::cos_o] *
                             std::sin(theta_h) * sine(cos_d));
  return angles / (2 * std::sqrt(theta_h));
}

double rounding_of_integral(const ComparisonRecipe& recipe, double integral, double sizes, double relative_error) {
  switch (recipe.term) {
    case PairTerm::square: {
      // The root is a norm of f - g, which moves by at most e (|f| + |g|); neither logarithm nor cube root are steeper,
      // relatively, than that.
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
