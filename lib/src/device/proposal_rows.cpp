#include "device/proposal_rows.hpp"

#include <algorithm>
#include <functional>
#include <string_view>

namespace lobe {

void ProposalRows::add(std::span<const ProposalPart> parts) {
  for (const auto& part : parts) {
    auto numbers = part.numbers;
    if (part.place_of_table < numbers.size()) numbers[part.place_of_table] = static_cast<double>(place_of(part.table));
    parts_.push_back(static_cast<double>(static_cast<unsigned>(part.strategy)));
    parts_.push_back(part.share);
    parts_.insert(parts_.end(), numbers.begin(), numbers.end());
    ++size_;
  }
}

void ProposalRows::clear() {
  *this = {};
}

std::size_t ProposalRows::place_of(const NumberTable& table) {
  const auto known = places_.find(table);
  if (known != places_.end()) return known->second;
  const std::size_t at = place_of_equal(*table);
  places_.emplace(table, at);
  return at;
}

std::size_t ProposalRows::place_of_equal(const std::vector<double>& table) {
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): bytes to hash
  const auto* const bytes = reinterpret_cast<const char*>(table.data());
  const std::size_t checksum = std::hash<std::string_view>()({bytes, table.size() * sizeof(double)});
  const auto [first, last] = places_by_checksum_.equal_range(checksum);
  for (auto known = first; known != last; ++known) {
    const std::size_t at = known->second;
    if (at + table.size() > tables_.size()) continue;
    if (std::equal(table.begin(), table.end(), tables_.begin() + static_cast<std::ptrdiff_t>(at))) return at;
  }
  const std::size_t at = tables_.size();
  tables_.insert(tables_.end(), table.begin(), table.end());
  places_by_checksum_.emplace(checksum, at);
  return at;
}

}  // namespace lobe
