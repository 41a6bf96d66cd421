#include <gtest/gtest.h>

#include <vector>

#include "model/evaluate.hpp"
#include "models/model_test.hpp"
#include "support/device.hpp"

namespace lobe::test {
namespace {

TEST(Minnaert, WithoutExponentIsLambertExactly) {
  const std::vector<Directions> directions{{0, 0, 0}, {0.5, 1.2, 2}, {1.57, 1.57, 3}};

  EXPECT_EQ(evaluate(device(), parse_material("minnaert:k=0"), directions),
            evaluate(device(), parse_material("lambert"), directions));
}

}  // namespace
}  // namespace lobe::test
