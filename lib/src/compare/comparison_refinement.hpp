#pragma once

#include <vector>

#include "compare/comparison_integrator.hpp"
#include "compare/comparison_result.hpp"

namespace lobe {

/// The integrals, per channel, refined until their errors are within the tolerance for all pairs but outliers, or
/// nothing can be refined.
/// \param weights of the channels
[[nodiscard]] std::vector<ComparisonIntegrals> refined_integrals(ComparisonIntegrator& integrator,
                                                                 LiteratureMetric comparison,
                                                                 const std::vector<double>& weights,
                                                                 const LiteratureOptions& options);

}  // namespace lobe
