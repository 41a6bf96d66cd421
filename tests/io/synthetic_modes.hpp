#pragma once

#include "lobe/reflectance/azimuthal_modes.hpp"

namespace lobe::test {

/// Modes of two channels, one cosine of light and two of view; all values differ.
inline AzimuthalModes synthetic_modes() {
  AzimuthalModes modes;
  modes.name = "paint";
  modes.channels = {"red", "blue"};
  modes.cosines_in = {0.5};
  modes.cosines_out = {0.25, 0.75};
  modes.count = 3;
  modes.tolerance = 1e-8;
  for (int k = 0; k < 12; ++k) {
    modes.values.push_back(0.1 + k);
    modes.errors.push_back(1e-9 * k);
  }
  modes.left_out = {0.01, 0.02};
  modes.one_sided = {0, 0};
  return modes;
}

}  // namespace lobe::test
