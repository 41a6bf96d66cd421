#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "compare/comparison_result.hpp"

namespace lobe {

/// Materials from one place in a set to another.
struct MaterialRange {
  std::size_t first = 0;
  std::size_t end = 0;  ///< behind the last one

  [[nodiscard]] std::size_t size() const { return end - first; }
  bool operator==(const MaterialRange&) const = default;
};

/// A tile of the triangle of all pairs of materials: pairs of one range, or of two with the rows' before the columns'.
struct ComparisonTile {
  MaterialRange rows;
  MaterialRange columns;

  [[nodiscard]] bool is_triangle() const { return rows == columns; }
  /// Materials in it.
  [[nodiscard]] std::size_t materials() const { return is_triangle() ? rows.size() : rows.size() + columns.size(); }
  /// Pairs of different places in the set.
  [[nodiscard]] std::size_t pairs() const {
    return is_triangle() ? rows.size() * (rows.size() - 1) / 2 : rows.size() * columns.size();
  }
};

/// Materials in a range at most. Each tile evaluates its materials anew, which takes a small part of the time for so
/// many pairs.
inline constexpr std::size_t kTileMaterials = 128;

/// The tiles of so many materials, in ranges of about equal size, row by row. Up to `most`, one tile has all.
/// \param most at least one
[[nodiscard]] std::vector<ComparisonTile> comparison_tiles(std::size_t materials, std::size_t most = kTileMaterials);

/// Integrals of a tile. It depends on its own materials and the options, and on nothing else, so that it has the same
/// bits whoever computes it.
struct TileIntegrals {
  /// Per channel, or of the only one that its materials have. Matrices of a triangle have black, f = 0, as one more
  /// material in the last row and column.
  std::vector<ComparisonIntegrals> channels;
  std::uint64_t nodes = 0;        ///< of the quadrature
  std::uint64_t evaluations = 0;  ///< of lobes at these nodes
};

/// Tiles that have been computed before or elsewhere, by their places in comparison_tiles().
struct TileStore {
  std::function<bool(std::size_t tile)> has;           ///< it is known
  std::function<TileIntegrals(std::size_t tile)> get;  ///< a known one
  std::function<void(std::size_t tile, const TileIntegrals& integrals, double seconds)> keep;
};

/// The integrals of all pairs, per channel, (n + 1) x (n + 1) with black, from those of the tiles, which are added one
/// after the other.
class TiledIntegrals {
 public:
  TiledIntegrals(std::size_t materials, std::size_t channels);

  /// \throws IoError for integrals of other materials
  void add(const ComparisonTile& tile, const TileIntegrals& integrals);

  [[nodiscard]] std::vector<ComparisonIntegrals>& channels() { return channels_; }

 private:
  std::size_t materials_;
  std::vector<ComparisonIntegrals> channels_;
};

}  // namespace lobe
