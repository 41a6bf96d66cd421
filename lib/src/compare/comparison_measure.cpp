#include "compare/comparison_measure.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lobe {

double sine(double cosine) {
  return std::sqrt(std::max(0.0, (1 - cosine) * (1 + cosine)));
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
