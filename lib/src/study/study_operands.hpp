#pragma once

#include <string>
#include <vector>

#include "lobe/study.hpp"

namespace lobe {

/// A study's materials where some are files: as functions, which are measured by quadrature of their own, or on the
/// study's grid.
struct StudyOperands {
  std::vector<BrdfFunction>
      functions;                   ///< one per material; empty where the study has a grid, and where none is a file
  std::vector<BrdfTable> tables;   ///< one per material; empty where nothing asks for them
  std::vector<std::string> files;  ///< JSON of each material that is a file; empty ones for formulas
};

/// Tables are made where the study has a grid, and where it asks of files what functions do not give: light of patches,
/// comparison metrics.
/// \param study its materials prepared
/// \throws as load_material(), as_function() and tabulate(); ArgumentError for channels that do not fit those of the
///   study; Cancelled.
[[nodiscard]] StudyOperands study_operands(const Device& device, const Study& study, const ProgressCallback& progress);

}  // namespace lobe
