#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>

#include "core/text.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"
#include "lobe/lut/lut_fit.hpp"
#include "lut/lut_measure.hpp"

namespace lobe {
namespace {

/// A published fit and what it stands for.
struct PublishedRow {
  std::string_view name;
  std::string_view title;
};
constexpr std::array kPublished{
    PublishedRow{"lazarov", "Lazarov 2013 (Black Ops II), of Blinn-Phong with exponent 8192^gloss = 2 / alpha^2 - 2"},
    PublishedRow{"karis", "Karis 2014 (EnvBRDFApprox of Unreal Engine), of GGX in sqrt(alpha)"},
    PublishedRow{"materialx", "MaterialX (mx_ggx_dir_albedo_analytic), of GGX with height-correlated Smith in alpha"}};

constexpr auto kPublishedNames = [] {
  std::array<std::string_view, kPublished.size()> names;
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = kPublished[i].name;
  return names;
}();

/// Source: Lazarov 2013, course notes "Getting More Physical in Call of Duty: Black Ops II", EnvironmentBRDF().
LutTerms lazarov(double gloss, double cos_theta) {
  const double first = gloss / 0.96;
  const double second = 0.475 * gloss;
  const double third = (0.0275 - 0.25 * 0.04) / 0.96 * gloss + (0.015 - 0.75 * 0.04) / 0.96;
  const double fourth = 0.25 * gloss + 0.75;
  const double at_0 = first * std::min(second, std::exp2(-9.28 * cos_theta)) + third;
  // saturate() of the sum, here at both ends of f0.
  const double bias = std::clamp(at_0, 0.0, 1.0);
  return {std::clamp(fourth, 0.0, 1.0) - bias, bias};
}

/// Source: Karis 2014, "Physically Based Shading on Mobile", EnvBRDFApprox().
LutTerms karis(double roughness, double cos_theta) {
  const double x = 1 - roughness;
  const double y = 0.0425 - 0.0275 * roughness;
  const double z = 1.04 - 0.572 * roughness;
  const double w = 0.022 * roughness - 0.04;
  const double a004 = std::min(x * x, std::exp2(-9.28 * cos_theta)) * x + y;
  return {-1.04 * a004 + z, 1.04 * a004 + w};
}

/// Source: MaterialX, libraries/pbrlib/genglsl/lib/mx_microfacet_specular.glsl, commit 0aa65a1.
LutTerms materialx(double y, double x) {
  // Rows: 1, x, y, xy, x^2, y^2, x^2 y, x y^2, x^2 y^2; columns: scale and bias, numerators before denominators.
  constexpr std::array<std::array<double, 4>, 9> kRows{{{0.10031, 0.93450, 1.0, 1.0},
                                                        {-0.63301, -2.32352, -1.76427, 0.22797},
                                                        {9.74995, 2.22823, 8.26501, 15.93688},
                                                        {-2.02075, -3.74584, 11.54840, -55.82466},
                                                        {29.38247, 1.42450, 28.99991, 13.07919},
                                                        {-8.24713, -0.76829, -7.50867, 41.25882},
                                                        {-26.51510, 1.43366, -36.16186, 54.86775},
                                                        {19.98406, 0.29060, 15.85408, 300.10923},
                                                        {-5.41717, 0.62933, 33.41550, -284.73288}}};
  const std::array<double, 9> powers{1, x, y, x * y, x * x, y * y, x * x * y, x * y * y, x * x * y * y};
  std::array<double, 4> sums{};
  for (std::size_t k = 0; k < powers.size(); ++k) {
    for (std::size_t c = 0; c < sums.size(); ++c) sums[c] += kRows[k][c] * powers[k];
  }
  return {sums[0] / sums[2], sums[1] / sums[3]};
}

}  // namespace

std::vector<std::string_view> published_lut_fit_names() {
  return {kPublishedNames.begin(), kPublishedNames.end()};
}

PublishedLutFit parse_published_lut_fit(std::string_view name) {
  const auto found = std::ranges::find(kPublishedNames, name);
  if (found == kPublishedNames.end()) {
    throw ArgumentError(
        fmt::format("unknown published fit '{}'{}", excerpt(name), did_you_mean(name, kPublishedNames)));
  }
  return static_cast<PublishedLutFit>(found - kPublishedNames.begin());
}

std::string published_lut_fit_text(PublishedLutFit fit) {
  return std::string(kPublished.at(static_cast<std::size_t>(fit)).title);
}

LutTerms published_lut_fit(PublishedLutFit fit, double alpha, double cos_theta) {
  switch (fit) {
    case PublishedLutFit::lazarov: {
      const double exponent = std::max(2 / (alpha * alpha) - 2, 1.0);
      return lazarov(std::min(std::log2(exponent) / 13, 1.0), cos_theta);
    }
    case PublishedLutFit::karis:
      return karis(std::sqrt(alpha), cos_theta);
    case PublishedLutFit::materialx:
      return materialx(alpha, cos_theta);
  }
  return {};
}

std::vector<LutErrors> published_lut_fit_errors(const Device& device, PublishedLutFit fit, const Lut& exact,
                                                unsigned refinement, const LutOptions& options) {
  const auto& axes = exact.request.axes;
  std::optional<std::size_t> alpha;
  std::optional<std::size_t> angle;
  for (std::size_t a = 0; a < axes.size(); ++a) {
    if (axes[a].name == "alpha" || axes[a].name.ends_with(".alpha")) alpha = a;
    if (axes[a].name == "cos_theta" || axes[a].name == "theta") angle = a;
  }
  if (exact.request.split != "f0" || exact.columns.size() != 2 || axes.size() != 2 || !alpha || !angle) {
    throw ArgumentError(fmt::format(
        "the fit {} is one of scale and bias in f0; expected one channel, f0 as the parameter of the split, "
        "and the axes alpha and cos_theta or theta",
        kPublished.at(static_cast<std::size_t>(fit)).name));
  }
  const auto value = [&](std::span<const double> coordinates, std::size_t column) {
    const double at = axes[*angle].value(coordinates[*angle]);
    const double cos_theta = axes[*angle].name == "theta" ? std::cos(at * kDegree) : at;
    const LutTerms terms = published_lut_fit(fit, axes[*alpha].value(coordinates[*alpha]), cos_theta);
    return column == 0 ? terms.scale : terms.bias;
  };
  return measured_errors(device, exact, {{.value = value, .first = 0}, {.value = value, .first = 1}}, refinement,
                         options);
}

}  // namespace lobe
