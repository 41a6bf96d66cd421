#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "algebra/operator_blocks.hpp"
#include "lobe/device/device.hpp"
#include "lobe/table/table.hpp"

namespace lobe {

/// The operator of a table whose formulas are known, on another grid: what errors of the grid are judged by.
class FormulaTable {
 public:
  /// Tabulates all factors on the gauss grid that a table is to be compared with: of 2.4 times as many rings and three
  /// times as many azimuths; of half as many above 128 rings, where that would take too long.
  /// \return none where the formulas are not known, or delta parts vary with the angle
  [[nodiscard]] static std::optional<FormulaTable> make(const Device& device, const BrdfTable& table);

  /// Whether the grid is finer than the table's, not coarser.
  [[nodiscard]] bool is_finer() const { return is_finer_; }

  /// Blocks of the smooth part of a channel by azimuthal order, whatever the form of the table.
  [[nodiscard]] OperatorBlocks smooth_blocks(std::size_t channel) const;

  /// A table of its shape and delta parts, its values and errors not set.
  [[nodiscard]] const BrdfTable& frame() const { return frame_; }

 private:
  FormulaTable() = default;

  bool is_finer_ = true;
  std::vector<BrdfTable> factors_;
  BrdfTable frame_;
};

/// Bytes of a factor on the grid that a table is compared with.
/// \param table a shape is enough
[[nodiscard]] std::uint64_t compared_bytes(const BrdfTable& table);

}  // namespace lobe
