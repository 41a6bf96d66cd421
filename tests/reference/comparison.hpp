#pragma once

#include <string_view>

#include "reference/quadrature.hpp"

namespace lobe::reference {

/// Distance of f and g by a comparison metric of the literature, by its name in lobe/compare/literature_metric.hpp.
/// Composite Gauss rules with so many nodes per panel and axis: over theta_in, theta_out and delta_phi, for
/// log-relative over sqrt(theta_h), theta_d and phi_d. The narrower lobe sets the panels.
[[nodiscard]] double comparison(std::string_view name, const Lobe& f, const Lobe& g, double theta_max, int order);

}  // namespace lobe::reference
