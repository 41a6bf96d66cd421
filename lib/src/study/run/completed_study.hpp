#pragma once

#include "lobe/device/device.hpp"
#include "lobe/study/study.hpp"
#include "study/run/study_computation.hpp"

namespace lobe {

/// The whole result of a study, from its parts.
/// \throws as run_study()
[[nodiscard]] StudyResult completed_study(const Device& device, StudyComputation& computation);

}  // namespace lobe
