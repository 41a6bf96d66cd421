#pragma once

#include <string>

#include "lobe/study/report_page.hpp"
#include "lobe/study/study.hpp"

namespace lobe {

/// Data for the script of a report, as JSON in ASCII: numbers with as many digits as their errors justify, symmetric
/// matrices as their lower triangles, row by row, and shell commands. Trees and maps are computed for comparison
/// metrics. The text contains no `<`, so that nothing in it ends an HTML element.
[[nodiscard]] std::string report_data(const StudyResult& result, const ReportSpheres& spheres);

}  // namespace lobe
