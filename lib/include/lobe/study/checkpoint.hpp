#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "lobe/compare/literature_metric.hpp"
#include "lobe/metric/metric.hpp"
#include "lobe/study/study.hpp"

namespace [[gnu::visibility("default")]] lobe {

class Ranks;
struct CrewOptions;

/// A file that keeps the result of each lighting and each comparison metric, or tile of one, of a running study that
/// took a second or more, as soon as it is known. However a run ends, the next run of the same study continues from
/// there, with the same numbers to the last bit. The file is not a document: only the build and the device that wrote
/// it read it. For other studies and builds it counts as empty, and is replaced when they have something to keep; a
/// file that is not a checkpoint is left alone. Results under tabulated light are not kept.
class Checkpoint {
 public:
  /// Makes a checkpoint in a file, which open() reads.
  /// \param path path of the file, which need not exist
  explicit Checkpoint(std::filesystem::path path);

  /// Path of the file.
  [[nodiscard]] const std::filesystem::path& path() const;
  /// Number of results in the file.
  [[nodiscard]] std::size_t kept() const;

  /// Reads the file, if there is one, without changing it. Results of another study, device or build are ignored, and
  /// so is a damaged end.
  void open(const Study& study, const Device& device);
  /// Finds the result under a lighting, if the file holds it.
  [[nodiscard]] std::optional<MetricResult> find(const Lighting& lighting) const;
  /// Finds the result for a comparison metric, if the file holds it.
  [[nodiscard]] std::optional<LiteratureResult> find(LiteratureMetric comparison) const;
  /// Keeps the result under a lighting. If the file cannot be written it is removed, and nothing is kept: the study
  /// itself goes on.
  void keep(const MetricResult& result, double seconds);
  /// Keeps the result for a comparison metric.
  void keep(const LiteratureResult& result, double seconds);
  /// Removes the file, when its study is complete. The file of another study stays.
  void remove();

 private:
  friend StudyResult run_study(const Device& device, const Study& study, Checkpoint& checkpoint,
                               const ProgressCallback& progress);
  friend StudyResult run_study(const Device& device, const Study& study, Checkpoint* checkpoint, Ranks& ranks,
                               const CrewOptions& options);
  friend StudyResult run_study(const std::vector<Device>& devices, const Study& study, Checkpoint* checkpoint,
                               const CrewOptions& options);

  struct Implementation;
  std::shared_ptr<Implementation> implementation_;
};

/// Runs a study like run_study(device, study, progress), with a checkpoint that provides results and keeps new ones.
[[nodiscard]] StudyResult run_study(const Device& device, const Study& study, Checkpoint& checkpoint,
                                    const ProgressCallback& progress = {});

}  // namespace lobe
