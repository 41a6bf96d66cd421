#pragma once

#include <string>

#include "lobe/study/study_results.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// Writes a study's results as a page for a browser (HTML): distances in colours, trees, maps, curves of any two
/// materials, nearest materials, approximations, provenance, and the commands that reproduce the numbers. The page is
/// self-contained and loads nothing.
[[nodiscard]] std::string report_page(const StudyResults& results);

}  // namespace lobe
