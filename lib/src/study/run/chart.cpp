#include "lobe/study/chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/text.hpp"
#include "energy/albedo.hpp"
#include "energy/prepare.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"
#include "model/evaluate.hpp"
#include "model/values.hpp"
#include "study/read/keys.hpp"

namespace lobe {
namespace {

using std::numbers::pi;

constexpr std::array<std::string_view, 5> kQuantities{"albedo", "mirror-radiance", "reflectance", "radiance",
                                                      "mean-albedo"};

/// Rounding of models in double precision: a few hundred times what their files state.
constexpr double kChartRounding = 1e-12;

/// Relative error of values due to adjustments: what prepare() promises for each step.
double adjustment_error(const Material& material) {
  double error = 0;
  for (const auto& adjustment : material.adjustments) {
    error += kAdjustmentError * (adjustment.kind == Adjustment::Kind::pump ? adjustment.times : 1);
  }
  return error;
}

std::vector<Estimate> values_at(const Device& device, const Material& material, std::span<const Directions> at) {
  const Eigen::MatrixXd values = unchecked_values(device, material, at);
  std::vector<Estimate> estimates;
  for (Eigen::Index k = 0; k < values.rows(); ++k) {
    estimates.push_back({values(k, 0), kChartRounding * std::abs(values(k, 0))});
  }
  return estimates;
}

std::vector<Estimate> mirror_radiance(const Device& device, const Material& material, std::span<const double> x) {
  std::vector<Directions> at;
  for (const double theta : x) at.push_back({theta, theta, pi});
  std::vector<Estimate> values = values_at(device, material, at);
  for (std::size_t k = 0; k < x.size(); ++k) values[k] = std::cos(x[k]) * values[k];
  return values;
}

std::vector<Estimate> in_plane_of_incidence(const Device& device, const Material& material, double theta_in,
                                            std::span<const double> x) {
  std::vector<Directions> at;
  for (const double theta : x) at.push_back({theta_in, std::abs(theta), theta < 0 ? 0 : pi});
  return values_at(device, material, at);
}

/// Curve of one material, over all abscissae.
std::vector<Estimate> curve_of(const Device& device, const Chart& chart, const ChartCurve& curve,
                               const Material& material, const AlbedoOptions& options) {
  switch (chart.quantity) {
    case ChartQuantity::albedo:
      return albedo(device, material, chart.x, options).front();
    case ChartQuantity::mirror_radiance:
      return mirror_radiance(device, material, chart.x);
    case ChartQuantity::reflectance:
    case ChartQuantity::radiance:
      break;
    case ChartQuantity::mean_albedo:
      return {mean_albedo(device, material, options).front()};
  }
  std::vector<Estimate> values = in_plane_of_incidence(device, material, curve.theta_in, chart.x);
  if (chart.quantity == ChartQuantity::radiance) {
    for (Estimate& value : values) value = std::cos(curve.theta_in) * value;
  }
  return values;
}

void require_complete(const Chart& chart) {
  for (const auto& curve : chart.curves) {
    const std::size_t expected = is_over_angle(chart.quantity) ? 1 : chart.x.size();
    if (curve.materials.size() == expected) continue;
    throw ArgumentError(fmt::format("curve '{}' of chart '{}' has {} materials; expected {}", curve.label, chart.name,
                                    curve.materials.size(), expected));
  }
}

}  // namespace

std::string_view to_string(ChartQuantity quantity) {
  return kQuantities.at(static_cast<std::size_t>(quantity));
}

std::span<const std::string_view> chart_quantities() {
  return kQuantities;
}

ChartQuantity parse_chart_quantity(std::string_view name) {
  const auto found = std::find(kQuantities.begin(), kQuantities.end(), name);
  if (found == kQuantities.end()) {
    throw ArgumentError(fmt::format("unknown quantity '{}'{}", name, did_you_mean(name, kQuantities)));
  }
  return static_cast<ChartQuantity>(found - kQuantities.begin());
}

bool is_over_angle(ChartQuantity quantity) {
  return quantity != ChartQuantity::mean_albedo;
}

bool is_over_viewer(ChartQuantity quantity) {
  return quantity == ChartQuantity::reflectance || quantity == ChartQuantity::radiance;
}

std::vector<double> default_abscissae(ChartQuantity quantity, bool log_x) {
  std::vector<double> degrees;
  // Elevations that shrink from the last one by equal factors.
  const auto shrink = [&](double from, double to, int steps) {
    for (int i = 1; i <= steps; ++i) degrees.push_back(90 - from * std::pow(to / from, static_cast<double>(i) / steps));
  };
  if (is_over_viewer(quantity)) {
    for (int half = -179; half <= 179; ++half) degrees.push_back(0.5 * half);
  } else if (log_x) {
    degrees.push_back(0);
    shrink(90, 1e-4, 120);
  } else {
    for (int degree = 0; degree <= 80; ++degree) degrees.push_back(degree);
    shrink(10, 0.1, 40);
  }
  for (double& angle : degrees) angle *= kDegree;
  return degrees;
}

ChartValues compute_chart(const Device& device, const Chart& chart, double tolerance, const ProgressCallback& progress,
                          const MissedToleranceCallback& missed) {
  require_complete(chart);
  const AlbedoOptions options{.tolerance = chart.tolerance.value_or(tolerance), .missed = missed};
  Estimate unit{1, 0};
  if (chart.unit) unit = values_at(device, prepare(device, *chart.unit), std::array{Directions{}}).front();
  std::size_t count = 0;
  for (const auto& curve : chart.curves) count += curve.materials.size();
  std::size_t done = 0;
  ChartValues values;
  for (const auto& curve : chart.curves) {
    values.emplace_back();
    for (const auto& material : curve.materials) {
      const double share = static_cast<double>(done++) / static_cast<double>(count);
      if (progress && !progress("chart " + chart.name, share)) throw Cancelled("cancelled");
      const double relative = adjustment_error(material) + unit.error / unit.value;
      for (Estimate value : curve_of(device, chart, curve, prepare(device, material), options)) {
        value.error += relative * std::abs(value.value);
        value = 1 / unit.value * value;
        values.back().push_back(value);
      }
    }
  }
  return values;
}

}  // namespace lobe
