#include <string>

#include "models/family/anisotropic.hpp"
#include "models/model_test.hpp"

namespace lobe::test {
namespace {

ModelCase retro_patch(const std::string& radius, const std::string& ratio, const std::string& p,
                      const std::string& rotation) {
  return patch("retro_patch_anisotropic", "R=" + radius + ",ratio=" + ratio + ",p=" + p + ",rotation=" + rotation,
               std::stold(radius), {std::stold(ratio), std::stold(p), static_cast<Real>(std::stod(rotation))},
               2e-6L / std::stold(radius));
}

}  // namespace

ModelTest retro_patch_anisotropic_test() {
  return {.budget = {4, 0.86, 1, 0.34},
          .cases = {retro_patch("0.01", "0.1", "2", "0.6"), retro_patch("0.3", "0.2", "2", "0"),
                    retro_patch("0.5", "0.5", "1", "0.6"), retro_patch("0.7", "0.3", "3", "-1.2"),
                    retro_patch("2", "0.5", "2", "0.6")}};
}

}  // namespace lobe::test
