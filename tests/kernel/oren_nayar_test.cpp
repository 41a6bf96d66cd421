#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "model/evaluate.hpp"
#include "models/model_test.hpp"
#include "support/device.hpp"

namespace lobe::test {
namespace {

TEST(OrenNayarFull, IsNotNegativeWhereTheSumOfItsTermsIs) {
  const std::vector<Directions> grazing_mirror{{1.569, 1.569, std::acos(-1.0)}};

  EXPECT_EQ(evaluate(device(), parse_material("oren_nayar_full:sigma=1.5,rho=0.01"), grazing_mirror)(0, 0), 0);
}

}  // namespace
}  // namespace lobe::test
