#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <vector>

#include "device/draw_directions.hpp"

namespace lobe {

/// Parts of densities as kernels/sampling/proposal.clh reads them. Equal tables are kept once.
class ProposalRows {
 public:
  /// Adds the parts of one density behind those before.
  void add(std::span<const ProposalPart> parts);
  /// Forgets all of them.
  void clear();

  /// Number of parts.
  [[nodiscard]] std::size_t size() const { return size_; }
  /// PART_NUMBERS for each part.
  [[nodiscard]] const std::vector<double>& parts() const { return parts_; }
  /// Tables of the parts, at least one number: a buffer has to hold something.
  [[nodiscard]] const std::vector<double>& tables() const { return tables_; }

 private:
  [[nodiscard]] std::size_t place_of(const NumberTable& table);
  /// Of numbers that may stand in another table.
  [[nodiscard]] std::size_t place_of_equal(const std::vector<double>& table);

  std::size_t size_ = 0;
  std::vector<double> parts_;
  std::vector<double> tables_{0};
  std::map<NumberTable, std::size_t> places_;                   ///< of the tables
  std::multimap<std::size_t, std::size_t> places_by_checksum_;  ///< of their numbers
};

}  // namespace lobe
