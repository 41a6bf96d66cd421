#pragma once

#include <list>
#include <span>
#include <vector>

#include "lobe/table/table.hpp"
#include "metric/table_products.hpp"

namespace lobe {

/// Tables on one grid whose pairs are measured. Where some are isotropic and others general, a general one is split
/// into its isotropic mean and the rest, to which isotropic ones are orthogonal: only pairs of general ones cost what
/// these cost.
class TableSet {
 public:
  /// \param tables on one grid, with one number of channels; they must outlive this, and so must `light`
  TableSet(std::span<const BrdfTable* const> tables, const TableLight& light);

  /// f_i . f_j and |f_i - f_j|^2 of each channel.
  /// \throws as TableLight
  [[nodiscard]] std::vector<Estimate> products(std::size_t i, std::size_t j) const;
  [[nodiscard]] std::vector<Estimate> squared_distances(std::size_t i, std::size_t j) const;

 private:
  /// The tables as they are, or the means of a pair of which one alone is general.
  [[nodiscard]] const BrdfTable& of_pair(std::size_t i, std::size_t other) const;

  std::vector<const BrdfTable*> tables_;
  const TableLight& light_;
  std::list<BrdfTable> made_;
  std::vector<const BrdfTable*> means_;      ///< isotropic ones by themselves
  std::vector<std::vector<Estimate>> rest_;  ///< squared norms beside the mean, by table and channel; empty: none
};

}  // namespace lobe
