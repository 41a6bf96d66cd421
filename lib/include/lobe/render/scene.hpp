#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "lobe/core/directions.hpp"
#include "lobe/table/reflectance.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// A point or a vector in the space of a scene, x, y, z; z is up.
using SpaceVector = std::array<double, 3>;
/// Linear red, green and blue.
using LinearColour = std::array<double, 3>;

/// A pinhole camera.
struct SceneCamera {
  SpaceVector position{0, -5, 0};             ///< where it stands
  SpaceVector target{0, 0, 0};                ///< the point in the middle of the picture
  SpaceVector up{0, 0, 1};                    ///< the upright direction of the picture, any length
  double field_of_view = 40 * kDegree;        ///< angle from the lower to the upper edge, radians
  std::array<std::size_t, 2> size{160, 120};  ///< pixels, width and height
};

/// Makes the picture of a camera wider or narrower, and its height in proportion.
/// \param width pixels, at least 1
[[nodiscard]] SceneCamera with_width(SceneCamera camera, std::size_t width);

/// A sphere.
struct SphereShape {
  SpaceVector centre{0, 0, 0};  ///< its centre
  double radius = 1;            ///< its radius
};
/// A box, upright.
struct BoxShape {
  SpaceVector centre{0, 0, 0};  ///< its centre
  SpaceVector size{1, 1, 1};    ///< lengths of its edges
  double turn = 0;              ///< angle about the vertical axis, radians
};
/// A cylinder with both caps.
struct CylinderShape {
  SpaceVector base{0, 0, 0};  ///< centre of one cap
  SpaceVector axis{0, 0, 1};  ///< from there to the centre of the other
  double radius = 1;          ///< its radius
};
/// A plane, or a rectangle of it.
struct PlaneShape {
  SpaceVector centre{0, 0, 0};                               ///< a point of the plane, the centre of the rectangle
  SpaceVector normal{0, 0, 1};                               ///< across it, any length
  std::optional<std::array<double, 2>> size = std::nullopt;  ///< along the surface's x and y; none: without end
};
/// Triangles.
struct MeshShape {
  std::vector<SpaceVector> vertices;                    ///< corners of the triangles
  std::vector<SpaceVector> normals;                     ///< normals that shading interpolates; may be empty
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< three indices of vertices each
  /// Three indices of normals for each triangle; empty: flat triangles.
  std::vector<std::array<std::uint32_t, 3>> triangle_normals;
};

/// Reads triangles and polygons from a Wavefront OBJ file: its vertices, normals and faces. Polygons are cut into fans;
/// groups, materials and texture coordinates are passed over.
/// \throws IoError "FILE:LINE: ..." for lines, indices and elements that are none of these, and without faces
[[nodiscard]] MeshShape load_mesh(const std::filesystem::path& path);

/// A surface of a scene, which reflects on both sides. Anisotropic reflectances have their x axis horizontally, along
/// (0, 0, 1) x normal, and their y axis uphill; on horizontal surfaces x is that of the scene.
struct SceneShape {
  std::variant<SphereShape, BoxShape, CylinderShape, PlaneShape, MeshShape> geometry;  ///< its form
  std::size_t material = 0;                                                            ///< index of its material
};

/// A material of a scene, of one channel, a grey, or of three, linear red, green and blue.
struct SceneMaterial {
  std::string name;         ///< name in the scene
  Reflectance reflectance;  ///< how it reflects light
};

/// A point light within a scene.
struct SceneLight {
  SpaceVector position{0, 0, 0};    ///< where it is
  LinearColour intensity{0, 0, 0};  ///< radiance times area: irradiance at a distance r is intensity / r^2
};

/// Skies.
enum class SkyKind {
  uniform,  ///< the same radiance from all directions, also from below (daylight of Neumann 2001, eq. 3.32)
  overcast  ///< CIE overcast sky, zenith (1 + 2 sin(elevation)) / 3 above the horizon, nothing below
};

/// Light from all around.
struct SceneSky {
  SkyKind kind = SkyKind::uniform;  ///< how radiance depends on the direction
  LinearColour radiance{0, 0, 0};   ///< radiance, that of the zenith of an overcast sky
};

/// A scene of shapes, lights and a camera.
struct Scene {
  std::string title;                     ///< for people
  SceneCamera camera;                    ///< who sees it
  std::vector<SceneMaterial> materials;  ///< materials of the shapes
  std::vector<SceneShape> shapes;        ///< in any order
  std::vector<SceneLight> lights;        ///< point lights
  SceneSky sky;                          ///< light from behind all shapes
  std::size_t bounces = 4;               ///< reflections of light before the last one; 0: direct light alone
};

/// Largest number of bounces.
inline constexpr std::size_t kMostBounces = 62;

}  // namespace lobe
