#pragma once

#include <functional>
#include <list>
#include <span>

#include "lobe/table/table.hpp"

namespace lobe {

/// Operands as a product or a sum needs them: on the grid of the first, general if one of them is, with the
/// largest number of channels (a single one serves all).
struct OperandShape {
  HemisphereGrid grid;
  TableForm form = TableForm::isotropic;
  std::size_t channels = 1;
  bool keeps_forms = false;  ///< leave isotropic tables so beside general ones

  [[nodiscard]] bool fits(const BrdfTable& table) const {
    return table.grid == grid && (keeps_forms || table.form == form) && table.channels == channels;
  }
};

/// \throws ArgumentError for channel counts that do not fit, and for different grids where `exact_grid` is true.
[[nodiscard]] OperandShape common_shape(std::span<const BrdfTable* const> tables, bool exact_grid);

/// Tables in a common shape: the callers' own where they have it, else others made from them.
class Operands {
 public:
  /// Brings a table to another grid.
  using Mover = std::function<BrdfTable(const BrdfTable& table, const HemisphereGrid& grid)>;

  /// \param tables must outlive this
  Operands(std::span<const BrdfTable* const> tables, const OperandShape& shape, const Mover& move);

  [[nodiscard]] const BrdfTable& operator[](std::size_t index) const { return *tables_[index]; }
  [[nodiscard]] std::size_t size() const { return tables_.size(); }
  [[nodiscard]] std::span<const BrdfTable* const> all() const { return tables_; }

 private:
  std::vector<const BrdfTable*> tables_;
  std::list<BrdfTable> made_;
};

}  // namespace lobe
