#include "model/factors.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "core/text.hpp"
#include "lobe/core/error.hpp"
#include "model/catalogue.hpp"
#include "model/family/parameters.hpp"

namespace lobe {
namespace {

using Pair = std::array<double, kFactorCoefficients>;

/// In alphabetical order.
std::vector<FactorEntry> make_factors() {
  std::vector<FactorEntry> entries;
  entries.push_back(
      {{"cos_max",
        "1 / max(N.L, N.V)^p",
        "Neumann 2001, eq. 2.22, 3.12 and 3.34: makes a metal of a lobe whose albedo falls towards grazing "
        "angles",
        {{"p", "1", 0, 1, 1.0, "0 leaves the model as it is, 1 is a metal"}}},
       [](Values v) {
         return Pair{-v[0], 0};
       },
       nullptr,
       [](Values v) {
         return GrazingGrowth{0, v[0], v[0]};
       }});

  entries.push_back({{"fresnel",
                      "F(ior, k, L.H), Fresnel's equations for the refractive index ior - ik",
                      "Neumann 2001, eq. 1.41 to 1.43, the squares as |.|^2: what a smooth boundary reflects",
                      {refractive_index(), extinction()}},
                     [](Values v) {
                       return Pair{v[0], v[1]};
                     },
                     nullptr,
                     nullptr,
                     [](Values v) { return critical_kinks(v[0], v[1]); }});

  entries.push_back(
      {{"half_cosine",
        "(N.H)^alpha",
        "Neumann 2001, 5.2.3 and eq. 5.9: the character of the spherical bisecting direction, for patches "
        "of any form",
        {{"alpha", "1", -1, 2, -1.0, "power; below 0 the lobe is brighter towards grazing angles"}}},
       [](Values v) {
         return Pair{v[0], 0};
       },
       nullptr,
       [](Values v) { return GrazingGrowth{.retro = -v[0]}; }});

  entries.push_back({{"lacquer",
                      "exp(-s (1/N.L + 1/N.V))",
                      "Neumann 2001, eq. 1.60 and 1.61 (s >= 0, not the printed s <= 0): a layer of lacquer above the "
                      "material",
                      {{"s", "1", 0, 100, std::nullopt, "absorption of the layer along the normal"}}},
                     [](Values v) {
                       return Pair{-v[0], 0};
                     },
                     [](Values v) { return v[0] > 0; }});

  entries.push_back({{"power_mean",
                      "mean_p(N.L, N.V)^alpha, mean_p(x, y) = ((x^p + y^p)/2)^(1/p)",
                      "Neumann 2001, 5.2.3 and eq. 5.9: the character of power means, for patches of any form; p = 0 "
                      "is the geometric "
                      "mean, p = -1 the harmonic one",
                      {{"p", "1", -1, 100, 1.0, "power of the mean"},
                       {"alpha", "1", -1, 1, -1.0, "power of the character; -1 makes a metal of a patch"}}},
                     [](Values v) {
                       return Pair{v[0], v[1]};
                     },
                     nullptr,
                     [](Values v) {
                       const double alone = v[0] < 0 ? -v[1] : v[0] == 0 ? -v[1] / 2 : 0;
                       return GrazingGrowth{alone, -v[1], -v[1]};
                     }});

  entries.push_back(
      {{"sandwich",
        "1 / (2 + k (1/N.L + 1/N.V))^n",
        "Neumann 2001, eq. 1.62 (n = 1) and 1.63: infinitely many layers of lacquer with flecks of the material "
        "between them; k is the inverse of what the text says",
        {{"k", "1", 0, 1e4, std::nullopt, "absorbed by reflected share of the light of a layer"},
         {"n", "1", 0, 20, 1.0, "order: flecks that are sandwiches themselves"}}},
       [](Values v) {
         return Pair{v[0], -v[1]};
       },
       [](Values v) { return v[0] > 0 && v[1] >= 1; }});

  entries.push_back({{"transmission",
                      "1 - F(ior, k, L.H)",
                      "Neumann 2001, eq. 1.61: what a smooth boundary above the material lets pass",
                      {refractive_index(), extinction()}},
                     [](Values v) {
                       return Pair{v[0], v[1]};
                     },
                     nullptr,
                     nullptr,
                     [](Values v) { return critical_kinks(v[0], v[1]); }});
  return entries;
}

std::span<const FactorEntry> factor_entries() {
  static const std::vector<FactorEntry> entries = make_factors();
  return entries;
}

}  // namespace

std::span<const FactorModel> factors() {
  static const std::vector<FactorModel> list = [] {
    std::vector<FactorModel> models;
    for (const auto& entry : factor_entries()) models.push_back(entry.factor);
    return models;
  }();
  return list;
}

const FactorEntry& find_factor_entry(std::string_view name) {
  const auto entries = factor_entries();
  const auto found = std::ranges::find(entries, name, [](const FactorEntry& entry) { return entry.factor.name; });
  if (found != entries.end()) return *found;
  std::vector<std::string_view> names;
  for (const auto& entry : entries) names.push_back(entry.factor.name);
  throw ArgumentError("unknown factor '" + std::string(name) + "'" + did_you_mean(name, names));
}

const FactorModel& find_factor(std::string_view name) {
  return find_factor_entry(name).factor;
}

}  // namespace lobe
