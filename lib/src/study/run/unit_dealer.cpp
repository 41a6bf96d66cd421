#include "study/run/unit_dealer.hpp"

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

namespace lobe {

UnitDealer::UnitDealer(const std::vector<StudyUnit>& units, const std::function<bool(const StudyUnit&)>& is_known,
                       std::size_t takers)
    : units_(units), current_(takers, nullptr) {
  std::map<std::size_t, Group> groups;
  for (std::size_t u = units.size(); u-- > 0;) {
    if (is_known(units[u])) continue;
    Group& group = groups[units[u].group];
    group.left.push_back(u);
    ++group.units;
    group.cost += units[u].cost;
    group.shared_cost = units[u].shared_cost;
  }
  for (auto& [number, group] : groups) groups_.push_back(std::move(group));
}

UnitDealer::Group* UnitDealer::choose() {
  // What nobody has begun; of that what cannot be cut, and the largest.
  const auto urgency = [](const Group& group) { return std::tuple(group.units == 1, group.cost + group.shared_cost); };
  Group* chosen = nullptr;
  for (Group& group : groups_) {
    if (group.left.empty() || group.takers > 0) continue;
    if (chosen == nullptr || urgency(group) > urgency(*chosen)) chosen = &group;
  }
  if (chosen != nullptr) return chosen;
  // Else whoever needs help most; it is none if those there are finish before the helper has begun.
  const auto share = [](const Group& group) { return group.cost / static_cast<double>(group.takers); };
  for (Group& group : groups_) {
    if (group.left.empty() || share(group) <= group.shared_cost) continue;
    if (chosen == nullptr || share(group) - group.shared_cost > share(*chosen) - chosen->shared_cost) chosen = &group;
  }
  return chosen;
}

std::optional<std::size_t> UnitDealer::next(std::size_t taker) {
  Group*& group = current_.at(taker);
  if (group == nullptr || group->left.empty()) {
    // A group is of interest to its takers as long as it has units, and to nobody afterwards.
    group = choose();
    if (group == nullptr) return {};
    ++group->takers;
  }
  const std::size_t unit = group->left.back();
  group->left.pop_back();
  group->cost -= units_[unit].cost;
  return unit;
}

}  // namespace lobe
