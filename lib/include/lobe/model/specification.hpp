#pragma once

#include <optional>
#include <string>

#include "lobe/model/material.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// The text that parse_material() reads as this material, to the last bit but for name and family. Nothing where there
/// is none: for formulas of the user, and for what prepare() made of pumping-up and of mirrors.
[[nodiscard]] std::optional<std::string> specification(const Material& material);

}  // namespace lobe
