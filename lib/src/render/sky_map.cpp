#include "render/sky_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

namespace lobe {
namespace {

using std::numbers::pi;

constexpr Eigen::Index kMostAzimuths = 65;
constexpr Eigen::Index kTerms = 7;          // of a panel's series
constexpr double kShortest = pi / 1024;     // a panel is not halved below this
constexpr double kGrazing = pi / 2 - 1e-3;  // what is nearer to the silhouette covers a millionth of the picture

/// Values at the nodes of a panel to terms of its series.
Eigen::MatrixXd chebyshev_transform() {
  Eigen::MatrixXd transform(kTerms, kTerms);
  for (Eigen::Index node = 0; node < kTerms; ++node) {
    for (Eigen::Index k = 0; k < kTerms; ++k) {
      const double angle = pi * static_cast<double>(k) * (static_cast<double>(node) + 0.5) / kTerms;
      transform(node, k) = std::cos(angle) * (k == 0 ? 1.0 : 2.0) / kTerms;
    }
  }
  return transform;
}

std::vector<double> nodes_of(double low, double high) {
  std::vector<double> nodes;
  for (Eigen::Index node = 0; node < kTerms; ++node) {
    const double x = std::cos(pi * (static_cast<double>(node) + 0.5) / kTerms);
    nodes.push_back(std::midpoint(low, high) + x * (high - low) / 2);
  }
  return nodes;
}

}  // namespace

SkyMap::SkyMap(const SkyFunction& sky, Symmetry symmetry, double tolerance) : frequency_(symmetry.half_turn ? 2 : 1) {
  if (!symmetry.isotropic) choose_azimuths(sky, tolerance);
  constexpr std::array kEdges{0.0, pi / 6, pi / 3, 4 * pi / 9, kGrazing};
  std::vector<Panel> waiting;
  for (std::size_t k = 0; k + 1 < kEdges.size(); ++k) waiting.push_back({kEdges[k], kEdges[k + 1], {}, {}});
  while (!waiting.empty()) {
    const std::vector<bool> is_done = fill(sky, waiting, tolerance);
    std::vector<Panel> halves;
    for (std::size_t k = 0; k < waiting.size(); ++k) {
      Panel& panel = waiting[k];
      if (is_done[k] || panel.high - panel.low < 2 * kShortest) {
        panels_.push_back(std::move(panel));
        continue;
      }
      const double middle = std::midpoint(panel.low, panel.high);
      halves.push_back({panel.low, middle, {}, {}});
      halves.push_back({middle, panel.high, {}, {}});
    }
    waiting = std::move(halves);
  }
  std::ranges::sort(panels_, {}, &Panel::low);
}

Eigen::MatrixXd SkyMap::azimuth_transform() const {
  Eigen::MatrixXd transform(azimuths_, azimuths_);
  const auto count = static_cast<double>(azimuths_);
  for (Eigen::Index node = 0; node < azimuths_; ++node) {
    transform(0, node) = 1 / count;
    for (Eigen::Index k = 1; 2 * k < azimuths_; ++k) {
      const double angle = 2 * pi * static_cast<double>(k * node) / count;
      transform(2 * k - 1, node) = 2 * std::cos(angle) / count;
      transform(2 * k, node) = 2 * std::sin(angle) / count;
    }
  }
  return transform;
}

std::vector<Direction> SkyMap::views_of(std::span<const double> thetas) const {
  std::vector<Direction> views;
  for (const double theta : thetas) {
    for (Eigen::Index node = 0; node < azimuths_; ++node) {
      views.push_back({theta, 2 * pi * static_cast<double>(node) / (frequency_ * static_cast<double>(azimuths_))});
    }
  }
  return views;
}

void SkyMap::choose_azimuths(const SkyFunction& sky, double tolerance) {
  constexpr std::array kThetas{0.7, 1.2, 1.45};
  for (azimuths_ = 9;; azimuths_ = 2 * azimuths_ - 1) {
    const Eigen::MatrixXd values = sky(views_of(kThetas)).value;
    const Eigen::MatrixXd transform = azimuth_transform();
    azimuth_error_ = 0;
    for (std::size_t k = 0; k < kThetas.size(); ++k) {
      const auto first = static_cast<Eigen::Index>(k) * azimuths_;
      const Eigen::MatrixXd terms = values.middleCols(first, azimuths_) * transform.transpose();
      const Eigen::ArrayXd tail = terms.rightCols(4).cwiseAbs().rowwise().sum();
      azimuth_error_ = std::max(azimuth_error_, (tail / terms.col(0).array().abs().max(1)).maxCoeff());
    }
    if (azimuth_error_ <= tolerance || azimuths_ == kMostAzimuths) return;
  }
}

std::vector<bool> SkyMap::fill(const SkyFunction& sky, std::span<Panel> panels, double tolerance) const {
  std::vector<double> thetas;
  for (const Panel& panel : panels) {
    const auto nodes = nodes_of(panel.low, panel.high);
    thetas.insert(thetas.end(), nodes.begin(), nodes.end());
  }
  const SkyValues values = sky(views_of(thetas));
  const Eigen::Index rows = values.value.rows();
  const Eigen::MatrixXd by_azimuth = azimuth_transform();
  static const Eigen::MatrixXd by_theta = chebyshev_transform();
  std::vector<bool> is_done;
  Eigen::Index at = 0;
  for (Panel& panel : panels) {
    Eigen::MatrixXd terms(rows * azimuths_, kTerms);
    panel.error = Eigen::VectorXd::Zero(rows);
    for (Eigen::Index node = 0; node < kTerms; ++node, at += azimuths_) {
      const Eigen::MatrixXd of_rows = by_azimuth * values.value.middleCols(at, azimuths_).transpose();
      terms.col(node) = of_rows.reshaped();
      panel.error = panel.error.cwiseMax(values.error.middleCols(at, azimuths_).rowwise().maxCoeff());
    }
    panel.series = terms * by_theta;
    const Eigen::VectorXd tails = panel.series.rightCols(2).cwiseAbs().rowwise().sum();
    bool has_converged = true;
    for (Eigen::Index row = 0; row < rows; ++row) {
      const double tail = tails.segment(row * azimuths_, azimuths_).sum();
      const double size = std::max(1.0, std::abs(panel.series(row * azimuths_, 0)));
      has_converged = has_converged && tail <= tolerance * size;
      panel.error(row) += tail + azimuth_error_ * size;
    }
    is_done.push_back(has_converged);
  }
  return is_done;
}

void SkyMap::add(Direction view, double share, Eigen::Ref<Eigen::VectorXd> rows) const {
  const double theta = std::clamp(view.theta, 0.0, kGrazing);
  const auto above = std::ranges::upper_bound(panels_, theta, {}, &Panel::low);
  const Panel& panel = above == panels_.begin() ? panels_.front() : *(above - 1);
  const double x = (2 * theta - panel.low - panel.high) / (panel.high - panel.low);
  std::array<double, kTerms> basis{1, x};
  for (std::size_t k = 2; k < basis.size(); ++k) basis[k] = 2 * x * basis[k - 1] - basis[k - 2];
  std::array<double, kMostAzimuths> wave{1};
  for (Eigen::Index k = 1; 2 * k < azimuths_; ++k) {
    const double angle = frequency_ * static_cast<double>(k) * view.phi;
    wave[static_cast<std::size_t>(2 * k - 1)] = std::cos(angle);
    wave[static_cast<std::size_t>(2 * k)] = std::sin(angle);
  }
  const Eigen::Map<const Eigen::VectorXd> waves(wave.data(), azimuths_);
  const Eigen::Map<const Eigen::VectorXd> powers(basis.data(), kTerms);
  const Eigen::Index count = panel.error.size();
  for (Eigen::Index row = 0; row < count; ++row) {
    rows(row) += share * waves.dot(panel.series.middleRows(row * azimuths_, azimuths_).lazyProduct(powers));
    rows(count + row) += share * panel.error(row);
  }
}

}  // namespace lobe
