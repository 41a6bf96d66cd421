#pragma once

#include <vector>

#include "reference/lit_product.hpp"

namespace lobe::reference {

/// How finely pattern_products() integrates.
struct PatternRule {
  int views = 8;              ///< elevations of V in each of two panels
  int turns = 1;              ///< azimuths of V; 1 where all reflectances are isotropic
  int azimuths = 24;          ///< of L about the mirror direction of V
  int nodes = 4;              ///< Gauss nodes of each panel of a ray from the mirror direction
  double narrowest = 0.0025;  ///< end of the first panel of such a ray, in the base plane
  int patterns = 8;           ///< elevations of the light's position p in each of two panels
  int pattern_turns = 32;     ///< azimuths of p
};

/// Products under light of the pattern eta (Neumann 2001, eq. 5.23), taken literally: under light about p, which
/// arrives from L as eta(p, L), the surface looks from V as
///   B_f(p, V) = integral of eta(p, L) f(L, V) dmu(L),
/// and f . g is the integral of B_f B_g over dmu(p) dmu(V). L lies on rays from the mirror direction of V in the base
/// plane, where f is steep; p on a product rule, which has to resolve eta.
/// \return f.f, f.g and g.g
[[nodiscard]] std::vector<double> pattern_products(const PairValues& eta, const PairValues& f, const PairValues& g,
                                                   const PatternRule& rule = {});

}  // namespace lobe::reference
