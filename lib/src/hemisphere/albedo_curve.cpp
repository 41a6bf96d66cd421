#include "hemisphere/albedo_curve.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "device/lobe_batch.hpp"

namespace lobe {
namespace {

using std::numbers::pi;

/// cos(k arccos x) at the j-th node of a series.
double chebyshev(std::size_t k, std::size_t j) {
  return std::cos(pi * static_cast<double>(k) * (static_cast<double>(j) + 0.5) / kCurveTerms);
}

/// A panel, and a place on it from -1 to 1.
struct CurvePlace {
  std::size_t panel;
  double x;
};

CurvePlace place_of(double cosine) {
  constexpr int kNormal = kCurveNormalPanels;
  constexpr int kGrazing = static_cast<int>(kCurvePanels) - kNormal;
  if (cosine > 0.5) {
    const double sine = std::sqrt(std::clamp(0.5 - 0.5 * cosine, 0.0, 1.0));  // of theta/2
    const int k = std::clamp(-std::ilogb(std::max(sine, 1e-12)) - 2, 0, kNormal - 1);
    const double x = k == kNormal - 1 ? std::ldexp(sine, k + 2) - 1 : std::ldexp(sine, k + 3) - 3;
    return {static_cast<std::size_t>(k), std::clamp(x, -1.0, 1.0)};
  }
  const int k = std::clamp(-std::ilogb(cosine) - 1, 1, kGrazing);
  return {static_cast<std::size_t>(kNormal - 1 + k), std::clamp(std::ldexp(cosine, k + 2) - 3, -1.0, 1.0)};
}

/// The inverse of place_of(), as an angle.
double angle_of(const CurvePlace& place) {
  const int panel = static_cast<int>(place.panel);
  constexpr int kNormal = kCurveNormalPanels;
  if (panel == kNormal - 1) return 2 * std::asin(std::ldexp(place.x + 1, -panel - 2));
  if (panel < kNormal) return 2 * std::asin(std::ldexp(place.x + 3, -panel - 3));
  return std::acos(std::ldexp(place.x + 3, -(panel - kNormal + 1) - 2));
}

}  // namespace

const std::vector<double>& curve_angles() {
  static const std::vector<double> angles = [] {
    std::vector<double> list;
    for (std::size_t panel = 0; panel < kCurvePanels; ++panel) {
      for (std::size_t j = 0; j < kCurveTerms; ++j) {
        list.push_back(angle_of({panel, chebyshev(1, j)}));
      }
    }
    return list;
  }();
  return angles;
}

std::vector<double> curve_through(std::span<const double> values) {
  std::vector<double> curve;
  for (std::size_t panel = 0; panel < kCurvePanels; ++panel) {
    for (std::size_t k = 0; k < kCurveTerms; ++k) {
      double sum = 0;
      for (std::size_t j = 0; j < kCurveTerms; ++j) sum += values[panel * kCurveTerms + j] * chebyshev(k, j);
      curve.push_back(sum * (k == 0 ? 1.0 : 2.0) / kCurveTerms);
    }
  }
  return curve;
}

double curve_remainder(std::span<const double> curve, std::span<const double> values) {
  double worst = 0;
  for (std::size_t panel = 0; panel < kCurvePanels; ++panel) {
    const auto terms = curve.subspan(panel * kCurveTerms, kCurveTerms);
    const auto here = values.subspan(panel * kCurveTerms, kCurveTerms);
    const double tail = std::abs(terms[kCurveTerms - 1]) + std::abs(terms[kCurveTerms - 2]);
    worst = std::max(worst, tail / *std::ranges::min_element(here));
  }
  return worst;
}

double curve_value(std::span<const double> curve, double cosine) {
  const CurvePlace place = place_of(cosine);
  const auto terms = curve.subspan(place.panel * kCurveTerms, kCurveTerms);
  double last = 0;
  double before = 0;
  for (std::size_t k = kCurveTerms - 1; k > 0; --k) {
    const double next = 2 * place.x * last - before + terms[k];
    before = last;
    last = next;
  }
  return place.x * last - before + terms[0];
}

}  // namespace lobe
