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

namespace [[gnu::visibility("default")]] lobe {

/// A stage of run_study() and write_study().
struct PlannedStage {
  std::string name;          ///< a lighting, a comparison metric, "curves", "chart NAME", ...
  std::string method = {};   ///< for lightings and comparison metrics: the rule, and what is known of its nodes before
  std::uint64_t nodes = 0;   ///< quadrature nodes that the trial took; the whole study takes as many or more
  double seconds = 0;        ///< expected seconds
  bool is_kept = false;      ///< whether a checkpoint has the result
  double alone_seconds = 0;  ///< seconds of maps, trees and approximations among them, which ranks do not share
};

/// Cost of running a study.
struct StudyPlan {
  std::vector<std::pair<std::string, std::size_t>> families;  ///< families with their numbers of materials
  std::size_t materials = 0;                                  ///< number of all materials
  std::size_t pairs = 0;                                      ///< number of pairs of different materials
  std::size_t tried = 0;                                      ///< materials in the largest trial; 0: none was in time
  std::vector<PlannedStage> stages;                           ///< stages in the order of the run
  double seconds = 0;                 ///< expected seconds in all, without results in a checkpoint
  double seconds_low = 0;             ///< lower bound
  double seconds_high = 0;            ///< upper bound; infinite if not even a few materials were in time
  std::uint64_t work_bytes = 0;       ///< peak memory, beside what the process occupies before
  std::uint64_t unit_bytes = 0;       ///< memory of a process that computes units for others, likewise
  std::vector<std::string> files;     ///< names of tables and pages
  std::vector<std::string> pictures;  ///< names of pictures, each beside its script and data
};

/// Options for planning.
struct PlanOptions {
  double trial_seconds = 5;                ///< a trial is begun only if it is expected to end within about this time
  double deadline_seconds = 20;            ///< a trial that takes longer is given up
  const Checkpoint* checkpoint = nullptr;  ///< opened for the study; none: nothing is kept
  ProgressCallback progress = {};          ///< called during the trials
};

/// Plans a study: times the same computations on a device for some of its materials, figures and curves, and
/// extrapolates. It writes nothing but one picture into a temporary directory, which is removed. All files of the study
/// are checked first.
/// \throws as check_files() and run_study()
[[nodiscard]] StudyPlan plan_study(const Device& device, const Study& study, const PlanOptions& options = {});

/// Largest number of ranks that a plan is made for.
inline constexpr std::size_t kMostRanks = 100'000;

/// Cost of running a study with several ranks (lobe/study/ranks.hpp), each with a device and memory of its own, like
/// those that the plan was made on.
struct RankPlan {
  std::size_t ranks = 1;          ///< number of all ranks
  std::size_t units = 0;          ///< parts that are handed out
  double seconds = 0;             ///< expected seconds in all; travelling takes none
  double alone_seconds = 0;       ///< seconds of what is not shared, among them
  std::string longest_unit;       ///< the unit that takes longest: the run takes no less; empty if there is none
  double longest_seconds = 0;     ///< its seconds
  std::uint64_t first_bytes = 0;  ///< memory of rank 0, beside what the process occupies before
  std::uint64_t other_bytes = 0;  ///< memory of each other rank, likewise; 0 if there is none
  std::uint64_t moved_bytes = 0;  ///< bytes of results that travel to rank 0
  std::uint64_t all_bytes = 0;    ///< bytes of all results, about: the most that can travel
};

/// Deals the units of a study to ranks as a run does, with the times of its plan. Which units travel depends on who is
/// quicker. Slabs of `point` of two levels have shorter results than are counted here, those of `daylight` longer ones
/// where lobes are anisotropic; single units that a checkpoint has are counted, too. Where the plan has no times units
/// are dealt by rough costs. Materials are prepared and files are read.
/// \param plan plan_study() of the same study
/// \throws ArgumentError for no ranks, or more than kMostRanks; as run_study()
[[nodiscard]] RankPlan plan_ranks(const Device& device, const Study& study, const StudyPlan& plan, std::size_t ranks,
                                  const ProgressCallback& progress = {});

/// Checks every file of a study by reading its beginning.
/// \throws IoError for files that cannot be read or are in no known format
void check_files(const Study& study);

}  // namespace lobe
