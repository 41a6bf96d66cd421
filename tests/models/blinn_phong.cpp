#include <cmath>

#include "models/family/blinn.hpp"
#include "models/model_test.hpp"

namespace lobe::test {
namespace {

ModelCase blinn_phong(const std::string& n) {
  const Real exponent = std::stold(n);
  return {"blinn_phong:n=" + n,
          [=](const Vector& l, const Vector& v) { return reference::blinn_phong(l, v, exponent); },
          blinn_condition(exponent), static_cast<double>(2 / std::sqrt(exponent))};
}

}  // namespace

ModelTest blinn_phong_test() {
  return {.budget = {16, 4.2, 4, 0.9},
          .cases = {blinn_phong("1"), blinn_phong("20"), blinn_phong("1200"), blinn_phong("100000")},
          .excess = AlbedoExcess{"blinn_phong:n=1", 0, 1.3654}};
}

}  // namespace lobe::test
