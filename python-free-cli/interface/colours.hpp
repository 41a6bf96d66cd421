#pragma once

#include "lobe/core/colour.hpp"
#include "lobe/table/reflectance.hpp"

namespace lobe::cli {

/// Colours in which the channels of a reflectance are displayed: by their names, or by the wavelengths of a file.
[[nodiscard]] DisplayColours colours_of(const Reflectance& reflectance);

}  // namespace lobe::cli
