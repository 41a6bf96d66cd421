#include "lobe/hemisphere/grid.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iterator>
#include <numbers>

#include "core/text.hpp"
#include "hemisphere/gauss.hpp"
#include "hemisphere/square_map.hpp"
#include "lobe/core/error.hpp"
#include "lobe/core/written_form.hpp"

namespace lobe {
namespace {

using std::numbers::pi;

constexpr std::array kForms{
    WrittenForm{"gauss", "gauss:64x128",
                "64 Gauss nodes in cos(theta) x 128 azimuths (also 64x128); for smooth reflectances"},
    WrittenForm{"uniform", "uniform:45x72", "45 mid-points in theta x 72 azimuths"},
    WrittenForm{"cells", "cells:16x64", "16 x 64 cells of equal projected solid angle; values are averages over cells"},
    WrittenForm{"shirley-chiu", "shirley-chiu:32",
                "32 x 32 cells of equal projected solid angle, squares mapped to the disc"},
    WrittenForm{"klems", "klems:145", "the 145 patches of Klems, also 77 and 73 (half) or 41 (quarter)"}};

std::string_view kind_name(GridKind kind) {
  return kForms.at(static_cast<std::size_t>(kind)).word;
}

double square(double x) {
  return x * x;
}

/// theta of sin^2(theta) = u.
double theta_of(double u) {
  return std::asin(std::sqrt(std::clamp(u, 0.0, 1.0)));
}

constexpr std::size_t kLargestRings = 4096;
constexpr std::size_t kLargestGrid = std::size_t{1} << 22;  // nodes

void require_product(std::size_t n_theta, std::size_t n_phi) {
  if (n_theta < 1) throw ArgumentError("grid with 0 rings; expected at least 1");
  if (n_phi < 2 || n_phi % 2 != 0) {
    throw ArgumentError("grid with " + std::to_string(n_phi) +
                        " azimuths; expected an even number, so that every direction has an opposite one");
  }
}

std::size_t parse_count(std::string_view text, std::string_view grid) {
  std::size_t count = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), count);
  constexpr std::size_t kLargest = 65536;
  if (code != std::errc() || end != text.data() + text.size() || count > kLargest) {
    throw ArgumentError("cannot read grid '" + std::string(grid) +
                        "'; expected something like gauss:64x128, uniform:64x128, cells:64x128, shirley-chiu:32 or "
                        "klems:145");
  }
  return count;
}

// Limits of theta in degrees and numbers of azimuths of the Klems bases. Two are called half: that of Radiance, and
// that of WINDOW's CalcEngine, which derives the limits from the middles 0, 13, 26, 39, 52, 65 and 80.75.
constexpr std::array<double, 10> kFullLimits{0, 5, 15, 25, 35, 45, 55, 65, 75, 90};
constexpr std::array<std::size_t, 9> kFullCounts{1, 8, 16, 20, 24, 24, 24, 16, 12};
constexpr std::array<double, 8> kHalf77Limits{0, 6.5, 19.5, 32.5, 45.5, 58.5, 71.5, 90};
constexpr std::array<std::size_t, 7> kHalf77Counts{1, 8, 12, 16, 20, 12, 8};
constexpr std::array<double, 8> kHalf73Limits{0, 6.5, 19.5, 32.5, 46.5, 61.5, 76.5, 90};
constexpr std::array<std::size_t, 7> kHalf73Counts{1, 8, 12, 16, 20, 12, 4};
constexpr std::array<double, 6> kQuarterLimits{0, 9, 27, 46, 66, 90};
constexpr std::array<std::size_t, 5> kQuarterCounts{1, 8, 12, 12, 8};

struct KlemsBasis {
  std::size_t patches;
  std::span<const double> limits_deg;
  std::span<const std::size_t> counts;
};
constexpr std::array<KlemsBasis, 4> kKlemsBases{{{145, kFullLimits, kFullCounts},
                                                 {77, kHalf77Limits, kHalf77Counts},
                                                 {73, kHalf73Limits, kHalf73Counts},
                                                 {41, kQuarterLimits, kQuarterCounts}}};

}  // namespace

std::span<const WrittenForm> grid_forms() {
  return kForms;
}

HemisphereGrid HemisphereGrid::gauss(std::size_t n_theta, std::size_t n_phi) {
  require_product(n_theta, n_phi);
  const GaussRule rule = gauss_rule(static_cast<int>(n_theta));
  HemisphereGrid grid;
  double low = 0;  // in sin^2 theta
  for (std::size_t r = 0; r < n_theta; ++r) {
    // The nodes are symmetric about 1/2, which gives theta near 0 without cancellation.
    const double cosine = rule.nodes[n_theta - 1 - r];
    const double measure = cosine * rule.weights[r];
    const double high = r + 1 == n_theta ? 1 : low + 2 * measure;
    grid.add_ring(2 * std::asin(std::sqrt(rule.nodes[r] / 2)), theta_of(low), theta_of(high),
                  2 * pi / static_cast<double>(n_phi) * measure, n_phi, 0);
    low = high;
  }
  return grid;
}

HemisphereGrid HemisphereGrid::uniform(std::size_t n_theta, std::size_t n_phi) {
  require_product(n_theta, n_phi);
  HemisphereGrid grid;
  grid.kind_ = GridKind::uniform;
  const double step = pi / 2 / static_cast<double>(n_theta);
  for (std::size_t r = 0; r < n_theta; ++r) {
    const double low = static_cast<double>(r) * step;
    // sin^2(high) - sin^2(low) = sin(high + low) sin(high - low)
    grid.add_ring(low + step / 2, low, low + step,
                  pi * std::sin(2 * low + step) * std::sin(step) / static_cast<double>(n_phi), n_phi, 0);
  }
  return grid;
}

HemisphereGrid HemisphereGrid::cells(std::size_t n_theta, std::size_t n_phi) {
  require_product(n_theta, n_phi);
  HemisphereGrid grid;
  grid.kind_ = GridKind::cells;
  const auto rings = static_cast<double>(n_theta);
  for (std::size_t r = 0; r < n_theta; ++r) {
    const auto low = static_cast<double>(r);
    grid.add_ring(theta_of((low + 0.5) / rings), theta_of(low / rings), theta_of((low + 1) / rings),
                  pi / (rings * static_cast<double>(n_phi)), n_phi, 0);
  }
  return grid;
}

HemisphereGrid HemisphereGrid::shirley_chiu(std::size_t side) {
  if (side < 2 || (side & (side - 1)) != 0 || side > 4096) {
    throw ArgumentError("shirley-chiu grid with side " + std::to_string(side) + "; expected a power of two, 2 to 4096");
  }
  HemisphereGrid grid;
  grid.kind_ = GridKind::shirley_chiu;
  grid.side_ = side;
  const auto cells = static_cast<double>(side);
  // Cells of a concentric square have their centres on a circle, equally spaced in azimuth.
  for (std::size_t k = 0; k < side / 2; ++k) {
    const std::size_t odd = 2 * k + 1;
    grid.add_ring(std::asin(static_cast<double>(odd) / cells), std::asin(static_cast<double>(2 * k) / cells),
                  std::asin(static_cast<double>(2 * k + 2) / cells), pi / square(cells), 4 * odd,
                  pi / 4 / static_cast<double>(odd));
  }
  return grid;
}

HemisphereGrid HemisphereGrid::klems(std::size_t patches) {
  const auto* basis = std::ranges::find(kKlemsBases, patches, &KlemsBasis::patches);
  if (basis == kKlemsBases.end()) {
    throw ArgumentError("klems grid of " + std::to_string(patches) + " patches; expected 145, 77, 73 or 41");
  }
  return from_bands(patches, basis->limits_deg, basis->counts, 1);
}

HemisphereGrid HemisphereGrid::from_bands(std::size_t patches, std::span<const double> limits_deg,
                                          std::span<const std::size_t> counts, std::size_t division) {
  HemisphereGrid grid;
  grid.kind_ = GridKind::klems;
  grid.side_ = patches;
  grid.division_ = division;
  const auto parts = static_cast<double>(division);
  for (std::size_t band = 0; band < counts.size(); ++band) {
    const double low_deg = limits_deg[band];
    const double high_deg = limits_deg[band + 1];
    const double u_low = square(std::sin(low_deg * pi / 180));
    const double u_step = (square(std::sin(high_deg * pi / 180)) - u_low) / parts;
    const double patch = 2 * pi / static_cast<double>(counts[band]);
    for (std::size_t part = 0; part < division; ++part) {
      const double u = u_low + static_cast<double>(part) * u_step;
      const bool is_pole = division == 1 && band == 0;
      // Undivided patches are named by the middle of their limits; the first lies around the normal.
      const double theta = division > 1 ? theta_of(u + u_step / 2) : is_pole ? 0 : (low_deg + high_deg) / 2 * pi / 180;
      grid.add_ring(theta, theta_of(u), theta_of(u + u_step), patch / parts * u_step / 2, counts[band] * division,
                    -patch / 2 + patch / (2 * parts));
    }
  }
  return grid;
}

void HemisphereGrid::add_ring(double theta, double low, double high, double weight, std::size_t count, double phi_0) {
  const std::size_t ring = rings_.size();
  rings_.push_back({theta, low, high, weight, nodes_.size(), count});
  for (std::size_t j = 0; j < count; ++j) {
    nodes_.push_back({theta, phi_0 + 2 * pi * static_cast<double>(j) / static_cast<double>(count)});
    weights_.push_back(weight);
    ring_of_.push_back(ring);
  }
}

HemisphereGrid HemisphereGrid::default_grid(bool is_isotropic) {
  return is_isotropic ? gauss(64, 128) : gauss(24, 48);
}

HemisphereGrid HemisphereGrid::parse(std::string_view text) {
  const std::size_t colon = text.find(':');
  const std::string_view word = colon == std::string_view::npos ? "gauss" : text.substr(0, colon);
  const std::string_view size = colon == std::string_view::npos ? text : text.substr(colon + 1);
  const auto* found = std::ranges::find(kForms, word, &WrittenForm::word);
  if (found == kForms.end()) {
    std::vector<std::string_view> known;
    for (const auto& form : kForms) known.push_back(form.word);
    throw ArgumentError("unknown grid '" + std::string(word) + "'" + did_you_mean(word, known));
  }
  const auto kind = static_cast<GridKind>(found - kForms.begin());
  if (kind == GridKind::shirley_chiu) return shirley_chiu(parse_count(size, text));
  if (kind == GridKind::klems) return klems(parse_count(size, text));
  const std::size_t cross = size.find('x');
  const std::size_t n_theta = parse_count(size.substr(0, cross), text);
  const std::size_t n_phi = parse_count(cross == std::string_view::npos ? "?" : size.substr(cross + 1), text);
  if (n_theta > kLargestRings || n_theta * n_phi > kLargestGrid) {
    throw ArgumentError("grid " + std::string(text) + " is too large; expected at most " +
                        std::to_string(kLargestRings) + " rings and " + std::to_string(kLargestGrid) + " nodes");
  }
  if (kind == GridKind::uniform) return uniform(n_theta, n_phi);
  if (kind == GridKind::cells) return cells(n_theta, n_phi);
  return gauss(n_theta, n_phi);
}

std::string HemisphereGrid::name() const {
  const std::string kind(kind_name(kind_));
  if (is_product()) return kind + ":" + std::to_string(n_theta()) + "x" + std::to_string(n_phi());
  const std::string size = kind + ":" + std::to_string(side_);
  return division_ == 1 ? size : size + " divided by " + std::to_string(division_);
}

bool HemisphereGrid::is_product() const {
  return kind_ == GridKind::gauss || kind_ == GridKind::uniform || kind_ == GridKind::cells;
}

std::size_t HemisphereGrid::opposite(std::size_t node) const {
  const Ring& ring = rings_[ring_of_[node]];
  return ring.first_node + (node - ring.first_node + ring.count / 2) % ring.count;
}

std::size_t HemisphereGrid::node_at(Direction direction) const {
  Direction centre = direction;
  if (kind_ == GridKind::shirley_chiu) {
    const SquarePoint p = hemisphere_to_square(direction);
    const double cell = 2 / static_cast<double>(side_);
    const auto middle = [&](double x) { return (std::floor(std::clamp(x, -1.0, 1 - cell / 2) / cell) + 0.5) * cell; };
    centre = square_to_hemisphere({middle(p.a), middle(p.b)});
  }
  const auto beyond = std::ranges::find_if(rings_, [&](const Ring& ring) { return centre.theta < ring.theta_high; });
  const Ring& ring = beyond == rings_.end() ? rings_.back() : *beyond;
  const auto count = static_cast<double>(ring.count);
  const double turns = (centre.phi - nodes_[ring.first_node].phi) / (2 * pi);
  const double step = std::round((turns - std::floor(turns)) * count);
  return ring.first_node + static_cast<std::size_t>(step) % ring.count;
}

std::vector<Direction> HemisphereGrid::cell_points(std::size_t node, std::size_t points) const {
  if (!has_cells()) return {nodes_[node]};
  std::vector<Direction> directions;
  const Direction centre = nodes_[node];
  const Ring& ring = rings_[ring_of_[node]];
  const double u_low = square(std::sin(ring.theta_low));
  const double u_span = square(std::sin(ring.theta_high)) - u_low;
  const double phi_span = 2 * pi / static_cast<double>(ring.count);
  const SquarePoint middle = hemisphere_to_square(centre);
  for (std::size_t i = 0; i < points; ++i) {
    for (std::size_t j = 0; j < points; ++j) {
      // Positions within the cell, 0 to 1.
      const double x = (static_cast<double>(i) + 0.5) / static_cast<double>(points);
      const double y = (static_cast<double>(j) + 0.5) / static_cast<double>(points);
      if (kind_ == GridKind::shirley_chiu) {
        const double cell = 2 / static_cast<double>(side_);
        directions.push_back(square_to_hemisphere({middle.a + (x - 0.5) * cell, middle.b + (y - 0.5) * cell}));
      } else {
        directions.push_back({theta_of(u_low + x * u_span), centre.phi + (y - 0.5) * phi_span});
      }
    }
  }
  return directions;
}

HemisphereGrid HemisphereGrid::refined() const {
  switch (kind_) {
    case GridKind::gauss:
      return gauss(2 * n_theta(), 2 * n_phi());
    case GridKind::uniform:
      return uniform(2 * n_theta(), 2 * n_phi());
    case GridKind::cells:
      return cells(2 * n_theta(), 2 * n_phi());
    case GridKind::shirley_chiu:
      return shirley_chiu(2 * side_);
    case GridKind::klems:
      break;
  }
  const KlemsBasis& basis = *std::ranges::find(kKlemsBases, side_, &KlemsBasis::patches);
  return from_bands(side_, basis.limits_deg, basis.counts, 2 * division_);
}

bool HemisphereGrid::operator==(const HemisphereGrid& other) const {
  return kind_ == other.kind_ && side_ == other.side_ && division_ == other.division_ && nodes() == other.nodes() &&
         rings_.size() == other.rings_.size();
}

}  // namespace lobe
