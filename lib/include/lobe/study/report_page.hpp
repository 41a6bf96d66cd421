#pragma once

#include <string>

#include "lobe/study/study.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// Writes a study's results as a page for a browser (HTML): distances in colours, trees, maps, curves of any two
/// materials, nearest materials, approximations, provenance, and the commands that reproduce the numbers. The page is
/// self-contained and loads nothing.
/// \throws ArgumentError for a study without materials
[[nodiscard]] std::string report_page(const StudyResult& result);

}  // namespace lobe
