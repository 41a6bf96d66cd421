#include "compare/comparison_tiles.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <vector>

#include "lobe/core/error.hpp"

namespace lobe {
namespace {

Eigen::Index index(std::size_t place) {
  return static_cast<Eigen::Index>(place);
}

}  // namespace

std::vector<ComparisonTile> comparison_tiles(std::size_t materials, std::size_t most) {
  const std::size_t ranges = std::max<std::size_t>((materials + most - 1) / most, 1);
  const auto range = [&](std::size_t k) { return MaterialRange{k * materials / ranges, (k + 1) * materials / ranges}; };
  std::vector<ComparisonTile> tiles;
  for (std::size_t row = 0; row < ranges; ++row) {
    for (std::size_t column = row; column < ranges; ++column) tiles.push_back({range(row), range(column)});
  }
  return tiles;
}

TiledIntegrals::TiledIntegrals(std::size_t materials, std::size_t channels) : materials_(materials) {
  const Eigen::MatrixXd zero = Eigen::MatrixXd::Zero(index(materials + 1), index(materials + 1));
  channels_.assign(channels, {zero, zero});
}

void TiledIntegrals::add(const ComparisonTile& tile, const TileIntegrals& integrals) {
  const std::size_t own = tile.is_triangle() ? 1 : 0;  // for black
  const auto fits = [&](const Eigen::MatrixXd& matrix) {
    return matrix.rows() == index(tile.rows.size() + own) && matrix.cols() == index(tile.columns.size() + own);
  };
  const std::size_t found = integrals.channels.size();
  if ((found != 1 && found != channels_.size()) || !std::ranges::all_of(integrals.channels, [&](const auto& channel) {
        return fits(channel.value) && fits(channel.error);
      })) {
    throw IoError("a tile that was kept has other materials");
  }
  const Eigen::Index rows = index(tile.rows.size());
  const Eigen::Index columns = index(tile.columns.size());
  const Eigen::Index black = index(materials_);
  const auto place = [&](const Eigen::MatrixXd& from, Eigen::MatrixXd& to) {
    const auto inner = from.topLeftCorner(rows, columns);
    to.block(index(tile.rows.first), index(tile.columns.first), rows, columns) = inner;
    if (!tile.is_triangle()) {
      to.block(index(tile.columns.first), index(tile.rows.first), columns, rows) = inner.transpose();
      return;
    }
    to.col(black).segment(index(tile.rows.first), rows) = from.col(columns).head(rows);
    to.row(black).segment(index(tile.rows.first), rows) = from.row(rows).head(columns);
  };
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    const ComparisonIntegrals& one = integrals.channels[found == 1 ? 0 : c];
    place(one.value, channels_[c].value);
    place(one.error, channels_[c].error);
  }
}

}  // namespace lobe
