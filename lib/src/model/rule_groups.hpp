#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "model/lobes.hpp"

namespace lobe {

/// Fills in LobeSet::group_of_batch and group_limits of a set that is complete but for these.
///
/// Lobes that have the same kinks and edges take one rule over one direction at the other one given: panels that end on
/// those of others are of no use to them. All that materials mix with lobes of other limits stay together, as errors of
/// two rules are independent and may cancel by accident in a mixture.
/// \param limits by batch
/// \param are_apart no: all lobes of a kind stay together, as where panels of the given direction do not end on all
///   kinks; what its levels miss levels of the other one cover
void group_by_limits(std::span<const LobeSet::Limits> limits, bool are_apart, LobeSet& lobes);

/// Batches and lobes of one group.
struct RuleGroup {
  std::size_t number;                ///< of LobeSet::group_limits
  std::vector<std::size_t> batches;  ///< rising
  std::vector<Eigen::Index> lobes;   ///< columns, in the order of the batches
};

/// The groups that have lobes, by number.
[[nodiscard]] std::vector<RuleGroup> rule_groups(const LobeSet& lobes);

/// Columns of the lobes of batches, in their order.
[[nodiscard]] std::vector<Eigen::Index> columns_of(const LobeSet& lobes, std::span<const std::size_t> batches);

}  // namespace lobe
