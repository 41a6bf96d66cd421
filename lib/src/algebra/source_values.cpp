#include "algebra/source_values.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/text.hpp"
#include "lobe/core/error.hpp"
#include "model/values.hpp"

namespace lobe {
namespace {

constexpr double kSinglePrecision = 1e-5;  // of tables that were computed in it and state no error

/// A pair of nodes by rings and azimuth.
struct Place {
  std::size_t in, out, step;
};

/// Rings from the pole to the horizon, each with itself at the mirror direction and half way, and with others.
std::vector<Place> places(const HemisphereGrid& grid) {
  const std::size_t rings = grid.rings().size();
  const std::size_t across = grid.n_phi() / 2;
  std::vector<Place> list;
  for (std::size_t k = 0; k < 4; ++k) {
    const std::size_t ring = k * (rings - 1) / 3;
    list.push_back({ring, ring, across});
    list.push_back({ring, ring, across / 2});
    list.push_back({ring, rings - 1 - ring, across});
    list.push_back({ring, rings / 2, 0});
  }
  return list;
}

}  // namespace

void require_source_values(const Device& device, const BrdfTable& table) {
  const HemisphereGrid& grid = table.grid;
  if (table.source.size() != 1 || grid.has_cells() || !grid.is_product()) return;
  const auto chosen = places(grid);
  std::vector<Directions> directions;
  for (const Place& place : chosen) {
    directions.push_back({grid.rings()[place.in].theta, grid.rings()[place.out].theta,
                          2 * std::numbers::pi * static_cast<double>(place.step) / static_cast<double>(grid.n_phi()),
                          0});
  }
  const Material& material = table.source.front();
  const Eigen::MatrixXd expected = unchecked_values(device, material, directions, Precision::double_precision);
  const std::size_t rings = grid.rings().size();
  for (std::size_t c = 0; c < table.channels; ++c) {
    const auto column = static_cast<Eigen::Index>(expected.cols() == 1 ? 0 : c);
    const double size = expected.col(column).cwiseAbs().maxCoeff();
    for (std::size_t p = 0; p < chosen.size(); ++p) {
      const auto [in, out, step] = chosen[p];
      const std::size_t at = table.form == TableForm::isotropic
                                 ? (in * rings + out) * grid.half_azimuths() + step
                                 : in * grid.n_phi() * grid.nodes() + out * grid.n_phi() + step;
      const double value = table.channel(c)[at];
      const double stated = table.error.empty() ? 0 : table.error[(c * rings + in) * rings + out];
      const double allowed = (std::isfinite(stated) ? stated : 0) + kSinglePrecision * size;
      const double wanted = expected(static_cast<Eigen::Index>(p), column);
      if (std::abs(value - wanted) <= allowed) continue;
      throw ArgumentError("table '" + table.expression + "' says that it is made of '" + material.name +
                          "', which is " + shortest(wanted) + " sr^-1 where the table has " + shortest(value) +
                          " (rings " + std::to_string(in + 1) + " and " + std::to_string(out + 1) +
                          "); expected the formula of its values");
    }
  }
}

}  // namespace lobe
