#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "model/lobes.hpp"

namespace lobe {

/// Fills in LobeSet::group_of_batch and group_limits of a set that is complete but for these.
///
/// Lobes that are smooth in the same places take one rule over one direction at the other one given: panels that end on
/// the kinks and edges of others are of no use to them. All that materials mix with lobes of other limits stay
/// together, as errors of two rules are independent and may cancel by accident in a mixture; and all lobes where the
/// set has more kinks than panels of the given direction end on, as what its levels miss levels of the other one cover.
/// \param limits by batch
void group_by_limits(std::span<const LobeSet::Limits> limits, LobeSet& lobes);

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
