#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

#include "lobe/formats/measured.hpp"

namespace lobe {

inline constexpr std::string_view kScatfunMagic = "SCATFUN";
inline constexpr std::size_t kScatfunHeader = 64;

/// Luminance that files hold in place of green: of red, green and blue.
inline constexpr std::array<double, 3> kScatfunLuminance{0.212671, 0.715160, 0.072169};

/// The content of a file: reflection from above over the cosines of both directions, as series of cosines of the
/// azimuth.
/// \throws ArgumentError for reflectances that are anisotropic or not the same on both sides of the plane of incidence,
///   and channels other than one, or red, green and blue; NumericError for values that are not finite
[[nodiscard]] std::string write_scatfun(const BrdfFunction& brdf, const WriteOptions& options);

}  // namespace lobe
