// Metrics of the literature, of materials.
#include <utility>

#include "compare/comparison_integrator.hpp"
#include "compare/comparison_measure.hpp"
#include "compare/comparison_refinement.hpp"
#include "compare/comparison_result.hpp"
#include "compare/comparison_routes.hpp"
#include "core/stopwatch.hpp"
#include "device/rounding.hpp"
#include "lobe/compare/literature_metric.hpp"
#include "metric/products.hpp"
#include "model/lobes.hpp"

namespace lobe {

LiteratureResult compare_formulas(const Device& device, std::span<const Material> materials,
                                  LiteratureMetric comparison, const LiteratureOptions& options) {
  check(options);
  report_progress(options, comparison, 0);
  const LobeSet lobes = make_lobe_set(materials);
  const auto weights = comparison_weights(options, lobes.channels());
  std::vector<std::string> names;
  for (const auto& material : materials) names.push_back(material.name);

  WorkDone work;
  ComparisonIntegrator integrator(device, lobes, comparison, options, work);
  auto totals = refined_integrals(integrator, comparison, weights, options);

  Stopwatch watch;
  const ComparisonRecipe recipe = recipe_of(comparison);
  for (auto& total : totals) {
    const Eigen::Index black = total.value.rows() - 1;
    for (Eigen::Index j = 0; j <= black; ++j) {
      for (Eigen::Index i = 0; i <= black; ++i) {
        const double value = total.value(i, j);
        if (value == 0) continue;  // identical materials, sample by sample
        total.error(i, j) += rounding_of_integral(recipe, value, total.value(i, black) + total.value(j, black),
                                                  product_rounding(options.precision) / 4);
      }
    }
  }
  LiteratureResult result = make_comparison_result(comparison, totals, names, options);
  work.seconds_host += watch.lap();
  result.work = work;
  report_progress(options, comparison, 1);
  return result;
}

}  // namespace lobe
