#include "model/delta.hpp"

namespace lobe {

DeltaLobe delta_lobe(const Term& term) {
  DeltaLobe lobe{term.model == "mirror" ? DeltaKind::mirror : DeltaKind::retro, term};
  lobe.term.values = {1.0};
  lobe.term.weight = {1.0};
  return lobe;
}

Term without_delta(const DeltaLobe& delta) {
  Term term = make_material("lambert").terms.front();
  term.factors = delta.term.factors;
  term.pumping = delta.term.pumping;
  return term;
}

DeltaSplit split_delta(const Material& material) {
  DeltaSplit split{{material.name, material.family, {}}, {material.name, material.family, {}}};
  for (const auto& term : material.terms) {
    (traits_of(term).has_delta ? split.deltas : split.smooth).terms.push_back(term);
  }
  return split;
}

Material smooth_part(const Material& material) {
  Material smooth = split_delta(material).smooth;
  if (smooth.terms.empty()) smooth.terms.push_back({.model = "lambert", .values = {}, .weight = {0.0}});
  if (smooth.channels() < material.channels()) {
    auto& weight = smooth.terms.front().weight;
    weight.assign(material.channels(), weight.front());
  }
  return smooth;
}

}  // namespace lobe
