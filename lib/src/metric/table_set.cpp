#include "metric/table_set.hpp"

#include <algorithm>

#include "table/isotropic_mean.hpp"

namespace lobe {
namespace {

bool is_general(const BrdfTable& table) {
  return table.form == TableForm::general;
}

}  // namespace

TableSet::TableSet(std::span<const BrdfTable* const> tables, const TableLight& light)
    : tables_(tables.begin(), tables.end()), light_(light), means_(tables_), rest_(tables_.size()) {
  const auto general = std::ranges::count_if(tables, [](const BrdfTable* table) { return is_general(*table); });
  if (general == 0 || general == static_cast<std::ptrdiff_t>(tables.size())) return;
  for (std::size_t i = 0; i < tables_.size(); ++i) {
    if (!light_.is_isotropic()) tables_[i] = &made_.emplace_back(to_general(*tables_[i]));
    if (!light_.is_isotropic() || !is_general(*tables_[i])) continue;
    means_[i] = &made_.emplace_back(isotropic_mean(*tables_[i]));
    rest_[i] = light_.squared_distances(*tables_[i], to_general(*means_[i]));
  }
}

const BrdfTable& TableSet::of_pair(std::size_t i, std::size_t other) const {
  return is_general(*tables_[i]) == is_general(*tables_[other]) ? *tables_[i] : *means_[i];
}

std::vector<Estimate> TableSet::products(std::size_t i, std::size_t j) const {
  return light_.products(of_pair(i, j), of_pair(j, i));
}

std::vector<Estimate> TableSet::squared_distances(std::size_t i, std::size_t j) const {
  std::vector<Estimate> squares = light_.squared_distances(of_pair(i, j), of_pair(j, i));
  if (is_general(*tables_[i]) == is_general(*tables_[j])) return squares;
  const auto& rest = is_general(*tables_[i]) ? rest_[i] : rest_[j];
  for (std::size_t c = 0; c < squares.size(); ++c) squares[c] += rest[c];
  return squares;
}

}  // namespace lobe
