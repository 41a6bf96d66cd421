#include "model/catalogue.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "core/text.hpp"
#include "lobe/core/error.hpp"

namespace lobe {

// A line LOBE_MODEL(<model>) for each file of model/catalogue (lib/CMakeLists.txt).
using MakeEntry = CatalogueEntry();
#define LOBE_MODEL(model) MakeEntry model##_entry;
#include "models.inc"
#undef LOBE_MODEL

namespace {

std::vector<CatalogueEntry> make_catalogue() {
  std::vector<CatalogueEntry> entries;
#define LOBE_MODEL(model) entries.push_back(model##_entry());
#include "models.inc"
#undef LOBE_MODEL
  std::ranges::sort(entries, {}, [](const CatalogueEntry& entry) { return entry.model.name; });
  return entries;
}

}  // namespace

std::span<const CatalogueEntry> catalogue_entries() {
  static const std::vector<CatalogueEntry> entries = make_catalogue();
  return entries;
}

std::span<const KnownModel> known_models() {
  static const std::vector<KnownModel> models = [] {
    std::vector<KnownModel> list;
    for (const auto& entry : catalogue_entries()) {
      if (!entry.known) continue;
      const auto& [material, coefficients, values] = *entry.known;
      list.push_back({entry.kernel, !entry.model.traits.isotropic, material, coefficients, values});
    }
    std::ranges::sort(list, {}, &KnownModel::kernel);
    return list;
  }();
  return models;
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
  throw ArgumentError(
      "unknown model '" + std::string(name) + "'" + (near.empty() ? "" : "; did you mean '" + near + "'?"),
      {.topic = Topic::models});
}

const Model& find_model(std::string_view name) {
  const auto index = static_cast<std::size_t>(&find_entry(name) - catalogue_entries().data());
  return catalogue()[index];
}

std::string_view kernel_name(std::string_view model) {
  return find_entry(model).kernel;
}

}  // namespace lobe
