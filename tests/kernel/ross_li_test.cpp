#include <gtest/gtest.h>

#include <vector>

#include "model/evaluate.hpp"
#include "models/model_test.hpp"
#include "support/device.hpp"

namespace lobe::test {
namespace {

TEST(RossLi, VanishesWithSunAndViewerAtTheZenith) {
  const std::vector<Directions> zenith{{0, 0, 0}};

  EXPECT_NEAR(evaluate(device(), parse_material("ross_thick"), zenith)(0, 0), 0, 1e-15);
  EXPECT_NEAR(evaluate(device(), parse_material("li_sparse"), zenith)(0, 0), 0, 1e-15);
}

}  // namespace
}  // namespace lobe::test
