#pragma once

#include <string>
#include <vector>

#include "lobe/study.hpp"

namespace lobe {

/// Whether a study is computed on a grid: one is given, or materials are files.
[[nodiscard]] bool needs_tables(const Study& study);

/// A study's materials on its grid.
struct StudyTables {
  std::vector<BrdfTable> tables;   ///< one per material
  std::vector<std::string> files;  ///< JSON of each material that is a file: format, conventions, remarks; else empty
};

/// \param study its materials prepared
/// \throws as load_material() and tabulate(); ArgumentError for channels that do not fit those of the study; Cancelled.
[[nodiscard]] StudyTables tabulate_study(const Device& device, const Study& study, const ProgressCallback& progress);

}  // namespace lobe
