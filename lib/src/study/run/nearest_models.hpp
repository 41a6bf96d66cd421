#pragma once

#include <string>

#include "lobe/study/study.hpp"

namespace lobe {

/// Whether a study has both materials that are files and others.
[[nodiscard]] bool has_nearest_models(const Study& study);

/// NAME.<lighting>.nearest-models.csv: for each material that is a file, the nearest ones that are formulas: as they
/// are
/// (`distance`), and times the factor that brings each of them nearest (`scaled`).
[[nodiscard]] std::string nearest_models_csv(const Study& study, const Metric& metric);

}  // namespace lobe
