#include "model/delta.hpp"

namespace lobe {

DeltaSplit split_delta(const Material& material) {
  const std::size_t channels = material.channels();
  DeltaSplit split{{material.name, material.family, {}}, std::vector<double>(channels), std::vector<double>(channels)};
  for (const auto& term : material.terms) {
    if (!traits_of(term).has_delta) {
      split.smooth.terms.push_back(term);
      continue;
    }
    auto& factors = term.model == "mirror" ? split.mirror : split.retro;
    for (std::size_t c = 0; c < channels; ++c) {
      factors[c] += term.values.front() * term.weight[term.weight.size() == 1 ? 0 : c];
    }
  }
  return split;
}

}  // namespace lobe
