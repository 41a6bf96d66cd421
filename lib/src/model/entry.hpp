#pragma once

/// All that entries of the catalogue are written with.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "model/catalogue.hpp"
#include "model/constants.hpp"
#include "model/draw.hpp"
#include "model/family/parameters.hpp"

namespace lobe {

using std::numbers::pi;

}  // namespace lobe
