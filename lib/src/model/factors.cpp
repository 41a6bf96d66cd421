#include "model/factors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "core/text.hpp"
#include "lobe/core/error.hpp"
#include "model/catalogue.hpp"
#include "model/family/fresnel.hpp"
#include "model/family/parameters.hpp"

namespace lobe {
namespace {

using Pair = std::array<double, kFactorCoefficients>;

constexpr double kEdge = 1.0 / 7;  // cosine at which the edge term is largest, at about 82 degrees

/// What the edge term takes away there.
double edge_drop(Values v) {
  return (1 - v[1]) * (v[0] + (1 - v[0]) * std::pow(1 - kEdge, 5));
}

/// Factor of x (1 - x)^6 in the edge term.
double edge_height(Values v) {
  return edge_drop(v) / (kEdge * std::pow(1 - kEdge, 6));
}

/// Without the bound at 0.
double f82_term(Values v, double cosine) {
  return v[0] + (1 - v[0]) * std::pow(1 - cosine, 5) - edge_height(v) * cosine * std::pow(1 - cosine, 6);
}

/// Where it becomes 0.
std::vector<Kink> f82_kinks(Values v) {
  constexpr int kSteps = 64;
  constexpr std::array kRange{PanelEdge{0, false}, PanelEdge{1, false}};
  std::vector<PanelEdge> zeros;
  append_zeros([&](double cosine) { return f82_term(v, cosine); }, kRange, kSteps, false, zeros);
  std::vector<Kink> kinks;
  for (const PanelEdge& zero : zeros) kinks.push_back(difference_kink(zero.at, 1));
  return kinks;
}

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

  entries.push_back(
      {{"f82",
        "max(0, f0 + (1-f0)(1-x)^5 - d x (1-x)^6), x = L.H, d = (1-tint) (f0 + (1-f0)(6/7)^5) 7^7/6^6",
        "Kutz, Hasan, Edmondson 2021, with the tint of OpenPBR 1.1: Schlick's approximation for metals, times tint at "
        "82 degrees, where L.H = 1/7; for models with f0 = 1",
        {normal_reflectance(), {"tint", "1", 0, 1, 1.0, "share of Schlick's approximation at 82 degrees; 1 is his"}}},
       [](Values v) {
         return Pair{v[0], edge_height(v)};
       },
       nullptr,
       nullptr,
       f82_kinks,
       [](Values v, double cosine) { return std::max(0.0, f82_term(v, cosine)); }});

  entries.push_back({{"fresnel",
                      "F(ior, k, L.H), Fresnel's equations for the refractive index ior - ik",
                      "Neumann 2001, eq. 1.41 to 1.43, the squares as |.|^2: what a smooth boundary reflects",
                      {refractive_index(), extinction()}},
                     [](Values v) {
                       return Pair{v[0], v[1]};
                     },
                     nullptr,
                     nullptr,
                     [](Values v) { return critical_kinks(v[0], v[1]); },
                     [](Values v, double cosine) { return fresnel_reflectance(cosine, v[0], v[1]); }});

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
