#include "plot/families.hpp"

#include <algorithm>

#include "core/text.hpp"

namespace lobe {
namespace {

std::string without_family(const MaterialLabel& label) {
  const auto& [name, family] = label;
  if (family.empty() || !name.starts_with(family) || name.size() <= family.size() + 1 || name[family.size()] != ' ') {
    return name;
  }
  return std::string(trim(name.substr(family.size() + 1)));
}

bool is_sweep(std::span<const DrawnMaterial> materials, std::span<const std::size_t> members) {
  if (members.size() < 2) return false;
  const auto& first = materials[members.front()].terms;
  std::vector<bool> varies(first.empty() ? 0 : first.front().values.size(), false);
  for (const auto member : members) {
    const auto& terms = materials[member].terms;
    if (terms.size() != 1 || terms.front().model != first.front().model ||
        terms.front().values.size() != varies.size() || terms.front().weight != first.front().weight) {
      return false;
    }
    for (std::size_t i = 0; i < varies.size(); ++i) {
      varies[i] = varies[i] || terms.front().values[i] != first.front().values[i];
    }
  }
  if (std::count(varies.begin(), varies.end(), true) != 1) return false;
  const auto swept = static_cast<std::size_t>(std::find(varies.begin(), varies.end(), true) - varies.begin());
  const auto value = [&](std::size_t member) { return materials[member].terms.front().values[swept]; };
  const auto rises = [&](std::size_t a, std::size_t b) { return value(a) < value(b); };
  const auto falls = [&](std::size_t a, std::size_t b) { return value(a) > value(b); };
  return std::is_sorted(members.begin(), members.end(), rises) || std::is_sorted(members.begin(), members.end(), falls);
}

}  // namespace

FamilyOrder order_by_family(std::span<const DrawnMaterial> materials) {
  std::vector<std::pair<std::string, std::vector<std::size_t>>> families;
  for (std::size_t i = 0; i < materials.size(); ++i) {
    const auto same = [&](const auto& family) { return family.first == materials[i].label.family; };
    auto found = std::find_if(families.begin(), families.end(), same);
    if (found == families.end()) found = families.insert(found, {materials[i].label.family, {}});
    found->second.push_back(i);
  }
  FamilyOrder order;
  for (const auto& [name, members] : families) {
    const std::size_t begin = order.material.size();
    for (const auto member : members) {
      order.material.push_back(member);
      order.label.push_back(without_family(materials[member].label));
    }
    order.blocks.push_back({name, begin, order.material.size(), is_sweep(materials, members)});
  }
  return order;
}

}  // namespace lobe
