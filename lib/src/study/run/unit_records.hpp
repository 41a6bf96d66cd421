#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "compare/comparison_tiles.hpp"
#include "lobe/core/estimate.hpp"
#include "lobe/core/tolerance.hpp"
#include "lobe/study/material_curves.hpp"
#include "lobe/study/published.hpp"
#include "metric/slab_store.hpp"

namespace lobe {

/// A curve of a chart, and those of its albedos that miss the tolerance.
struct ChartCurveValues {
  std::vector<Estimate> values;
  std::vector<MissedTolerance> missed;
};

// Contents of records (checkpoint_records.hpp) of parts of a study that are smaller than a lighting.

[[nodiscard]] std::string written_unit(const RefinedSlab& slab);
[[nodiscard]] std::string written_unit(const TileIntegrals& tile);
[[nodiscard]] std::string written_unit(const MaterialCurves& curves);
[[nodiscard]] std::string written_unit(const PublishedCheck& check);
[[nodiscard]] std::string written_unit(const ChartCurveValues& curve);

/// Fills a value with what was written of one.
/// \return whether that was the whole of it
[[nodiscard]] bool read_unit(std::string_view content, RefinedSlab& slab);
[[nodiscard]] bool read_unit(std::string_view content, TileIntegrals& tile);
[[nodiscard]] bool read_unit(std::string_view content, MaterialCurves& curves);
[[nodiscard]] bool read_unit(std::string_view content, PublishedCheck& check);
[[nodiscard]] bool read_unit(std::string_view content, ChartCurveValues& curve);

}  // namespace lobe
