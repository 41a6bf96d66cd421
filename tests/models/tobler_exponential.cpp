#include <cmath>

#include "models/family/tobler.hpp"
#include "models/model_test.hpp"

namespace lobe::test {
namespace {

ModelCase exponential(const std::string& text) {
  const Real s = std::stold(text);
  return {"tobler_exponential:s=" + text,
          [=](const Vector& l, const Vector& v) { return reference::tobler_exponential(l, v, s); },
          [=](const Vector& l, const Vector& v) { return 1 + s * spread(l, v); },
          static_cast<double>(0.5L / std::sqrt(s))};
}

}  // namespace

ModelTest tobler_exponential_test() {
  return {.budget = {16, 3.2, 16, 3.1}, .cases = {exponential("0.01"), exponential("4"), exponential("5000")}};
}

}  // namespace lobe::test
