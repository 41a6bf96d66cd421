#include "study/run/study_channels.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "lobe/core/error.hpp"

namespace lobe {

Study with_channels(Study study) {
  std::size_t count = 1;
  for (const Material& formula : formulas(study)) count = std::max(count, formula.channels());
  if (study.channels.empty()) {
    if (count == 1) study.channels = {"value"};
    for (std::size_t i = 1; count > 1 && i <= count; ++i) study.channels.push_back(std::to_string(i));
  }
  // Where all materials are grey, one of them says how many channels there are.
  const auto first = std::ranges::find_if(study.materials,
                                          [](const StudyMaterial& material) { return material.formula() != nullptr; });
  if (count < study.channels.size() && first != study.materials.end()) {
    Material formula = *first->formula();
    for (Term& term : formula.terms) term.weight.resize(study.channels.size(), term.weight.front());
    *first = std::move(formula);
  }
  count = study.channels.size();
  if (study.channel_weights.empty()) study.channel_weights.assign(count, 1.0 / static_cast<double>(count));
  if (study.channel_weights.size() != count) {
    throw ArgumentError("study has " + std::to_string(count) + " channels and " +
                        std::to_string(study.channel_weights.size()) + " channel weights; expected as many");
  }
  return study;
}

}  // namespace lobe
