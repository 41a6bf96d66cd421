#include "algebra/operands.hpp"

#include <algorithm>
#include <string>

#include "lobe/core/error.hpp"

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
  repeat(table.even_error, channels);
  repeat(table.odd_part, channels);
  for (auto& factor : table.factors) {
    repeat(factor.in, channels);
    repeat(factor.out, channels);
  }
  table.channels = channels;
  table.channel_names.clear();
}

}  // namespace

OperandShape common_shape(std::span<const BrdfTable* const> tables, bool exact_grid) {
  const BrdfTable& first = *tables.front();
  OperandShape shape{first.grid};
  for (const BrdfTable* table : tables) {
    shape.channels = std::max(shape.channels, table->channels);
    if (table->form == TableForm::general) shape.form = TableForm::general;
    if (exact_grid && !(table->grid == first.grid)) {
      throw ArgumentError("'" + first.expression + "' is on grid " + first.grid.name() + " and '" + table->expression +
                              "' on " + table->grid.name() + "; expected the same grid",
                          {.fault = Fault::other_grid, .grid = first.grid.name()});
    }
  }
  for (const BrdfTable* table : tables) {
    if (table->channels == 1 || table->channels == shape.channels) continue;
    throw ArgumentError("'" + table->expression + "' has " + std::to_string(table->channels) +
                        " channels; expected 1 or " + std::to_string(shape.channels));
  }
  return shape;
}

Operands::Operands(std::span<const BrdfTable* const> tables, const OperandShape& shape, const Mover& move) {
  for (const BrdfTable* table : tables) {
    if (!shape.fits(*table)) {
      BrdfTable made = table->grid == shape.grid ? *table : move(*table, shape.grid);
      if (made.channels != shape.channels) repeat_channel(made, shape.channels);
      made_.push_back(shape.keeps_forms || made.form == shape.form ? std::move(made) : to_general(made));
      table = &made_.back();
    }
    tables_.push_back(table);
  }
}

}  // namespace lobe
