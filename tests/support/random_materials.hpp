#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "lobe/model/material.hpp"

namespace lobe::test {

/// Random numbers that are the same with every standard library.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : generator_(seed) {}

  /// In [low, high).
  double uniform(double low, double high) { return low + (high - low) * std::ldexp(double(generator_() >> 11), -53); }
  /// The same, evenly by its logarithm.
  double spread(double low, double high) { return low * std::pow(high / low, uniform(0, 1)); }
  /// In 0 .. count-1.
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(generator_() % count); }

 private:
  std::mt19937_64 generator_;
};

/// A lobe of a random model and roughness.
/// \param narrowest half-vector width, radians
inline Material random_lobe(Dice& dice, double narrowest) {
  const double width = dice.spread(narrowest, 0.6);
  const double mirror_exponent = 1 / (2 * width * width);
  switch (dice.below(10)) {
    case 0:
      return make_material("lambert");
    case 1:
      return make_material("phong", {{"n", mirror_exponent}});
    case 2:
      return make_material("metal_phong", {{"n", mirror_exponent}});
    case 3:
      return make_material("blinn", {{"n", 4 * mirror_exponent}});
    case 4:
      return make_material("ward", {{"m", width}});
    case 5:
      return make_material("cook_torrance", {{"m", width}, {"f0", dice.uniform(0, 1)}});
    case 6:
      return make_material("oren_nayar", {{"sigma", dice.uniform(0, 1)}});
    case 7:
      return make_material("exponential_patch", {{"s", 1 / (2 * width)}});
    case 8:
      return make_material("minnaert", {{"k", dice.uniform(0, 2)}});
    default:
      return make_material("lafortune_ngan", {{"c_xy", -1}, {"c_z", dice.uniform(0.8, 1)}, {"n", mirror_exponent}});
  }
}

inline Material scaled(double factor, Material material) {
  material.name = std::to_string(factor) + " " + material.name;
  for (Term& term : material.terms) {
    for (double& weight : term.weight) weight *= factor;
  }
  return material;
}

inline Material sum_of(Material f, const Material& g) {
  f.name += " + " + g.name;
  f.terms.insert(f.terms.end(), g.terms.begin(), g.terms.end());
  return f;
}

/// The same list for the same arguments: lobes, and mixtures of two, of random scales.
inline std::vector<Material> random_materials(std::size_t count, double narrowest) {
  Dice dice(2001);
  const auto draw = [&] {
    const double scale = dice.uniform(0.2, 1);
    return scaled(scale, random_lobe(dice, narrowest));
  };
  std::vector<Material> materials;
  for (std::size_t i = 0; i < count; ++i) {
    materials.push_back(draw());
    if (i % 3 == 2) materials.back() = sum_of(materials.back(), draw());
  }
  return materials;
}

}  // namespace lobe::test
