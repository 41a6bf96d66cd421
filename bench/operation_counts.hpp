#pragma once

#include <map>
#include <string>
#include <string_view>

#include "lobe/device/device.hpp"

namespace bench {

/// How often an evaluation calls each elementary function ("exp", "sqrt", ...) or divides ("divide").
using OperationCounts = std::map<std::string, double>;

/// A kernel file and what weighs its operations.
struct CountedKernel {
  std::string_view name;        ///< function of kernels/models/<name>.clh
  bool is_anisotropic = false;  ///< it sees azimuths
  double packs = 1;             ///< that share what depends on the node alone
  double terms = 0;             ///< passes of a series inside the model, if it has one
};

/// Counts the operations of kernels/lobes/evaluate_lobes.cl with a model in it, as clang optimises the two together:
/// constant loops unrolled, equal terms computed once, what depends on the node alone outside the loop over packs.
/// \throws std::runtime_error when clang is not there or does not compile the file, or where a loop remains that
///   terms says nothing of
[[nodiscard]] OperationCounts count_operations(const CountedKernel& kernel, lobe::Precision precision);

}  // namespace bench
