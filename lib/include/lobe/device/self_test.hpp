#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "lobe/device/device.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// How a kernel did in a self-test.
struct SelfTestResult {
  std::string kernel;      ///< its file, what it was built for, and the precision where that is single
  double deviation = 0;    ///< largest deviation from a known result, as a share of it
  double allowed = 0;      ///< what rounding may take it to
  bool is_sound = false;   ///< deviation <= allowed
  std::string error = {};  ///< why there is no result; empty: there is one
};

/// Has every kind of kernel compute what is known: each model, factor and correction of pumping at a few pairs of
/// directions, against values of an independent reference; sums, products, samples, pictures and patch lights of a few
/// numbers, against the same on the host. What a process uses of these it tests before the first use anyway, and throws
/// DeviceError where it is wrong. Formulas of the user's have no known values; they are not tested.
/// \param part of the names of kernels that are to be tested; empty: all
[[nodiscard]] std::vector<SelfTestResult> self_test(const Device& device, std::string_view part = {});

}  // namespace lobe
