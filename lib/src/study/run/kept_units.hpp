#pragma once

#include <map>
#include <string>

#include "lobe/study/study.hpp"

namespace lobe {

/// Names under which a checkpoint keeps units of a study. Its identity (checkpoint_identity()) has materials and
/// settings: units that depend on more have a digest of that in their names, and results under tabulated light, whose
/// files nobody compares, are not kept.
class KeptNames {
 public:
  explicit KeptNames(const Study& study);

  /// Name of a unit's record; empty: it is not kept.
  [[nodiscard]] std::string of(const std::string& unit) const;

 private:
  std::map<std::string, std::string, std::less<>> special_;
};

}  // namespace lobe
