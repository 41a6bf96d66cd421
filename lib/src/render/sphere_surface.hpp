#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "lobe/device/device.hpp"
#include "lobe/model/material.hpp"
#include "lobe/render/preview.hpp"
#include "lobe/table/brdf_function.hpp"
#include "lobe/table/table.hpp"
#include "render/sky_map.hpp"
#include "render/sphere_parts.hpp"

namespace lobe {

/// Surface of a sphere, as rendering sees it: channels of the picture are rows.
struct SphereSurface {
  std::string name;
  Eigen::Index rows = 1;
  /// Integral over parts of the radiance under point lights, rows x parts.
  std::function<Eigen::MatrixXd(std::span<const SpherePart> parts, const GaussRule& rule,
                                std::span<const std::array<double, 4>> lights)>
      lit;
  SkyFunction sky;
  bool has_steps = false;  ///< the sky is seen in steps, of cells, which interpolation would smear
  SkyMap::Symmetry symmetry;
  /// Light that an ideal mirror sends towards a viewer, by row; empty if there is no mirror.
  std::function<Eigen::VectorXd(Direction view)> mirror;
  bool has_retro = false;  ///< a retro-reflecting delta part
  double width = 1;        ///< width of the narrowest lobe, radians of the half-vector
  int highest_order = 32;  ///< highest order of rules for pixels
};

/// \param material prepared
[[nodiscard]] SphereSurface surface_of(const Device& device, const Material& material, const SphereOptions& options);
/// \param stop called now and then; throws Cancelled where it is to
[[nodiscard]] SphereSurface surface_of(const BrdfTable& table, const SphereOptions& options,
                                       const std::function<void()>& stop);
/// Makes the surface of a function given by values, without cells.
[[nodiscard]] SphereSurface surface_of(const BrdfFunction& brdf, const SphereOptions& options,
                                       const std::function<void()>& stop);

}  // namespace lobe
