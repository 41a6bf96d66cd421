#include <string>

#include "models/family/anisotropic.hpp"
#include "models/model_test.hpp"

namespace lobe::test {
namespace {

ModelCase basic_patch(const std::string& radius, const std::string& ratio, const std::string& p,
                      const std::string& rotation) {
  return patch("basic_patch_anisotropic", "R=" + radius + ",ratio=" + ratio + ",p=" + p + ",rotation=" + rotation,
               std::stold(radius), {std::stold(ratio), std::stold(p), static_cast<Real>(std::stod(rotation))}, 2e-6L);
}

}  // namespace

ModelTest basic_patch_anisotropic_test() {
  return {.budget = {8, 1.7, 1, 0.4},
          .cases = {basic_patch("0.001", "0.01", "2", "0.6"), basic_patch("0.3", "1", "2", "0"),
                    basic_patch("0.3", "0.2", "2", "-1.2"), basic_patch("0.5", "0.5", "1", "0.6"),
                    basic_patch("0.7", "0.3", "1.5", "0"), basic_patch("1.25", "0.8", "3", "0"),
                    basic_patch("0.4", "0.5", "100", "0.6"), basic_patch("2", "0.5", "1", "0.6"),
                    basic_patch("2", "0.5", "2", "0.6")}};
}

}  // namespace lobe::test
