#include "algebra/operands.hpp"

#include <algorithm>
#include <string>

#include "lobe/error.hpp"

namespace lobe {
namespace {

template <typename Numbers>
void repeat(Numbers& numbers, std::size_t times) {
  const std::size_t size = numbers.size();
  numbers.resize(size * times);
  for (std::size_t k = 1; k < times; ++k) {
    std::copy_n(numbers.begin(), size, numbers.begin() + static_cast<std::ptrdiff_t>(k * size));
  }
}

void repeat_channel(BrdfTable& table, std::size_t channels) {
  repeat(table.values, channels);
  repeat(table.mirror, channels);
  repeat(table.retro, channels);
  repeat(table.error, channels);
  for (auto& factor : table.factors) {
    repeat(factor.in, channels);
    repeat(factor.out, channels);
  }
  table.channels = channels;
}

}  // namespace

void require_same_grid(const BrdfTable& first, const BrdfTable& other, bool exact_grid) {
  if (!exact_grid || first.grid == other.grid) return;
  throw ArgumentError("'" + first.expression + "' is on grid " + first.grid.name() + " and '" + other.expression +
                      "' on " + other.grid.name() + "; expected the same grid (--exact-grid)");
}

void match_operands(std::span<BrdfTable> tables) {
  std::size_t channels = 1;
  for (const auto& table : tables) channels = std::max(channels, table.channels);
  const bool is_general = std::ranges::any_of(tables, [](const auto& t) { return t.form == TableForm::general; });
  for (auto& table : tables) {
    if (table.channels != 1 && table.channels != channels) {
      throw ArgumentError("'" + table.expression + "' has " + std::to_string(table.channels) +
                          " channels; expected 1 or " + std::to_string(channels));
    }
    if (table.channels != channels) repeat_channel(table, channels);
    if (is_general) table = to_general(table);
  }
}

}  // namespace lobe
