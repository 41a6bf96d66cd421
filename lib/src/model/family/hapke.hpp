#pragma once

#include <algorithm>
#include <cmath>

#include "model/catalogue.hpp"

namespace lobe {

inline Parameter compaction() {
  return {"g", "1", 0.01, 10, std::nullopt, "compaction; smaller is a sharper opposition peak"};
}

/// \param v g
inline double opposition_width(Values v) {
  return std::clamp(v[0] / 20, 1e-3, 0.5);
}

}  // namespace lobe
