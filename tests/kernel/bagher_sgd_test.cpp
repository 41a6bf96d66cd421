#include <gtest/gtest.h>

#include <cmath>

#include "models/family/bagher_sgd.hpp"
#include "models/model_test.hpp"

namespace lobe::test {
namespace {

TEST(BagherSgd, ComputesTheConstantsOfThePublishedFits) {
  for (const auto& [parameters, fit, normalisation, rate] : kPublished) {
    SCOPED_TRACE(parameters);
    // Six digits are printed.
    EXPECT_NEAR(static_cast<double>(fit.normalisation() / normalisation), 1, 1e-5);
    // What is left of the attenuation at grazing angles with theirs.
    const Real left = 1 - fit.lambda * std::expm1(rate * std::pow(reference::kPi / 2 - fit.theta0, fit.k));
    EXPECT_LE(std::abs(left), 0.0026);
  }
}

}  // namespace
}  // namespace lobe::test
