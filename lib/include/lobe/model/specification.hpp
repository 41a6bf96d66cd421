#pragma once

#include <optional>
#include <string>

#include "lobe/model/material.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// Finds the text that parse_material() reads as this material, identical to the last bit except for name and family.
/// There is none for user formulas, nor for the results of adjusted() on pumping-up and mirrors.
[[nodiscard]] std::optional<std::string> specification(const Material& material);

}  // namespace lobe
