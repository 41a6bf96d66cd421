#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace lobe {

/// Sides of a product that a table is transformed for; transform_isotropic.cl takes them as bits.
enum class Sides : unsigned { left = 1, right = 2, both = 3 };

/// Orders first .. end-1, in the sequence of the stages, which are done together.
struct OrderRange {
  std::size_t first, end;

  [[nodiscard]] std::size_t count() const { return end - first; }
};

/// Device memory of a product of isotropic tables: two transformed tables and their product, order by order.
struct IsotropicWorkspace {
  std::size_t left, right, product;  ///< bytes per order
  std::size_t fixed;                 ///< bytes of coefficients and scale

  /// How many orders fit into `limit` bytes, with no buffer larger than `largest` bytes; may be none.
  [[nodiscard]] std::size_t orders_within(std::uint64_t limit, std::uint64_t largest) const {
    const std::uint64_t room = limit > fixed ? limit - fixed : 0;
    return std::min(room / (left + right + product), largest / std::max({left, right, product}));
  }

  [[nodiscard]] std::uint64_t bytes(std::size_t orders) const {
    return fixed + std::uint64_t{orders} * (left + right + product);
  }
};

}  // namespace lobe
