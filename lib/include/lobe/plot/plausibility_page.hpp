#pragma once

#include <span>
#include <string>

#include "lobe/energy/plausibility.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// Writes the results for models as a page for people (Markdown): docs/plausibility.md. Each model has a row: name,
/// largest albedo (1) or exponent of its growth with its error and angle (degrees), smallest value (sr^-1), reciprocity
/// defect. Violations are bold, each with the material in which it was seen.
[[nodiscard]] std::string plausibility_page(std::span<const ModelPlausibility> models);

}  // namespace lobe
