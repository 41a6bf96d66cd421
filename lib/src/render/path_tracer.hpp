#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "device/draw_each.hpp"
#include "lobe/device/device.hpp"
#include "lobe/render/render_scene.hpp"
#include "lobe/render/scene.hpp"
#include "render/scene_geometry.hpp"
#include "render/scene_surface.hpp"

namespace lobe {

/// The rays of a camera.
class CameraRays {
 public:
  explicit CameraRays(const SceneCamera& camera);

  [[nodiscard]] std::size_t pixels() const { return size_[0] * size_[1]; }
  /// The ray through a point of a pixel, from its upper left corner; x and y in [0, 1].
  [[nodiscard]] Ray through(std::size_t pixel, double x, double y) const;

 private:
  std::array<std::size_t, 2> size_;
  Eigen::Vector3d origin_;
  Eigen::Vector3d forward_;
  Eigen::Vector3d right_;
  Eigen::Vector3d up_;
};

/// Follows paths, all at once.
class PathTracer {
 public:
  /// \param scene has to live as long as this
  /// \param options likewise
  /// \param varied the material that is drawn as the options say, others by importance; none: all as they say
  PathTracer(const Device& device, const Scene& scene, const SceneOptions& options,
             std::optional<std::size_t> varied = std::nullopt);

  /// Relative rounding of radiances, which all samples may share.
  [[nodiscard]] double rounding() const { return rounding_; }
  /// How many samples of every pixel are best asked for together.
  [[nodiscard]] std::size_t samples_at_once() const;
  /// Radiances of samples first, first + 1, ... of every pixel, one sample after the other.
  [[nodiscard]] Eigen::Matrix3Xd radiances(std::uint64_t first, std::size_t samples);

 private:
  struct Path;
  struct Vertex;

  [[nodiscard]] static Vertex vertex_of(std::size_t index, const Path& path);
  /// Sends rays on. Paths that meet nothing see the sky and end.
  /// \return whether a path is left
  bool meet(std::vector<Path>& paths) const;
  void reflect(std::vector<Path>& paths, std::size_t depth);
  /// Light of the point lights that vertices see.
  void add_lights(std::vector<Path>& paths, std::span<const Vertex> vertices, const SceneSurface& surface) const;
  /// Draws where paths go on.
  void go_on(std::vector<Path>& paths, std::span<const Vertex> vertices, const SceneSurface& surface,
             std::size_t depth);

  const Scene& scene_;
  const SceneOptions& options_;
  double rounding_ = 0;
  CameraRays rays_;
  SceneGeometry geometry_;
  std::vector<std::optional<SceneSurface>> surfaces_;
  EachDrawer drawer_;
};

/// Calls work(i) for each i below a count, on all cores, a few hundred at a time.
void for_many(std::size_t count, const std::function<void(std::size_t)>& work);

}  // namespace lobe
