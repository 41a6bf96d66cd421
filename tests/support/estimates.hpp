#pragma once

#include <gmock/gmock.h>

#include <cmath>

#include "lobe/core/estimate.hpp"

namespace lobe::test {

/// An estimate whose value is `expected`, up to `tolerance`.
MATCHER_P2(EstimateNear, expected, tolerance, "") {
  *result_listener << "is " << arg.value << ", expected " << expected;
  return std::abs(arg.value - expected) <= tolerance;
}

/// An estimate whose value is `expected`, up to its own error and `slack`.
MATCHER_P2(EstimateCovers, expected, slack, "") {
  *result_listener << "is " << arg.value << " +- " << arg.error << ", expected " << expected;
  return std::abs(arg.value - expected) <= arg.error + slack;
}

}  // namespace lobe::test
