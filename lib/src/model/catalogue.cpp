#include "model/catalogue.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/text.hpp"
#include "lobe/core/error.hpp"
#include "model/catalogue/entries.hpp"

namespace lobe {
namespace {

std::vector<CatalogueEntry> make_catalogue() {
  std::vector<CatalogueEntry> entries;
  add_diffuse_models(entries);
  add_cosine_lobes(entries);
  add_microfacet_models(entries);
  add_patch_models(entries);
  add_anisotropic_models(entries);
  add_delta_parts(entries);
  std::ranges::sort(entries, {}, [](const CatalogueEntry& entry) { return entry.model.name; });
  return entries;
}

}  // namespace

Parameter exponent() {
  return {"n", "1", 1e-3, 1e10, std::nullopt, "exponent; larger is sharper"};
}

// Smaller values would leave the range of a double, squared.
Parameter roughness() {
  return {"m", "1", 1e-5, 100, std::nullopt, "rms slope of the microfacets; smaller is sharper"};
}

Parameter normal_reflectance() {
  return {"f0", "1", 0, 1, 1.0, "Fresnel reflectance at normal incidence"};
}

Parameter refractive_index() {
  return {"ior", "1", 0.01, 100, std::nullopt, "refractive index; of metals its real part"};
}

Parameter extinction() {
  return {"k", "1", 0, 100, 0.0, "extinction coefficient, the imaginary part; 0 for dielectrics"};
}

double mirror_lobe_width(double n) {
  return std::min(1.0, 1 / std::sqrt(2 * n));
}

double retro_lobe_width(double n) {
  return std::min(0.5, mirror_lobe_width(n));
}

double half_lobe_width(double n) {
  return std::min(1.0, std::sqrt(2 / n));
}

std::span<const CatalogueEntry> catalogue_entries() {
  static const std::vector<CatalogueEntry> entries = make_catalogue();
  return entries;
}

std::span<const Model> catalogue() {
  static const std::vector<Model> models = [] {
    std::vector<Model> list;
    for (const auto& entry : catalogue_entries()) list.push_back(entry.model);
    return list;
  }();
  return models;
}

const CatalogueEntry& find_entry(std::string_view name) {
  const auto entries = catalogue_entries();
  const auto found = std::find_if(entries.begin(), entries.end(), [&](const auto& e) { return e.model.name == name; });
  if (found != entries.end()) return *found;
  std::vector<std::string_view> names;
  for (const auto& entry : entries) names.push_back(entry.model.name);
  const std::string near = nearest_word(name, names);
  throw ArgumentError("unknown model '" + std::string(name) + "'; " +
                      (near.empty() ? "'lobe models' lists those that there are" : "did you mean '" + near + "'?"));
}

const Model& find_model(std::string_view name) {
  const auto index = static_cast<std::size_t>(&find_entry(name) - catalogue_entries().data());
  return catalogue()[index];
}

}  // namespace lobe
