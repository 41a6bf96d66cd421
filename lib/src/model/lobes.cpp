#include "model/lobes.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "core/text.hpp"
#include "lobe/error.hpp"
#include "model/catalogue.hpp"
#include "model/traits.hpp"

namespace lobe {
namespace {

std::string describe(const Model& model, const std::vector<double>& values) {
  std::string text(model.name);
  for (std::size_t i = 0; i < values.size(); ++i) {
    text += (i == 0 ? "(" : ", ") + std::string(model.parameters[i].name) + "=" + shortest(values[i]);
  }
  return values.empty() ? text : text + ")";
}

double aspect_of(const CatalogueEntry& entry, const std::vector<double>& values) {
  if (entry.model.traits.isotropic) return 0;
  return entry.aspect == nullptr ? 1 : entry.aspect(values);
}

}  // namespace

LobeSet make_lobe_set(std::span<const Material> materials, LobeKinds kinds) {
  if (materials.empty()) throw ArgumentError("no materials; expected at least one");
  std::size_t channels = 1;
  for (const auto& material : materials) channels = std::max(channels, material.channels());

  // Lobes with the same kernel and coefficients are the same function.
  struct Lobe {
    std::string name;
    double width;
    double retro_width;
    bool is_infinite;
    bool is_anisotropic;
    double aspect;  ///< 0 of isotropic lobes
  };
  std::map<std::pair<std::string_view, Coefficients>, Lobe> distinct;
  std::set<std::string_view> deltas;
  for (const auto& material : materials) {
    if (material.terms.empty()) throw ArgumentError("material '" + material.name + "' has no terms");
    for (const auto& term : material.terms) {
      const CatalogueEntry& entry = find_entry(term.model);
      if (!entry.model.traits.isotropic && !kinds.with_anisotropic) refuse_anisotropic(material.name, term.model);
      if (!entry.model.traits.has_delta) {
        distinct.try_emplace({entry.kernel, entry.coefficients(term.values)},
                             Lobe{describe(entry.model, term.values), entry.width(term.values),
                                  entry.retro_width == nullptr ? 1 : entry.retro_width(term.values),
                                  entry.has_infinite_norm != nullptr && entry.has_infinite_norm(term.values),
                                  !entry.model.traits.isotropic, aspect_of(entry, term.values)});
      } else if (kinds.with_deltas) {
        deltas.insert(entry.model.name);
      } else {
        throw NumericError("material '" + material.name + "' contains the delta part '" + term.model +
                           "', which has no values in sr^-1 and an infinite norm under point light; daylight and patch "
                           "lights take it, and so does 'lobe tabulate'");
      }
    }
  }
  if (distinct.empty()) {  // quadrature and sampling want a lobe, if only as a rule for delta parts
    const CatalogueEntry& lambert = find_entry("lambert");
    distinct.try_emplace({lambert.kernel, lambert.coefficients({})},
                         Lobe{"lambert", lambert.width({}), 1, false, false, 0});
  }
  LobeSet set;
  std::map<std::pair<std::string_view, Coefficients>, std::size_t> column;
  for (const auto& [key, lobe] : distinct) {
    if (set.batches.empty() || set.batches.back().kernel != key.first) {
      set.batches.push_back({key.first, {}, lobe.is_anisotropic});
    }
    set.batches.back().coefficients.push_back(key.second);
    column.emplace(key, set.names.size());
    set.names.push_back(lobe.name);
    if (lobe.is_infinite) set.infinite.push_back(lobe.name);
    set.narrowest = std::min(set.narrowest, lobe.width);
    set.narrowest_retro = std::min(set.narrowest_retro, lobe.retro_width);
    set.aspect = std::max(set.aspect, lobe.aspect);
  }
  std::map<std::string_view, std::size_t> delta_column;
  for (const std::string_view name : deltas) {
    delta_column.emplace(name, set.names.size());
    set.names.emplace_back(name);
    set.deltas.push_back(name == "mirror" ? DeltaKind::mirror : DeltaKind::retro);
  }

  std::set<double> radii;
  std::set<double> retro_radii;
  std::vector<std::vector<Eigen::Triplet<double>>> entries(channels);
  for (std::size_t i = 0; i < materials.size(); ++i) {
    for (const auto& term : materials[i].terms) {
      if (term.weight.size() != 1 && term.weight.size() != channels) {
        throw ArgumentError("material '" + materials[i].name + "' has a weight for " +
                            std::to_string(term.weight.size()) + " channels; expected 1 or " +
                            std::to_string(channels));
      }
      const CatalogueEntry& entry = find_entry(term.model);
      const bool is_delta = entry.model.traits.has_delta;
      if (!is_delta && entry.patch_radius != nullptr) radii.insert(entry.patch_radius(term.values));
      if (!is_delta && entry.retro_patch_radius != nullptr) retro_radii.insert(entry.retro_patch_radius(term.values));
      const std::size_t lobe =
          is_delta ? delta_column.at(entry.model.name) : column.at({entry.kernel, entry.coefficients(term.values)});
      const double share = is_delta ? term.values.front() : 1;
      for (std::size_t c = 0; c < channels; ++c) {
        const double weight = term.weight.size() == 1 ? term.weight.front() : term.weight[c];
        entries[c].emplace_back(static_cast<int>(i), static_cast<int>(lobe), share * weight);
      }
    }
  }
  set.patch_radii.assign(radii.begin(), radii.end());
  set.retro_patch_radii.assign(retro_radii.begin(), retro_radii.end());
  for (const auto& list : entries) {
    Eigen::SparseMatrix<double, Eigen::RowMajor> mix(static_cast<Eigen::Index>(materials.size()),
                                                     static_cast<Eigen::Index>(set.lobes()));
    mix.setFromTriplets(list.begin(), list.end());
    set.mix.push_back(std::move(mix));
  }
  return set;
}

}  // namespace lobe
