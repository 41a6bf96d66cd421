#include "hemisphere/albedo_curve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

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

/// Where parts of panels begin and end: twice the number of the panel and from 0 to 1 on it, so that the ends of two
/// panels are never the same.
double position_of(const CurvePlace& place) {
  return 2 * static_cast<double>(place.panel) + (place.x + 1) / 2;
}

CurvePlace place_at(double position) {
  const double panel = std::floor(position / 2);
  return {static_cast<std::size_t>(panel), 2 * (position - 2 * panel) - 1};
}

/// A panel or a part of one.
struct Part {
  double from, to;
  std::vector<double> terms = {};
  double remainder = 0;

  [[nodiscard]] bool is_panel() const { return to - from == 1; }
};

std::vector<double> angles_of(const Part& part) {
  std::vector<double> angles;
  for (std::size_t j = 0; j < kCurveTerms; ++j) {
    angles.push_back(angle_of(place_at(part.from + (part.to - part.from) * (chebyshev(1, j) + 1) / 2)));
  }
  return angles;
}

void fit(Part& part, std::span<const double> values) {
  for (std::size_t k = 0; k < kCurveTerms; ++k) {
    double sum = 0;
    for (std::size_t j = 0; j < kCurveTerms; ++j) sum += values[j] * chebyshev(k, j);
    part.terms.push_back(sum * (k == 0 ? 1.0 : 2.0) / kCurveTerms);
  }
  const double tail = std::abs(part.terms[kCurveTerms - 1]) + std::abs(part.terms[kCurveTerms - 2]);
  part.remainder = tail / *std::ranges::min_element(values);
}

void fit_all(std::span<Part> parts, const ValuesAtAngles& values_at) {
  std::vector<double> angles;
  for (const Part& part : parts) {
    const auto own = angles_of(part);
    angles.insert(angles.end(), own.begin(), own.end());
  }
  const std::vector<double> values = values_at(angles);
  for (std::size_t k = 0; k < parts.size(); ++k) {
    fit(parts[k], std::span(values).subspan(k * kCurveTerms, kCurveTerms));
  }
}

double series(std::span<const double> terms, double x) {
  double last = 0;
  double before = 0;
  for (std::size_t k = kCurveTerms - 1; k > 0; --k) {
    const double next = 2 * x * last - before + terms[k];
    before = last;
    last = next;
  }
  return x * last - before + terms[0];
}

}  // namespace

const std::vector<double>& curve_angles() {
  static const std::vector<double> angles = [] {
    std::vector<double> list;
    for (std::size_t panel = 0; panel < kCurvePanels; ++panel) {
      for (std::size_t j = 0; j < kCurveTerms; ++j) list.push_back(angle_of({panel, chebyshev(1, j)}));
    }
    return list;
  }();
  return angles;
}

std::vector<double> curve_angles(std::span<const double> curve) {
  std::vector<double> angles = curve_angles();
  for (std::size_t part = 0; part < parts_of(curve); ++part) {
    const auto numbers = curve.subspan(kCurveNumbers + part * kPartNumbers, kPartNumbers);
    const auto own = angles_of({numbers[0], numbers[1]});
    angles.insert(angles.end(), own.begin(), own.end());
  }
  return angles;
}

FittedCurve fit_curve(const ValuesAtAngles& values_at, double enough) {
  constexpr double kShortest = 1e-9;  // of parts: a jump has no end
  std::vector<Part> leaves;
  for (std::size_t panel = 0; panel < kCurvePanels; ++panel) {
    const double from = 2 * static_cast<double>(panel);
    leaves.push_back({from, from + 1});
  }
  fit_all(leaves, values_at);
  std::vector<double> curve;
  for (const Part& panel : leaves) curve.insert(curve.end(), panel.terms.begin(), panel.terms.end());
  for (;;) {
    const auto is_good = [enough](const Part& part) { return part.remainder <= enough; };
    const auto bad = std::stable_partition(leaves.begin(), leaves.end(), is_good);
    const auto parts =
        static_cast<std::size_t>(std::count_if(leaves.begin(), bad, [](const Part& part) { return !part.is_panel(); }));
    const bool are_long =
        std::all_of(bad, leaves.end(), [](const Part& part) { return part.to - part.from > kShortest; });
    if (bad == leaves.end() || !are_long ||
        parts + 2 * static_cast<std::size_t>(leaves.end() - bad) > kMostCurveParts) {
      break;
    }
    std::vector<Part> halves;
    for (auto whole = bad; whole != leaves.end(); ++whole) {
      const double middle = (whole->from + whole->to) / 2;
      halves.push_back({whole->from, middle});
      halves.push_back({middle, whole->to});
    }
    fit_all(halves, values_at);
    leaves.erase(bad, leaves.end());
    leaves.insert(leaves.end(), halves.begin(), halves.end());
  }
  std::ranges::sort(leaves, {}, &Part::from);
  double remainder = 0;
  for (const Part& leaf : leaves) {
    remainder = std::max(remainder, leaf.remainder);
    if (leaf.is_panel()) continue;
    curve.push_back(leaf.from);
    curve.push_back(leaf.to);
    curve.insert(curve.end(), leaf.terms.begin(), leaf.terms.end());
  }
  return {std::move(curve), remainder};
}

std::size_t parts_of(std::span<const double> curve) {
  return (curve.size() - kCurveNumbers) / kPartNumbers;
}

std::string fault_of_curve(std::span<const double> curve) {
  const std::size_t all = curve.size();
  if (all < kCurveNumbers || (all - kCurveNumbers) % kPartNumbers != 0 || parts_of(curve) > kMostCurveParts) {
    return fmt::format("has {} numbers; expected {}, or {} more for each of at most {} parts of panels", all,
                       kCurveNumbers, kPartNumbers, kMostCurveParts);
  }
  if (!std::ranges::all_of(curve, [](double number) { return std::isfinite(number); })) {
    return "has numbers that are not finite";
  }
  double end = 0;
  for (std::size_t part = 0; part < parts_of(curve); ++part) {
    const double from = curve[kCurveNumbers + part * kPartNumbers];
    const double to = curve[kCurveNumbers + part * kPartNumbers + 1];
    const double panel = 2 * std::floor(from / 2);
    if (from >= end && to > from && to <= panel + 1 && panel < 2 * static_cast<double>(kCurvePanels)) {
      end = to;
      continue;
    }
    return fmt::format("has a part {} from {} to {}; expected parts of one panel each, in rising order", part + 1, from,
                       to);
  }
  return {};
}

std::vector<double> padded_curve(std::span<const double> curve, std::size_t parts) {
  if (parts == 0) return {curve.begin(), curve.end()};
  const auto panels = curve.first(kCurveNumbers);
  const auto own = curve.subspan(kCurveNumbers);
  std::vector<double> padded(panels.begin(), panels.end());
  std::size_t before = 0;
  for (std::size_t panel = 0; panel <= kCurvePanels; ++panel) {
    while (before < parts_of(curve) && own[before * kPartNumbers] < 2 * static_cast<double>(panel)) ++before;
    padded.push_back(static_cast<double>(before));
  }
  padded.insert(padded.end(), own.begin(), own.end());
  padded.resize(kCurveNumbers + kPartCounts + parts * kPartNumbers, 0.0);
  return padded;
}

double curve_value(std::span<const double> curve, double cosine) {
  const CurvePlace place = place_of(cosine);
  const double at = position_of(place);
  std::size_t part = 0;  // the first one that does not end before
  for (std::size_t above = parts_of(curve); part < above;) {
    const std::size_t middle = (part + above) / 2;
    if (curve[kCurveNumbers + middle * kPartNumbers + 1] < at) {
      part = middle + 1;
    } else {
      above = middle;
    }
  }
  if (part < parts_of(curve)) {
    const auto numbers = curve.subspan(kCurveNumbers + part * kPartNumbers, kPartNumbers);
    if (numbers[0] <= at) return series(numbers.subspan(2), 2 * (at - numbers[0]) / (numbers[1] - numbers[0]) - 1);
  }
  return series(curve.subspan(place.panel * kCurveTerms, kCurveTerms), place.x);
}

}  // namespace lobe
