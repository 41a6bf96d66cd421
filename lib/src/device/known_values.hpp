#pragma once

#include <array>
#include <span>
#include <string_view>

#include "lobe/core/directions.hpp"

namespace lobe {

/// Pairs of directions at which values of all models are known: some distance from the mirror direction, across the
/// plane of incidence, on the retro side, and at grazing angles.
inline constexpr std::array<Directions, 4> kKnownPairs{
    {{0.4, 0.5, 2.9, 0.3}, {0.9, 0.7, 1.2, 1.1}, {0.2, 1.1, 0.1, 2.0}, {1.2, 1.25, 3.1, -0.5}}};

/// Known values of a kernel of kernels/models/, for one set of parameters.
struct KnownModel {
  std::string_view kernel;
  bool is_anisotropic;
  std::string_view material;            ///< specification of the model and its parameters
  std::array<double, 10> coefficients;  ///< c0 to c9, sr^-1 and as the kernel's file says
  std::array<double, 4> values;         ///< at kKnownPairs, sr^-1
};

/// One for each kernel of the catalogue, whose entries have them: model/catalogue.cpp gives them.
[[nodiscard]] std::span<const KnownModel> known_models();

/// Known values of a kernel of kernels/factors/, for one set of parameters.
struct KnownFactor {
  std::string_view factor;
  std::string_view specification;      ///< the factor and its parameters
  std::array<double, 2> coefficients;  ///< its constants
  std::array<double, 4> values;        ///< at kKnownPairs
};

/// One for each factor. tests/kernel/factors_test.cpp holds them against the reference.
[[nodiscard]] std::span<const KnownFactor> known_factors();

}  // namespace lobe
