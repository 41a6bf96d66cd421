#include "model/sampling_strategy.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include "model/catalogue.hpp"
#include "model/draw.hpp"

namespace lobe {
namespace {

std::string_view name_of(const ProposalPart& part) {
  switch (part.strategy) {
    case Strategy::cosine:
      return "cosine";
    case Strategy::power:
      return part.numbers[6] == 0 ? "uniform" : part.numbers[7] != 0 ? "power on the inner sphere" : "power";
    case Strategy::beckmann:
      return "Beckmann facets";
    case Strategy::cosine_facets:
      return "cosine-power facets";
    case Strategy::visible_facets:
      return "visible facets";
    case Strategy::patch:
      return "patch";
    case Strategy::patch_mixture:
      return "patches by F^-1";
    case Strategy::cells:
      return "cells";
    case Strategy::delta:
      return "delta";
  }
  return {};
}

}  // namespace

std::vector<ProposalPart> propose(const Term& term, const UnitVector& light, PatchDraw patches) {
  if (term.formula) return draw::general(light, term.formula->width, 1);
  const CatalogueEntry& entry = find_entry(term.model);
  if (entry.proposal != nullptr) return entry.proposal(term.values, {light, patches});
  const LobeShape shape = entry.shape(term.values);
  return draw::general(light, shape.width, shape.retro_width);
}

std::string sampling_strategy_text(const Term& term) {
  constexpr double kAside = 0.6;
  const UnitVector light{kAside, 0, std::sqrt(1 - kAside * kAside)};
  std::vector<std::string_view> names;
  for (const auto& part : propose(term, light, PatchDraw::exact)) {
    if (std::ranges::find(names, name_of(part)) == names.end()) names.push_back(name_of(part));
  }
  std::string text;
  for (const auto name : names) text += (text.empty() ? "" : ", ") + std::string(name);
  return text;
}

}  // namespace lobe
