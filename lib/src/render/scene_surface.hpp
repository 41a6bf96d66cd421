#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "device/draw_each.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/device/device.hpp"
#include "lobe/render/render_scene.hpp"
#include "lobe/table/reflectance.hpp"

namespace lobe {

/// A direction that a path goes on in.
struct PathStep {
  UnitVector direction{};  ///< towards the light, in the frame of the surface; z is 0 where the path ends
  LinearColour weight{};   ///< f cos / density, or the share of a delta part over its probability
};

/// The direction of a viewer at a surface, in whose frame it is, and the number of the sample that is drawn for it.
struct PathView {
  UnitVector direction{};
  std::uint64_t number = 0;
};

/// A material as paths need it: values and samples, many at a time.
class SceneSurface {
 public:
  /// \throws ArgumentError for reflectances that scenes cannot show; as sample()
  SceneSurface(const Device& device, const SceneMaterial& material, const SceneOptions& options);
  SceneSurface(SceneSurface&&) noexcept;
  SceneSurface& operator=(SceneSurface&&) = delete;
  ~SceneSurface();

  /// f(L, V) in sr^-1 without delta parts, linear red, green and blue x pairs.
  [[nodiscard]] Eigen::Matrix3Xd values(std::span<const Directions> pairs) const;
  /// Draws a direction for each viewer.
  [[nodiscard]] std::vector<PathStep> draw(EachDrawer& drawer, std::span<const PathView> views,
                                           std::uint64_t seed) const;
  /// Smallest width of a formula's lobes, in radians of the half-vector, in (0, 1]; 1 without a formula.
  [[nodiscard]] double narrowest() const;

  struct Implementation;

 private:
  std::unique_ptr<const Implementation> implementation_;
};

/// Linear red, green and blue of each channel of a material.
/// \throws ArgumentError for channels that have none: other than one, three without wavelengths, or a spectrum
[[nodiscard]] Eigen::Matrix3Xd scene_colours(const SceneMaterial& material);

/// A pair of directions in the frame of a surface.
[[nodiscard]] Directions pair_of(const UnitVector& light, const UnitVector& view);

}  // namespace lobe
