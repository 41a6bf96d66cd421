#pragma once

#include <string>

#include "lobe/device/device.hpp"
#include "lobe/study/study.hpp"

namespace lobe {

/// All that results in a checkpoint depend on, as a text. Files count by place, size and time.
/// \param study with_channels()
[[nodiscard]] std::string checkpoint_identity(const Study& study, const Device& device);

/// Digests of parts of a study that checkpoint_identity() does not have.
[[nodiscard]] std::string part_digest(const PublishedFigure& figure);
[[nodiscard]] std::string part_digest(const Chart& chart);

/// What the results of shards depend on. Files count by what is in them, wherever they lie.
struct PlanIdentity {
  std::string version;  ///< of lobe, with its commit
  std::string build;    ///< build_identity()
  std::string device;   ///< name, platform and driver
  std::string plan;     ///< digest of the study with its options and the contents of its files

  /// All of it.
  [[nodiscard]] std::string text() const { return version + "\n" + build + "\n" + device + "\n" + plan + "\n"; }
};

/// \throws IoError for a file that cannot be read
[[nodiscard]] PlanIdentity plan_identity(const Study& study, const Device& device);

}  // namespace lobe
