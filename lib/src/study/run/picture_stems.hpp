#pragma once

#include <string>
#include <vector>

#include "lobe/study/study.hpp"

namespace lobe {

/// The stems of the pictures that write_study() makes of a study's results, in that order.
[[nodiscard]] std::vector<std::string> picture_stems(const Study& study);

}  // namespace lobe
