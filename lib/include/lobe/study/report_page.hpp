#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "lobe/core/progress.hpp"
#include "lobe/device/device.hpp"
#include "lobe/plot/preview_sheet.hpp"
#include "lobe/study/study.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// Spheres of a study's materials, one per material; none for a material that has none.
using ReportSpheres = std::vector<std::optional<DisplayedSphere>>;

/// Most materials of a study whose page has spheres.
inline constexpr std::size_t kMostReportSpheres = 100;
/// Pixels along an edge of the pictures of these spheres.
inline constexpr std::size_t kReportSphereSize = 64;

/// Renders a sphere of each material of a study under three_point_lights(), exposed as contact sheets are. Materials
/// that are files, or whose lobes are too narrow for so few pixels, have none. The list is empty for studies of more
/// than kMostReportSpheres materials.
/// \throws as render_sphere(), but for narrow lobes; Cancelled
[[nodiscard]] ReportSpheres report_spheres(const Device& device, const StudyResult& result,
                                           const ProgressCallback& progress = {});

/// Writes a study's results as a page for a browser (HTML): distances in colours, trees, maps, curves of any two
/// materials, nearest materials, approximations, provenance, and the commands that reproduce the numbers. The page is
/// self-contained and loads nothing.
/// \param spheres spheres shown beside the names of materials, as of report_spheres(); empty: none
/// \throws ArgumentError for a study without materials, and for spheres of another number
[[nodiscard]] std::string report_page(const StudyResult& result, const ReportSpheres& spheres = {});

}  // namespace lobe
