#include "lobe/core/colour.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <string_view>
#include <vector>

#include "core/spectral_range.hpp"
#include "core/text.hpp"
#include "lobe/core/error.hpp"

namespace lobe {
namespace {

constexpr double kFirstNanometre = 380;
constexpr double kStepNanometres = 5;

struct SpectralRow {
  double x, y, z;   // CIE 1931, 2 degrees
  double daylight;  // D65, 100 at 560 nm
};

// CIE 15, tables T.4 and T.1, from 380 nm on. The functions add up to 21.371524, 21.371327 and 21.371540.
constexpr std::array<SpectralRow, 81> kSpectrum{{{0.001368, 0.000039, 0.00645, 49.9755},
                                                 {0.002236, 0.000064, 0.01055, 52.3118},
                                                 {0.004243, 0.00012, 0.02005, 54.6482},
                                                 {0.00765, 0.000217, 0.03621, 68.7015},
                                                 {0.01431, 0.000396, 0.06785, 82.7549},
                                                 {0.02319, 0.00064, 0.1102, 87.1204},
                                                 {0.04351, 0.00121, 0.2074, 91.486},
                                                 {0.07763, 0.00218, 0.3713, 92.4589},
                                                 {0.13438, 0.004, 0.6456, 93.4318},
                                                 {0.21477, 0.0073, 1.03905, 90.057},
                                                 {0.2839, 0.0116, 1.3856, 86.6823},
                                                 {0.3285, 0.01684, 1.62296, 95.7736},
                                                 {0.34828, 0.023, 1.74706, 104.865},
                                                 {0.34806, 0.0298, 1.7826, 110.936},
                                                 {0.3362, 0.038, 1.77211, 117.008},
                                                 {0.3187, 0.048, 1.7441, 117.41},
                                                 {0.2908, 0.06, 1.6692, 117.812},
                                                 {0.2511, 0.0739, 1.5281, 116.336},
                                                 {0.19536, 0.09098, 1.28764, 114.861},
                                                 {0.1421, 0.1126, 1.0419, 115.392},
                                                 {0.09564, 0.13902, 0.81295, 115.923},
                                                 {0.05795, 0.1693, 0.6162, 112.367},
                                                 {0.03201, 0.20802, 0.46518, 108.811},
                                                 {0.0147, 0.2586, 0.3533, 109.082},
                                                 {0.0049, 0.323, 0.272, 109.354},
                                                 {0.0024, 0.4073, 0.2123, 108.578},
                                                 {0.0093, 0.503, 0.1582, 107.802},
                                                 {0.0291, 0.6082, 0.1117, 106.296},
                                                 {0.06327, 0.71, 0.07825, 104.79},
                                                 {0.1096, 0.7932, 0.05725, 106.239},
                                                 {0.1655, 0.862, 0.04216, 107.689},
                                                 {0.22575, 0.91485, 0.02984, 106.047},
                                                 {0.2904, 0.954, 0.0203, 104.405},
                                                 {0.3597, 0.9803, 0.0134, 104.225},
                                                 {0.43345, 0.99495, 0.00875, 104.046},
                                                 {0.51205, 1, 0.00575, 102.023},
                                                 {0.5945, 0.995, 0.0039, 100},
                                                 {0.6784, 0.9786, 0.00275, 98.1671},
                                                 {0.7621, 0.952, 0.0021, 96.3342},
                                                 {0.8425, 0.9154, 0.0018, 96.0611},
                                                 {0.9163, 0.87, 0.00165, 95.788},
                                                 {0.9786, 0.8163, 0.0014, 92.2368},
                                                 {1.0263, 0.757, 0.0011, 88.6856},
                                                 {1.0567, 0.6949, 0.001, 89.3459},
                                                 {1.0622, 0.631, 0.0008, 90.0062},
                                                 {1.0456, 0.5668, 0.0006, 89.8026},
                                                 {1.0026, 0.503, 0.00034, 89.5991},
                                                 {0.9384, 0.4412, 0.00024, 88.6489},
                                                 {0.85445, 0.381, 0.00019, 87.6987},
                                                 {0.7514, 0.321, 0.0001, 85.4936},
                                                 {0.6424, 0.265, 0.00005, 83.2886},
                                                 {0.5419, 0.217, 0.00003, 83.4939},
                                                 {0.4479, 0.175, 0.00002, 83.6992},
                                                 {0.3608, 0.1382, 0.00001, 81.863},
                                                 {0.2835, 0.107, 0, 80.0268},
                                                 {0.2187, 0.0816, 0, 80.1207},
                                                 {0.1649, 0.061, 0, 80.2146},
                                                 {0.1212, 0.04458, 0, 81.2462},
                                                 {0.0874, 0.032, 0, 82.2778},
                                                 {0.0636, 0.0232, 0, 80.281},
                                                 {0.04677, 0.017, 0, 78.2842},
                                                 {0.0329, 0.01192, 0, 74.0027},
                                                 {0.0227, 0.00821, 0, 69.7213},
                                                 {0.01584, 0.005723, 0, 70.6652},
                                                 {0.011359, 0.004102, 0, 71.6091},
                                                 {0.008111, 0.002929, 0, 72.979},
                                                 {0.00579, 0.002091, 0, 74.349},
                                                 {0.004109, 0.001484, 0, 67.9765},
                                                 {0.002899, 0.001047, 0, 61.604},
                                                 {0.002049, 0.00074, 0, 65.7448},
                                                 {0.00144, 0.00052, 0, 69.8856},
                                                 {0.001, 0.000361, 0, 72.4863},
                                                 {0.00069, 0.000249, 0, 75.087},
                                                 {0.000476, 0.000172, 0, 69.3398},
                                                 {0.000332, 0.00012, 0, 63.5927},
                                                 {0.000235, 0.000085, 0, 55.0054},
                                                 {0.000166, 0.00006, 0, 46.4182},
                                                 {0.000117, 0.000042, 0, 56.6118},
                                                 {0.000083, 0.00003, 0, 66.8054},
                                                 {0.000059, 0.000021, 0, 65.0941},
                                                 {0.000042, 0.000015, 0, 63.3828}}};

SpectralRow row_at(double nanometres) {
  const double place = (nanometres - kFirstNanometre) / kStepNanometres;
  if (!(place >= 0 && place <= static_cast<double>(kSpectrum.size() - 1))) return {0, 0, 0, 0};
  const auto below = std::min(static_cast<std::size_t>(place), kSpectrum.size() - 2);
  const double share = place - static_cast<double>(below);
  const auto& [x0, y0, z0, d0] = kSpectrum[below];
  const auto& [x1, y1, z1, d1] = kSpectrum[below + 1];
  return {std::lerp(x0, x1, share), std::lerp(y0, y1, share), std::lerp(z0, z1, share), std::lerp(d0, d1, share)};
}

/// Samples in the order of their wavelengths.
std::vector<std::size_t> spectral_order(std::span<const double> wavelengths) {
  std::vector<std::size_t> order(wavelengths.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return wavelengths[i]; });
  return order;
}

void require_distinct(std::span<const double> wavelengths, std::span<const std::size_t> order) {
  if (wavelengths.empty()) throw ArgumentError("no wavelengths; expected at least one");
  if (!std::ranges::all_of(wavelengths, [](double nm) { return std::isfinite(nm); })) {
    throw ArgumentError("a wavelength is no finite number; expected nanometres");
  }
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (wavelengths[order[i]] == wavelengths[order[i - 1]]) {
      throw ArgumentError("the wavelength " + shortest(wavelengths[order[i]]) + " nm occurs twice; expected each once");
    }
  }
}

/// Places of red, green and blue; empty where one is missing.
std::vector<Eigen::Index> primaries(std::span<const std::string> channels) {
  constexpr std::array<std::array<std::string_view, 2>, 3> kNames{{{"red", "r"}, {"green", "g"}, {"blue", "b"}}};
  std::vector<Eigen::Index> places;
  for (const auto& names : kNames) {
    const auto found = std::ranges::find_if(
        channels, [&](const std::string& name) { return std::ranges::count(names, lowercase(name)) > 0; });
    if (found == channels.end()) return {};
    places.push_back(found - channels.begin());
  }
  return places;
}

/// "1", "2", "3" are numbers, not names.
bool are_unnamed(std::span<const std::string> channels) {
  for (std::size_t c = 0; c < channels.size(); ++c) {
    if (!channels[c].empty() && channels[c] != std::to_string(c + 1)) return false;
  }
  return true;
}

}  // namespace

std::array<double, 3> colour_matching(double nanometres) {
  const SpectralRow row = row_at(nanometres);
  return {row.x, row.y, row.z};
}

Eigen::Matrix3Xd spectrum_to_xyz(std::span<const double> wavelengths, Illuminant illuminant) {
  const auto order = spectral_order(wavelengths);
  require_distinct(wavelengths, order);
  Eigen::Matrix3Xd weights = Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(wavelengths.size()));
  double white = 0;
  std::size_t above = 0;
  for (std::size_t k = 0; k < kSpectrum.size(); ++k) {
    const double nanometres = kFirstNanometre + kStepNanometres * static_cast<double>(k);
    const auto& [x, y, z, daylight] = kSpectrum[k];
    const Eigen::Vector3d seen = (illuminant == Illuminant::daylight ? daylight : 100) * Eigen::Vector3d(x, y, z);
    white += seen.y();
    while (above < order.size() && wavelengths[order[above]] < nanometres) ++above;
    const std::size_t high = order[std::min(above, order.size() - 1)];
    const std::size_t low = order[above == 0 ? 0 : above - 1];
    const double gap = wavelengths[high] - wavelengths[low];
    const double share = high == low ? 1 : (nanometres - wavelengths[low]) / gap;
    weights.col(static_cast<Eigen::Index>(high)) += share * seen;
    weights.col(static_cast<Eigen::Index>(low)) += (1 - share) * seen;
  }
  return weights / white;
}

Eigen::Matrix3d xyz_to_srgb() {
  const auto of_chromaticity = [](double x, double y) { return Eigen::Vector3d(x / y, 1, (1 - x - y) / y); };
  Eigen::Matrix3d to_xyz;
  to_xyz << of_chromaticity(0.64, 0.33), of_chromaticity(0.30, 0.60), of_chromaticity(0.15, 0.06);
  constexpr std::array kAnywhere{560.0};
  const Eigen::Vector3d white = spectrum_to_xyz(kAnywhere, Illuminant::daylight);
  const Eigen::Vector3d amounts = to_xyz.inverse() * white;
  to_xyz = to_xyz * amounts.asDiagonal();
  return to_xyz.inverse();
}

double encode_srgb(double linear) {
  const double x = std::clamp(linear, 0.0, 1.0);
  return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
}

double decode_srgb(double encoded) {
  const double x = std::clamp(encoded, 0.0, 1.0);
  return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
}

DisplayColours display_colours(std::span<const std::string> channels, std::span<const double> wavelengths) {
  const auto count = static_cast<Eigen::Index>(channels.size());
  if (count == 0) throw ArgumentError("no channels; expected at least one");
  if (count == 1) return {Eigen::MatrixXd::Ones(1, 1), "grey"};
  auto places = primaries(channels);
  if (places.empty() && count == 3 && wavelengths.empty() && are_unnamed(channels)) places = {0, 1, 2};
  if (!places.empty()) {
    Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(3, count);
    for (Eigen::Index k = 0; k < 3; ++k) weights(k, places[static_cast<std::size_t>(k)]) = 1;
    return {std::move(weights), "linear sRGB"};
  }
  std::vector<double> spectrum(wavelengths.begin(), wavelengths.end());
  if (spectrum.empty()) std::ranges::transform(channels, std::back_inserter(spectrum), wavelength_of);
  const bool is_spectrum = std::ranges::none_of(spectrum, [](double nm) { return std::isnan(nm); });
  if (is_spectrum && spans_visible(spectrum) && !visible_gap(spectrum)) {
    return {xyz_to_srgb() * spectrum_to_xyz(spectrum, Illuminant::daylight), "spectrum under D65"};
  }
  return {Eigen::MatrixXd::Constant(1, count, 1.0 / static_cast<double>(count)),
          "mean of " + std::to_string(count) + " channels"};
}

}  // namespace lobe
