#pragma once

#include <array>
#include <span>
#include <string_view>
#include <vector>

#include "hemisphere/kink.hpp"
#include "lobe/model/model.hpp"

namespace lobe {

/// How many factors a term may have, and how many constants each gets: c10 to c15 of kernels/lobes/combined.clh.
inline constexpr std::size_t kMaxFactors = 3;
inline constexpr std::size_t kFactorCoefficients = 2;

/// Powers of 1 / N.L with which a factor grows as L approaches the horizon.
struct GrazingGrowth {
  double alone = 0;   ///< V elsewhere
  double mirror = 0;  ///< V the mirror direction
  double retro = 0;   ///< V = L
};

/// A factor and how the device computes it.
struct FactorEntry {
  FactorModel factor;
  /// Constants of factor_<name> in kernels/factors/<name>.clh.
  /// \param values one per parameter
  std::array<double, kFactorCoefficients> (*coefficients)(std::span<const double> values);
  /// Falls at grazing angles so fast that no norm of what it multiplies is infinite; null where it never does.
  bool (*makes_norms_finite)(std::span<const double> values) = nullptr;
  /// How it grows at grazing angles; null where it does not.
  GrazingGrowth (*growth)(std::span<const double> values) = nullptr;
  /// As CatalogueEntry::kinks.
  std::vector<Kink> (*kinks)(std::span<const double> values) = nullptr;
  /// Value of a factor that is the Fresnel term of facets, a function of L.H alone; null for others.
  double (*fresnel)(std::span<const double> values, double cosine) = nullptr;
};

/// \throws ArgumentError for an unknown name, with the nearest known one.
[[nodiscard]] const FactorEntry& find_factor_entry(std::string_view name);

}  // namespace lobe
