#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "lobe/device/device.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// Result of a kernel's self-test.
struct SelfTestResult {
  std::string kernel;      ///< its file, the purpose it was built for, and the precision if that is single
  double deviation = 0;    ///< largest deviation from a known result, relative to it
  double allowed = 0;      ///< largest deviation that rounding may cause
  bool is_sound = false;   ///< deviation <= allowed
  std::string error = {};  ///< why there is no result; empty if there is one
};

/// Tests every kind of kernel against known results: each model, factor and pumping correction at a few pairs of
/// directions, against values from an independent reference; sums, products, samples, pictures and patch lights for a
/// few numbers, against the host. A process tests the kernels it uses before their first use anyway, and throws
/// DeviceError if one is wrong. User formulas have no known values and are not tested.
/// \param part part of the names of kernels to test; empty: all
[[nodiscard]] std::vector<SelfTestResult> self_test(const Device& device, std::string_view part = {});

}  // namespace lobe
