#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <utility>

namespace lobe {

/// "532 nm" as a number; NaN for other names.
[[nodiscard]] double wavelength_of(std::string_view name);

/// From where to where wavelengths have to go, and without gaps as wide, to say enough of the visible range, nm.
inline constexpr double kVisibleFrom = 460;
inline constexpr double kVisibleTo = 650;
inline constexpr double kWidestGap = 60;

/// The first gap within that range that is too wide.
[[nodiscard]] std::optional<std::pair<double, double>> visible_gap(std::span<const double> wavelengths);

/// Whether there are at least three that go from one end of that range to the other.
[[nodiscard]] bool spans_visible(std::span<const double> wavelengths);

}  // namespace lobe
