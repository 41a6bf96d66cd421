#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "lobe/model/material.hpp"

namespace lobe::test {

/// Materials of every kind of model, wide and sharp, and a mixture; for properties of metrics.
inline const std::vector<std::string>& sample_specifications() {
  static const std::vector<std::string> list = {"lambert",
                                                "lambert:scale=0.5",
                                                "phong:n=5",
                                                "phong:n=500",
                                                "metal_phong:n=20",
                                                "blinn:n=20",
                                                "blinn_phong:n=1000",
                                                "ward:m=0.2",
                                                "ward:m=0.01",
                                                "cook_torrance:m=0.3",
                                                "cook_torrance:m=0.05,f0=0.04",
                                                "oren_nayar:sigma=0.5",
                                                "exponential_patch:s=8",
                                                "minnaert:k=1",
                                                "basic_patch:R=0.5",
                                                "patch_frustum:R=0.6,inner=0.4",
                                                "patch_band:R=0.5,inner=0.2",
                                                "lafortune:c_xy=-1,c_z=0.8,n=10",
                                                "lafortune_ngan:c_xy=-0.98,c_z=0.96,n=50",
                                                "lambert:scale=0.3+ward:m=0.2,scale=0.5"};
  return list;
}

/// Lobes of all widths of two models, which differ little in part, and mixtures: enough pairs to meet errors that are
/// small by accident.
inline std::vector<std::string> many_specifications() {
  std::vector<std::string> list;
  constexpr int kWidths = 40;
  for (const std::string model : {"ward", "cook_torrance"}) {
    for (int k = 0; k < kWidths; ++k) {
      list.push_back(model + ":m=" + std::to_string(0.05 * std::pow(12.0, k / (kWidths - 1.0))));
    }
  }
  constexpr int kMixtures = 10;
  for (int k = 0; k < kMixtures; ++k) {
    const double t = k / (kMixtures - 1.0);
    const std::string width = std::to_string(0.03 * std::pow(20.0, t));
    const std::string power = std::to_string(2 * std::pow(100.0, t));
    list.push_back("lambert:scale=0.3+ward:scale=0.4,m=" + width);
    list.push_back("lambert:scale=0.7+ggx:scale=0.1,alpha=" + width);
    list.push_back("lambert:scale=0.2+blinn_phong:scale=0.5,n=" + power);
    list.push_back("phong:scale=0.6,n=" + power);
  }
  return list;
}

inline std::vector<Material> parse_all(const std::vector<std::string>& specifications) {
  std::vector<Material> materials;
  for (const auto& text : specifications) materials.push_back(parse_material(text));
  return materials;
}

}  // namespace lobe::test
