#include "sampling/cell_proposal.hpp"

#include <cmath>
#include <memory>
#include <numbers>
#include <numeric>
#include <utility>

#include "core/parallel.hpp"
#include "table/interpolator.hpp"

namespace lobe {
namespace {

using std::numbers::pi;

constexpr double kAnywhere = 0.1;  // share of the cosine
constexpr std::size_t kMostRings = 128;
constexpr std::size_t kMostAzimuths = 256;

struct Cells {
  std::vector<double> limits;  ///< limits of the bands, in sin^2(theta)
  std::size_t azimuths = 0;

  [[nodiscard]] std::size_t bands() const { return limits.size() - 1; }
};

Cells cells_of(const HemisphereGrid& grid) {
  if (grid.is_product() && grid.n_theta() <= kMostRings && grid.n_phi() <= kMostAzimuths) {
    Cells cells{{0}, grid.n_phi()};
    for (const Ring& ring : grid.rings()) {
      const double sine = std::sin(ring.theta_high);
      cells.limits.push_back(sine * sine);
    }
    cells.limits.back() = 1;
    return cells;
  }
  constexpr std::size_t kBands = 32;
  Cells cells{{}, 2 * kBands};
  for (std::size_t band = 0; band <= kBands; ++band) {
    cells.limits.push_back(static_cast<double>(band) / static_cast<double>(kBands));
  }
  return cells;
}

/// Mean size over channels and over nine places of each cell.
std::vector<double> mean_sizes(const BrdfTable& table, Direction in, const Cells& cells) {
  constexpr std::array kPlaces{1.0 / 6, 0.5, 5.0 / 6};
  const Interpolator interpolator(table);
  std::vector<double> sizes(cells.bands() * cells.azimuths);
  parallel_for(cells.bands(), [&](std::size_t band) {
    for (std::size_t azimuth = 0; azimuth < cells.azimuths; ++azimuth) {
      double sum = 0;
      for (const double up : kPlaces) {
        const double square = std::lerp(cells.limits[band], cells.limits[band + 1], up);
        for (const double along : kPlaces) {
          const double phi = 2 * pi * (static_cast<double>(azimuth) + along) / static_cast<double>(cells.azimuths);
          for (std::size_t c = 0; c < table.channels; ++c) {
            sum += std::abs(interpolator.at(c, in, {std::asin(std::sqrt(square)), phi}).value);
          }
        }
      }
      sizes[band * cells.azimuths + azimuth] = sum;
    }
  });
  return sizes;
}

}  // namespace

std::vector<double> alias_table(const std::vector<double>& sizes) {
  const std::size_t count = sizes.size();
  const double mean = std::reduce(sizes.begin(), sizes.end()) / static_cast<double>(count);
  std::vector<double> table(2 * count, 1.0);
  std::vector<double> scaled;
  std::vector<std::size_t> small;
  std::vector<std::size_t> large;
  for (std::size_t i = 0; i < count; ++i) {
    scaled.push_back(sizes[i] / mean);
    table[count + i] = static_cast<double>(i);
    (scaled[i] < 1 ? small : large).push_back(i);
  }
  while (!small.empty() && !large.empty()) {
    const std::size_t low = small.back();
    const std::size_t high = large.back();
    small.pop_back();
    table[low] = scaled[low];
    table[count + low] = static_cast<double>(high);
    scaled[high] -= 1 - scaled[low];
    if (scaled[high] < 1) {
      large.pop_back();
      small.push_back(high);
    }
  }
  return table;
}

std::vector<ProposalPart> propose(const BrdfTable& table, Direction in) {
  const Cells cells = cells_of(table.grid);
  std::vector<double> weights = mean_sizes(table, in, cells);
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const std::size_t band = i / cells.azimuths;
    weights[i] *= cells.limits[band + 1] - cells.limits[band];
  }
  const double total = std::reduce(weights.begin(), weights.end());
  if (!(total > 0)) return {ProposalPart{}};
  std::vector<double> numbers = cells.limits;
  const auto alias = alias_table(weights);
  numbers.insert(numbers.end(), alias.begin(), alias.end());
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const std::size_t band = i / cells.azimuths;
    const double area = pi * (cells.limits[band + 1] - cells.limits[band]) / static_cast<double>(cells.azimuths);
    numbers.push_back(weights[i] / (total * area));
  }
  ProposalPart part{.strategy = Strategy::cells,
                    .share = 1 - kAnywhere,
                    .numbers = {static_cast<double>(cells.bands()), static_cast<double>(cells.azimuths)},
                    .table = std::make_shared<const std::vector<double>>(std::move(numbers)),
                    .place_of_table = 2};
  return {std::move(part), ProposalPart{.strategy = Strategy::cosine, .share = kAnywhere}};
}

}  // namespace lobe
