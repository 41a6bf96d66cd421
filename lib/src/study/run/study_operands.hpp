#pragma once

#include <string>
#include <vector>

#include "lobe/study/study.hpp"
#include "lobe/table/reflectance.hpp"

namespace lobe {

/// Materials of a study: formulas, and the contents of its files.
struct StudyOperands {
  std::vector<Reflectance> reflectances;  ///< one per material
  std::vector<std::string> files;  ///< JSON of each material that is a file, empty ones for formulas; none: no files
};

/// Reads the files of a study.
/// \throws as load_reflectance(); ArgumentError for channels that do not fit those of the study; Cancelled.
[[nodiscard]] StudyOperands study_operands(const Study& study, const ProgressCallback& progress);

}  // namespace lobe
