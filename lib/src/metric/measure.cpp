#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "core/stopwatch.hpp"
#include "device/rounding.hpp"
#include "lobe/core/error.hpp"
#include "lobe/metric/metric.hpp"
#include "lobe/reflectance/as_function.hpp"
#include "metric/channel_metric.hpp"
#include "metric/domain.hpp"
#include "metric/grazing_growth.hpp"
#include "metric/lighting_traits.hpp"
#include "metric/products.hpp"
#include "metric/routes.hpp"
#include "model/delta.hpp"
#include "model/lobes.hpp"

namespace lobe {
namespace {

/// \throws NumericError naming two materials whose product is no finite number
void require_finite(const ChannelProducts& products, std::span<const Material> materials, const Lighting& lighting) {
  if (products.gram.allFinite() && products.squared_distance.allFinite()) return;
  for (Eigen::Index j = 0; j < products.gram.cols(); ++j) {
    for (Eigen::Index i = 0; i <= j; ++i) {
      if (std::isfinite(products.gram(i, j)) && std::isfinite(products.squared_distance(i, j))) continue;
      throw NumericError("the product of '" + materials[static_cast<std::size_t>(i)].name + "' and '" +
                         materials[static_cast<std::size_t>(j)].name + "' under lighting '" + lighting.name() +
                         "' is no finite number");
    }
  }
}

/// Whether nothing but its values says how a material grows towards the horizon.
bool has_own_formula(const Material& material) {
  return std::ranges::any_of(material.terms, [](const Term& term) { return term.formula.has_value(); });
}

BrdfFunction smooth_function(const Device& device, const Material& material) {
  return as_function(device, smooth_part(material));
}

/// \throws NumericError naming a lobe, or a material with a formula of the user's, that has no norm
void require_finite_norms(const Device& device, std::span<const Material> materials, const LobeSet& lobes,
                          const Lighting& lighting) {
  if (traits_of(lighting).is_of_means || lobes.cos_min > 0) return;
  const auto refuse = [&](const std::string& name, const std::string& reason) {
    throw NumericError("the norm of '" + name + "' under lighting '" + lighting.name() + "' is infinite: " + reason +
                           "; 'mean-albedo' takes it, or " + domain_advice(lighting),
                       {.fault = Fault::infinite_norm});
  };
  if (!lobes.infinite.empty()) refuse(lobes.infinite.front(), "it grows as 1/(N.L) at grazing angles");
  for (const Material& material : materials) {
    if (!has_own_formula(material) || !has_infinite_norm(smooth_function(device, material), lighting)) continue;
    refuse(material.name, "every decade of cos(theta) towards the horizon adds as much to it");
  }
}

/// Adds what the quadrature does not see of materials that grow towards the horizon.
void add_unseen_parts(const Device& device, std::span<const Material> materials, const Lighting& lighting,
                      double tolerance, ProductSums& sums) {
  constexpr double kNegligible = 1e-3;  // of the tolerance
  const auto root_of = [&](const Material& material) {
    return std::sqrt(finite_unseen_square(smooth_function(device, material), lighting).value_or(0));
  };
  const auto count = static_cast<Eigen::Index>(materials.size());
  Eigen::VectorXd roots = Eigen::VectorXd::Constant(count, -1);
  bool matters = false;
  for (Eigen::Index i = 0; i < count; ++i) {
    const Material& material = materials[static_cast<std::size_t>(i)];
    if (!has_own_formula(material)) continue;
    roots(i) = root_of(material);
    matters = matters || roots(i) * roots(i) > kNegligible * tolerance * sums.totals().back().gram(i, i);
  }
  if (!matters) return;
  for (Eigen::Index i = 0; i < count; ++i) {
    if (roots(i) < 0) roots(i) = root_of(materials[static_cast<std::size_t>(i)]);
  }
  for (std::size_t c = 0; c < sums.totals().size(); ++c) {
    double weight = 1;
    if (c + 1 == sums.totals().size()) {
      weight = 0;
      for (const double channel : sums.channel_weights()) weight += std::abs(channel);
    }
    add_unseen(roots, weight, sums.totals()[c]);
  }
}

/// \throws ArgumentError for a tolerance out of range, and as make_lobe_set() and cos_of_domain()
LobeSet lobes_of(std::span<const Material> materials, const Lighting& lighting, const MetricOptions& options) {
  if (!(options.tolerance > 0 && options.tolerance < 1))
    throw ArgumentError("tolerance out of range; expected a value in (0, 1)");
  const LightingTraits& traits = traits_of(lighting);
  LobeSet lobes =
      make_lobe_set(materials, {.with_deltas = traits.takes_deltas, .with_anisotropic = traits.takes_anisotropic});
  lobes.cos_min = cos_of_domain(options.theta_max, lighting);
  return lobes;
}

/// The materials without any lobe in a channel.
std::vector<bool> black_rows(const Eigen::SparseMatrix<double, Eigen::RowMajor>& mix) {
  std::vector<bool> is_black;
  for (Eigen::Index row = 0; row < mix.rows(); ++row) is_black.push_back(mix.row(row).cwiseAbs().sum() == 0);
  return is_black;
}

}  // namespace

bool are_measurable(std::span<const Material> materials, const Lighting& lighting) {
  const LightingTraits& traits = traits_of(lighting);
  if (traits.is_of_means) return true;
  const LobeSet lobes = make_lobe_set(materials, {.with_deltas = true, .with_anisotropic = true});
  if (!traits.takes_deltas && !lobes.deltas.empty()) return false;
  return lobes.infinite.empty();
}

std::size_t formula_slabs(std::span<const Material> materials, const Lighting& lighting, const MetricOptions& options) {
  const LightingTraits& traits = traits_of(lighting);
  if (traits.slabs == nullptr) return 0;
  try {
    const LobeSet lobes = lobes_of(materials, lighting, options);
    return lobes.infinite.empty() ? traits.slabs(lobes, options) : 0;
  } catch (const Error&) {
    return 0;
  }
}

void refine_formula_slabs(const Device& device, std::span<const Material> materials, const Lighting& lighting,
                          const MetricOptions& options, const SlabStore& slabs) {
  const LobeSet lobes = lobes_of(materials, lighting, options);
  require_finite_norms(device, materials, lobes, lighting);
  ProductSums sums(lobes, channel_weights(options.channel_weights, lobes.channels()), &slabs);
  WorkDone work;
  traits_of(lighting).integrate(device, lobes, lighting, options, sums, work);
}

MetricResult measure_formulas(const Device& device, std::span<const Material> materials, const Lighting& lighting,
                              const MetricOptions& options, const SlabStore* slabs) {
  const LightingTraits& traits = traits_of(lighting);
  const LobeSet lobes = lobes_of(materials, lighting, options);
  require_finite_norms(device, materials, lobes, lighting);
  ProductSums sums(lobes, channel_weights(options.channel_weights, lobes.channels()), slabs);
  MetricResult result;
  result.lighting = lighting;
  result.theta_max = options.theta_max;
  if (traits.integrate == nullptr) {
    throw ArgumentError("lighting '" + lighting.name() + "' is a table; tabulate the materials on its grid");
  }
  traits.integrate(device, lobes, lighting, options, sums, result.work);

  Stopwatch watch;
  if (lobes.cos_min == 0) add_unseen_parts(device, materials, lighting, options.tolerance, sums);
  auto& totals = sums.totals();
  for (auto& products : totals) add_hidden_jumps(lobes, products);
  for (const auto& products : totals) require_finite(products, materials, lighting);
  std::vector<bool> is_black(materials.size(), true);
  for (std::size_t c = 0; c < lobes.channels(); ++c) {
    const std::vector<bool> in_channel = black_rows(lobes.mix[c]);
    for (std::size_t i = 0; i < is_black.size(); ++i) is_black[i] = is_black[i] && in_channel[i];
    if (lobes.channels() > 1) result.channels.push_back(make_metric(std::move(totals[c]), in_channel));
  }
  result.combined = make_metric(std::move(totals.back()), is_black);
  result.tolerance = formula_tolerance(lighting, options);
  result.unresolved =
      find_unresolved(result.combined, std::max(result.tolerance, 2 * product_rounding(options.precision)));
  result.work.seconds_host += watch.lap();
  return result;
}

}  // namespace lobe
