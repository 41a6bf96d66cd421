#pragma once

#include <string_view>

#include "device/accumulate_pairs.hpp"
#include "device/node_block.hpp"
#include "lobe/compare/literature_metric.hpp"

namespace lobe {

/// The sine of an angle in [0, pi] by its cosine.
[[nodiscard]] double sine(double cosine);

/// Over which coordinates a comparison integrates.
enum class ComparisonDomain {
  angles,           ///< theta_in, theta_out, delta_phi up to theta_max
  half_difference,  ///< sqrt(theta_h), theta_d, phi_d
  projected         ///< both projected solid angles
};

/// A comparison as code sees it: the integral of weight * term(map(scale f) - map(scale g)), a mean where is_mean.
struct ComparisonRecipe {
  ComparisonDomain domain = ComparisonDomain::angles;
  NodeMap map = NodeMap::linear;
  PairTerm term = PairTerm::square;
  bool is_mean = false;
  bool is_root = true;  ///< the distance is the root of the integral
};

/// A metric of the literature (literature_metric.cpp has all).
struct ComparisonRow {
  LiteratureMetric comparison{};
  std::string_view name;
  std::string_view unit;  ///< of the distance, "" for none
  ComparisonRecipe recipe;
  double (*scale)(double cos_i, double cos_o) = nullptr;   ///< what multiplies f before it is mapped
  double (*weight)(double cos_i, double cos_o) = nullptr;  ///< published, beside the measure of the domain
};
[[nodiscard]] const ComparisonRow& row_of(LiteratureMetric comparison);

[[nodiscard]] inline ComparisonRecipe recipe_of(LiteratureMetric comparison) {
  return row_of(comparison).recipe;
}
[[nodiscard]] inline double scale_at(LiteratureMetric comparison, double cos_i, double cos_o) {
  return row_of(comparison).scale(cos_i, cos_o);
}
[[nodiscard]] inline double weight_at(LiteratureMetric comparison, double cos_i, double cos_o) {
  return row_of(comparison).weight(cos_i, cos_o);
}

/// Whether what is integrated has kinks that no panel follows: where f = g, or where f leaves 0 as a root.
[[nodiscard]] bool has_kinks(const ComparisonRecipe& recipe);

/// map(x), as kernels/products/map_materials.cl has it.
[[nodiscard]] double mapped(NodeMap map, double x);

/// Bound on the change of map(x) where x is known to an error and, under a logarithm, not negative. NaN for NaN.
[[nodiscard]] double mapped_error(NodeMap map, double x, double error);

/// term(d), as kernels/products/accumulate_pairs.cl has it.
[[nodiscard]] double term_of(PairTerm term, double difference);

/// Change of an integral where values are known to errors, of which both integrals against black are given.
[[nodiscard]] double value_error(PairTerm term, double integral, double f_error, double g_error);

/// Measure of sqrt(theta_h), theta_d, phi_d per projected solid angles dmu dmu, at a node; 0 where its
/// cosines round to the pole of these coordinates.
[[nodiscard]] double half_difference_density(const NodeBlock::Node& node);

/// Bound on the change of the integral where f and g are known to a relative error only.
/// \param sizes sum of the integrals of both against black
[[nodiscard]] double rounding_of_integral(const ComparisonRecipe& recipe, double integral, double sizes,
                                          double relative_error);

}  // namespace lobe
