#pragma once

#include <functional>
#include <span>
#include <vector>

#include "lobe/core/directions.hpp"

namespace lobe::reference {

/// A reflectance by its values at pairs of directions, sr^-1.
using PairValues = std::function<std::vector<double>(std::span<const Directions>)>;

/// How finely lit_product() integrates.
struct LitRule {
  int incident = 8;           ///< elevations of V in each of two panels
  int turns = 1;              ///< azimuths of V; 1 for isotropic reflectances
  int azimuths = 24;          ///< about the mirror direction, of X and of P
  int nodes = 4;              ///< Gauss nodes of each panel of a ray from the mirror direction
  double narrowest = 0.0025;  ///< end of the first panel of X, in the base plane
};

/// Products under a patch light (Neumann 2001, eqs. 5.23 and 4.2), taken literally: the responses
///   B_f(p, V) = 1 / (pi min(1, R^2)) times the integral of f(X, V) over X_P within R of p and within the unit disc,
/// and the integral of B_f B_g over p in the unit disc and dmu(V). Rays from the mirror direction of V are cut exactly
/// where they leave the discs.
/// \return f.f, f.g and g.g
[[nodiscard]] std::vector<double> lit_products(const PairValues& f, const PairValues& g, double radius,
                                               const LitRule& rule = {});

}  // namespace lobe::reference
