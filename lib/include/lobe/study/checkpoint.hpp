#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "lobe/compare/literature_metric.hpp"
#include "lobe/metric/metric.hpp"
#include "lobe/study/study.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// A file in which a study that is being computed keeps the result of each lighting and each comparison metric that
/// took a second or more, as soon as it is there. However a run ends, the next one of the same study goes on from
/// there, with the same numbers to the last bit. The file is no document: it is read by the build and on the device
/// that wrote it alone. For other studies and builds it counts as empty, and is replaced when they have something to
/// keep; what is no checkpoint is left alone. Light that is a table is not kept.
class Checkpoint {
 public:
  /// A checkpoint in a file, which open() reads.
  /// \param path of the file, which need not exist
  explicit Checkpoint(std::filesystem::path path) : path_(std::move(path)) {}

  /// Where the file is.
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Results that the file holds.
  [[nodiscard]] std::size_t kept() const { return records_.size(); }

  /// Reads the file, if there is one, and leaves it as it is. What another study, device or build has left is not
  /// taken; nor is a damaged end.
  void open(const Study& study, const Device& device);
  /// The result under a lighting, if the file holds it.
  [[nodiscard]] std::optional<MetricResult> find(const Lighting& lighting) const;
  /// The same of a comparison metric.
  [[nodiscard]] std::optional<LiteratureResult> find(LiteratureMetric comparison) const;
  /// Where the file cannot be written it is removed, and nothing is kept: the study itself goes on.
  void keep(const MetricResult& result, double seconds);
  /// The same of a comparison metric.
  void keep(const LiteratureResult& result, double seconds);
  /// Removes the file, when its study is complete. That of another study stays.
  void remove();

 private:
  void keep(const std::string& name, const std::string& content, double seconds);

  std::filesystem::path path_;
  std::string identity_;
  std::map<std::string, std::string, std::less<>> records_;
  bool is_broken_ = false;                  ///< nothing is kept
  bool is_ours_ = false;                    ///< the file holds results of this study
  std::optional<std::size_t> sound_bytes_;  ///< of a file that was opened, without a damaged end
};

/// As run_study(device, study, progress), with a checkpoint that it takes results from and leaves results in.
[[nodiscard]] StudyResult run_study(const Device& device, const Study& study, Checkpoint& checkpoint,
                                    const ProgressCallback& progress = {});

}  // namespace lobe
