#pragma once

#include <string>

#include "lobe/study/study_results.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// A study's results as a page for a browser (HTML): distances in colours, trees, maps, curves of any two materials,
/// nearest materials, approximations, provenance, and the commands that compute the numbers again. It holds all that it
/// needs and loads nothing.
[[nodiscard]] std::string report_page(const StudyResults& results);

}  // namespace lobe
