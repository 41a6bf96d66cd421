#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "lobe/core/progress.hpp"
#include "lobe/device/device.hpp"
#include "lobe/study/checkpoint.hpp"
#include "lobe/study/study.hpp"

namespace lobe {

/// One of the things that run_study() and write_study() do.
struct PlannedStage {
  std::string name;         ///< a lighting, a comparison metric, "curves", "chart NAME", ...
  std::string method = {};  ///< of lightings and comparison metrics: the rule, and what is known of its nodes before
  std::uint64_t nodes = 0;  ///< quadrature nodes that the sample took; the whole study takes as many or more
  double seconds = 0;       ///< expected
  bool is_kept = false;     ///< a checkpoint has the result
};

/// What running a study will take.
struct StudyPlan {
  std::vector<std::pair<std::string, std::size_t>> families;  ///< with their numbers of materials
  std::size_t materials = 0;                                  ///< in all
  std::size_t pairs = 0;                                      ///< of different materials
  std::size_t sampled = 0;            ///< materials of the largest sample that was measured; 0: none was in time
  std::vector<PlannedStage> stages;   ///< in the order of the run
  double seconds = 0;                 ///< in all, of what no checkpoint has
  double seconds_low = 0;             ///< at least
  double seconds_high = 0;            ///< at most; infinite where not even a few materials were in time
  std::uint64_t work_bytes = 0;       ///< at the peak, beside what the process occupies before
  std::vector<std::string> files;     ///< names of tables and pages
  std::vector<std::string> pictures;  ///< names of pictures, each beside its script and data
};

/// How much is measured.
struct PlanOptions {
  double sample_seconds = 5;               ///< no sample is begun that would not end within about this time
  double deadline_seconds = 20;            ///< a sample that takes longer is given up
  const Checkpoint* checkpoint = nullptr;  ///< opened for the study; none: nothing is kept
  ProgressCallback progress = {};          ///< called meanwhile
};

/// Measures what a study takes on a device by the same computations for some of its materials, figures and curves, and
/// extrapolates. Writes nothing but one picture into a temporary directory, which is removed. Files of the study are
/// checked, all of them, before.
/// \throws IoError, ArgumentError for files that cannot be read or are of no known format; as run_study().
[[nodiscard]] StudyPlan plan_study(const Device& device, const Study& study, const PlanOptions& options = {});

/// Reads the beginning of every file of a study.
/// \throws IoError for those that cannot be read and those of no known format.
void check_files(const Study& study);

}  // namespace lobe
