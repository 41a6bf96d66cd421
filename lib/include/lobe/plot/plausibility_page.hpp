#pragma once

#include <span>
#include <string>

#include "lobe/energy/plausibility.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// What was found of models as a page for people (Markdown): docs/plausibility.md. A row per model: name, largest
/// albedo (1) or exponent of its growth with its error and angle (degrees), smallest value (sr^-1), reciprocity defect;
/// bold what is violated, each with the material of which it was seen.
[[nodiscard]] std::string plausibility_page(std::span<const ModelPlausibility> models);

}  // namespace lobe
