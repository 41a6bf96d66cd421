#include "core/spectral_range.hpp"

#include <algorithm>
#include <limits>
#include <vector>

#include "core/text.hpp"

namespace lobe {

double wavelength_of(std::string_view name) {
  double nanometres = 0;
  const bool is_wavelength = name.ends_with(" nm") && parse_number(name.substr(0, name.size() - 3), nanometres);
  return is_wavelength ? nanometres : std::numeric_limits<double>::quiet_NaN();
}

std::optional<std::pair<double, double>> visible_gap(std::span<const double> wavelengths) {
  std::vector<double> sorted(wavelengths.begin(), wavelengths.end());
  std::ranges::sort(sorted);
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    const bool is_visible = sorted[i] > kVisibleFrom && sorted[i - 1] < kVisibleTo;
    if (is_visible && sorted[i] - sorted[i - 1] > kWidestGap) return std::pair{sorted[i - 1], sorted[i]};
  }
  return std::nullopt;
}

bool spans_visible(std::span<const double> wavelengths) {
  if (wavelengths.size() < 3) return false;
  const auto [low, high] = std::ranges::minmax(wavelengths);
  return low <= kVisibleFrom && high >= kVisibleTo;
}

}  // namespace lobe
