#include "lobe/study/published.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/text.hpp"
#include "energy/albedo.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"
#include "model/evaluate.hpp"
#include "model/values.hpp"
#include "study/read/keys.hpp"

namespace lobe {
namespace {

constexpr std::array<std::string_view, 6> kPublishedQuantities{
    "reflectance", "albedo", "mean-albedo", "largest-albedo", "largest-albedo-angle", "constant"};

/// Rounding of models in double precision: a few hundred times what their files state.
constexpr double kPublishedRounding = 1e-12;

double number(std::string_view printed) {
  // A full stop without decimals is how some tables print whole numbers.
  const std::string_view digits = printed.ends_with('.') ? printed.substr(0, printed.size() - 1) : printed;
  double value = 0;
  if (!parse_number(digits, value)) {
    throw ArgumentError(fmt::format("'{}' is no decimal number; expected one as printed, like \"0.350\"", printed));
  }
  return value;
}

/// Quantities of one figure's material.
class Quantities {
 public:
  Quantities(const Device& device, const PublishedFigure& figure, double tolerance)
      : device_(device), figure_(figure), options_{.tolerance = tolerance} {}

  [[nodiscard]] Estimate value() const {
    Estimate value = quantity();
    if (figure_.unit) value = value / at_normal(*figure_.unit);
    value.value += figure_.offset;
    return value;
  }

 private:
  [[nodiscard]] Estimate quantity() const {
    switch (figure_.quantity) {
      case PublishedQuantity::reflectance:
        return reflectance(figure_.material, figure_.at, figure_.coefficients);
      case PublishedQuantity::albedo:
        return albedo(device_, figure_.material, std::array{figure_.at.front().theta_in}, options_).front().front();
      case PublishedQuantity::mean_albedo:
        return mean_albedo(device_, figure_.material, options_).front();
      case PublishedQuantity::largest_albedo:
        return peak().albedo;
      case PublishedQuantity::largest_albedo_angle:
        return peak_angle();
      case PublishedQuantity::constant:
        break;
    }
    return at_normal(figure_.material) / peak().albedo;
  }

  [[nodiscard]] Estimate reflectance(const Material& material, std::span<const Directions> at,
                                     std::span<const double> coefficients) const {
    const Eigen::MatrixXd values = unchecked_values(device_, material, at);
    Estimate sum;
    for (std::size_t k = 0; k < at.size(); ++k) {
      const double term = coefficients[k] * values(static_cast<Eigen::Index>(k), 0);
      sum.value += term;
      sum.error += kPublishedRounding * std::abs(term);
    }
    return sum;
  }

  [[nodiscard]] Estimate at_normal(const Material& material) const {
    return reflectance(material, std::array{Directions{}}, std::array{1.0});
  }

  [[nodiscard]] AlbedoPeak peak() const {
    return largest_albedo(device_, figure_.material, kPublishedThetaMax, options_).front();
  }

  /// Known to the nearest step on either side at which the albedo is lower beyond all errors.
  [[nodiscard]] Estimate peak_angle() const {
    constexpr std::array<double, 7> kSteps{0.02, 0.05, 0.1, 0.25, 0.5, 1, 2};  // degrees; the search ends at 1/64
    const AlbedoPeak found = peak();
    const double limit = found.albedo.value - found.albedo.error;
    for (const double step : kSteps) {
      const std::array sides{std::max(found.theta - step * kDegree, 0.0),
                             std::min(found.theta + step * kDegree, kPublishedThetaMax)};
      const auto albedos = albedo(device_, figure_.material, sides, options_).front();
      const bool is_lower = std::ranges::all_of(albedos, [&](const Estimate& a) {
        const bool is_end = sides[static_cast<std::size_t>(&a - albedos.data())] == found.theta;
        return is_end || std::abs(a.value) + a.error < limit;
      });
      if (is_lower) return {found.theta / kDegree, step};
    }
    return {found.theta / kDegree, std::numeric_limits<double>::infinity()};
  }

  const Device& device_;
  const PublishedFigure& figure_;
  AlbedoOptions options_;
};

void require_complete(const PublishedFigure& figure) {
  const auto refuse = [&](std::string_view what) {
    throw ArgumentError(fmt::format("published figure '{}, {}': {}", figure.table, figure.label, what));
  };
  if (figure.quantity == PublishedQuantity::reflectance) {
    if (figure.at.empty() || figure.at.size() != figure.coefficients.size()) {
      refuse("a reflectance needs pairs of directions and a coefficient for each");
    }
  } else if (figure.quantity == PublishedQuantity::albedo && figure.at.empty()) {
    refuse("an albedo needs an angle of incidence");
  }
}

}  // namespace

std::string_view to_string(PublishedQuantity quantity) {
  return kPublishedQuantities.at(static_cast<std::size_t>(quantity));
}

std::span<const std::string_view> published_quantities() {
  return kPublishedQuantities;
}

PublishedQuantity parse_published_quantity(std::string_view name) {
  const auto found = std::find(kPublishedQuantities.begin(), kPublishedQuantities.end(), name);
  if (found == kPublishedQuantities.end()) {
    throw ArgumentError(fmt::format("unknown quantity '{}'{}", name, did_you_mean(name, kPublishedQuantities)));
  }
  return static_cast<PublishedQuantity>(found - kPublishedQuantities.begin());
}

double unit_of_last_digit(std::string_view printed) {
  (void)number(printed);
  const std::size_t end = std::min(printed.find_first_of("eE"), printed.size());
  const std::size_t point = printed.find('.');
  const double decimals = point < end ? static_cast<double>(end - point - 1) : 0;
  double exponent = 0;
  if (end < printed.size()) exponent = number(printed.substr(end + 1));
  return std::pow(10, exponent - decimals);
}

std::vector<PublishedCheck> check_published(const Device& device, std::span<const PublishedFigure> figures,
                                            double tolerance, const ProgressCallback& progress) {
  constexpr double kUncertain = 0.25;  // of a unit
  std::vector<PublishedCheck> checks;
  for (const auto& figure : figures) require_complete(figure);
  for (const auto& figure : figures) {
    const double done = static_cast<double>(checks.size()) / static_cast<double>(figures.size());
    if (progress && !progress("published figures", done)) throw Cancelled("cancelled");
    PublishedCheck check;
    check.value = Quantities(device, figure, figure.tolerance.value_or(tolerance)).value();
    const auto deviation = [&](std::string_view text) {
      return (check.value.value - number(text)) / unit_of_last_digit(text);
    };
    const auto rounds_to = [&](std::string_view text) {
      const double error = check.value.error / unit_of_last_digit(text);
      return error <= kUncertain && std::abs(deviation(text)) <= 0.5 + error;
    };
    check.deviation = deviation(figure.printed);
    check.agrees = rounds_to(figure.printed);
    check.is_as_expected = figure.corrected.empty() ? check.agrees : rounds_to(figure.corrected) && !check.agrees;
    checks.push_back(check);
  }
  return checks;
}

}  // namespace lobe
