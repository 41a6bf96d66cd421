#pragma once

#include <ostream>

#include "lobe/metric/lighting.hpp"

namespace lobe {

inline void PrintTo(const Lighting& lighting, std::ostream* out) {
  *out << lighting.name();
}

}  // namespace lobe
