#pragma once

#include <vector>

#include "lobe/material.hpp"

namespace lobe {

/// A material's delta parts apart from the rest.
struct DeltaSplit {
  Material smooth;             ///< the terms with values in sr^-1; may have none
  std::vector<double> mirror;  ///< factor of the ideal mirror by channel
  std::vector<double> retro;   ///< factor of the retro-reflecting ideal mirror (RRIM) by channel
};

[[nodiscard]] DeltaSplit split_delta(const Material& material);

}  // namespace lobe
