#include "table/lobe_tabulator.hpp"

#include <algorithm>

#include "model/traits.hpp"

namespace lobe {

LobeTabulator::LobeTabulator(const Device& device, const Material& material, Precision precision)
    : device_(device), precision_(precision) {
  if (!material.terms.empty()) lobes_ = make_lobe_set({&material, 1}, {.with_anisotropic = true});
  is_reciprocal_ = lobe::is_reciprocal(material);
}

WeightedLobe LobeTabulator::place(std::size_t lobe, double weight) const {
  std::size_t batch = 0;
  for (; lobe >= lobes_.batches[batch].coefficients.size(); ++batch) lobe -= lobes_.batches[batch].coefficients.size();
  return {batch, lobe, weight};
}

void LobeTabulator::channel(std::size_t channel, const DirectionSet& rows, const DirectionSet& columns,
                            std::span<const unsigned> first_column, std::span<double> values) const {
  std::vector<WeightedLobe> weighted;
  for (std::size_t i = 0; i < lobes_.lobes(); ++i) {
    const auto& mix = lobes_.mix[std::min(channel, lobes_.channels() - 1)];  // one channel serves all
    weighted.push_back(place(i, mix.coeff(0, static_cast<Eigen::Index>(i))));
  }
  tabulate_pairs(device_, lobes_.batches, weighted, precision_, rows, columns, first_column, values);
}

void LobeTabulator::lobe(std::size_t lobe, const DirectionSet& rows, const DirectionSet& columns,
                         std::span<double> values) const {
  const WeightedLobe weighted = place(lobe, 1);
  tabulate_pairs(device_, lobes_.batches, {&weighted, 1}, precision_, rows, columns, {}, values);
}

}  // namespace lobe
