#pragma once

#include <Eigen/SparseCore>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "device/sampler.hpp"
#include "lobe/material.hpp"

namespace lobe {

/// The distinct lobes of a set of materials and how the materials are made of them:
/// f_material = sum over lobes of mix[channel](material, lobe) * f_lobe. Everything that is linear or bilinear in the
/// reflectance is computed for lobes and then mixed.
struct LobeSet {
  std::vector<LobeBatch> batches;  ///< lobes grouped by kernel; their order is the order of the columns of mix
  std::vector<std::string> names;  ///< of lobes, for messages: "ward(m=0.2)"
  /// materials x lobes, one matrix per channel
  std::vector<Eigen::SparseMatrix<double, Eigen::RowMajor>> mix;
  double narrowest = 1;  ///< smallest half-vector width, radians, in (0, 1]
  /// Base-plane distances from the mirror direction at which lobes jump (4.2), rising, each once.
  std::vector<double> patch_radii;

  [[nodiscard]] std::size_t lobes() const { return names.size(); }
  [[nodiscard]] std::size_t channels() const { return mix.size(); }
};

/// \throws ArgumentError when there is no material, a material has no term, or channel counts do not fit: every
///   material has one channel or the largest number among them. NumericError for delta parts.
[[nodiscard]] LobeSet make_lobe_set(std::span<const Material> materials);

}  // namespace lobe
