#pragma once

#include <string>

#include "lobe/study/study_results.hpp"

namespace lobe {

/// What the script of a report reads, as JSON in ASCII: numbers with as many digits as their errors leave, symmetric
/// matrices as their lower triangles, row after row, and commands of a shell. Of comparison metrics, trees and maps are
/// computed. Free of `<`, so that no text in it ends an HTML element.
[[nodiscard]] std::string report_data(const StudyResults& results);

}  // namespace lobe
