// Where rays meet shapes: against longer ways in long double, and all triangles of a mesh one by one.
#include "render/scene_geometry.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <numbers>
#include <optional>
#include <ostream>
#include <random>
#include <string>
#include <vector>

#include "lobe/core/error.hpp"
#include "support/names.hpp"
#include "support/temporary_directory.hpp"

namespace lobe::test {
namespace {

using ::testing::HasSubstr;
using Real = long double;
using RealVector = Eigen::Matrix<Real, 3, 1>;

RealVector real(const SpaceVector& v) {
  return {v[0], v[1], v[2]};
}

/// A meeting point: distance and normal on any side.
struct Meeting {
  Real distance = std::numeric_limits<Real>::infinity();
  RealVector normal = RealVector::Zero();

  void take(Real at, const RealVector& across) {
    if (at > 1e-6L && at < distance) *this = {at, across.normalized()};
  }
};

/// A piece of a plane, by the coordinates along two edges.
void meet_parallelogram(Meeting& meeting, const RealVector& origin, const RealVector& direction,
                        const RealVector& corner, const RealVector& a, const RealVector& b, bool is_triangle) {
  // origin + t direction = corner + u a + v b.
  Eigen::Matrix<Real, 3, 3> system;
  system << a, b, -direction;
  if (std::abs(system.determinant()) < 1e-15L) return;
  const RealVector found = system.fullPivLu().solve(origin - corner);
  const bool is_inside =
      found[0] >= 0 && found[1] >= 0 && (is_triangle ? found[0] + found[1] <= 1 : found[0] <= 1 && found[1] <= 1);
  if (is_inside) meeting.take(found[2], a.cross(b));
}

Meeting reference_of(const SphereShape& s, const RealVector& origin, const RealVector& direction) {
  Meeting meeting;
  const RealVector from = origin - real(s.centre);
  const Real half = from.dot(direction);
  const Real root = half * half - (from.squaredNorm() - Real{s.radius} * s.radius);
  if (root < 0) return meeting;
  for (const Real sign : {-1.0L, 1.0L}) {
    const Real at = -half + sign * std::sqrt(root);
    meeting.take(at, from + at * direction);
  }
  return meeting;
}

Meeting reference_of(const BoxShape& s, const RealVector& origin, const RealVector& direction) {
  Meeting meeting;
  const RealVector x(std::cos(Real{s.turn}), std::sin(Real{s.turn}), 0);
  const RealVector y(-std::sin(Real{s.turn}), std::cos(Real{s.turn}), 0);
  const RealVector z(0, 0, 1);
  const std::array edges{RealVector(s.size[0] * x), RealVector(s.size[1] * y), RealVector(s.size[2] * z)};
  const RealVector corner = real(s.centre) - (edges[0] + edges[1] + edges[2]) / 2;
  for (std::size_t k = 0; k < 3; ++k) {
    const RealVector& a = edges.at((k + 1) % 3);
    const RealVector& b = edges.at((k + 2) % 3);
    meet_parallelogram(meeting, origin, direction, corner, a, b, false);
    meet_parallelogram(meeting, origin, direction, corner + edges.at(k), a, b, false);
  }
  return meeting;
}

Meeting reference_of(const CylinderShape& s, const RealVector& origin, const RealVector& direction) {
  Meeting meeting;
  const RealVector axis = real(s.axis).normalized();
  const Real height = real(s.axis).norm();
  const RealVector x = axis.unitOrthogonal();
  const RealVector y = axis.cross(x);
  const RealVector from = origin - real(s.base);
  const std::array p{from.dot(x), from.dot(y), from.dot(axis)};
  const std::array d{direction.dot(x), direction.dot(y), direction.dot(axis)};
  const Real a = d[0] * d[0] + d[1] * d[1];
  const Real b = 2 * (p[0] * d[0] + p[1] * d[1]);
  const Real c = p[0] * p[0] + p[1] * p[1] - Real{s.radius} * s.radius;
  if (const Real root = b * b - 4 * a * c; a > 0 && root >= 0) {
    for (const Real sign : {-1.0L, 1.0L}) {
      const Real at = (-b + sign * std::sqrt(root)) / (2 * a);
      const Real level = p[2] + at * d[2];
      if (level >= 0 && level <= height) meeting.take(at, (p[0] + at * d[0]) * x + (p[1] + at * d[1]) * y);
    }
  }
  for (const Real level : {0.0L, height}) {
    const Real at = (level - p[2]) / d[2];
    if (std::hypot(p[0] + at * d[0], p[1] + at * d[1]) <= s.radius) meeting.take(at, axis);
  }
  return meeting;
}

Meeting reference_of(const PlaneShape& s, const RealVector& origin, const RealVector& direction) {
  Meeting meeting;
  const RealVector normal = real(s.normal).normalized();
  if (!s.size) {
    meeting.take((real(s.centre) - origin).dot(normal) / direction.dot(normal), normal);
    return meeting;
  }
  const RealVector x = RealVector(0, 0, 1).cross(normal).normalized() * (*s.size)[0];
  const RealVector y = normal.cross(x).normalized() * (*s.size)[1];
  meet_parallelogram(meeting, origin, direction, real(s.centre) - (x + y) / 2, x, y, false);
  return meeting;
}

Meeting reference_of(const MeshShape& s, const RealVector& origin, const RealVector& direction) {
  Meeting meeting;
  for (const auto& [a, b, c] : s.triangles) {
    const RealVector corner = real(s.vertices[a]);
    meet_parallelogram(meeting, origin, direction, corner, real(s.vertices[b]) - corner, real(s.vertices[c]) - corner,
                       true);
  }
  return meeting;
}

SpaceVector somewhere(std::mt19937& random, double size) {
  std::uniform_real_distribution<double> anywhere(-size, size);
  const double x = anywhere(random);
  const double y = anywhere(random);
  return {x, y, anywhere(random)};
}

/// Two hundred triangles that lie about.
MeshShape heap() {
  std::mt19937 random(5);
  MeshShape mesh;
  for (std::uint32_t t = 0; t < 200; ++t) {
    const SpaceVector at = somewhere(random, 1.5);
    for (int k = 0; k < 3; ++k) {
      const SpaceVector off = somewhere(random, 0.3);
      mesh.vertices.push_back({at[0] + off[0], at[1] + off[1], at[2] + off[2]});
    }
    mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  return mesh;
}

struct ShapeCase {
  std::string name;
  SceneShape shape;
};
std::ostream& operator<<(std::ostream& out, const ShapeCase& one) {
  return out << one.name;
}

class Shape : public ::testing::TestWithParam<ShapeCase> {};

TEST_P(Shape, IsMetWhereTheReferenceMeetsIt) {
  const SceneGeometry geometry({&GetParam().shape, 1});
  std::mt19937 random(7);
  int met = 0;
  for (int k = 0; k < 4000; ++k) {
    SCOPED_TRACE(k);
    // From outside and, every fourth, from within what is closed.
    const SpaceVector from = somewhere(random, k % 4 == 0 ? 0.4 : 4);
    const SpaceVector to = somewhere(random, 1.2);
    const Eigen::Vector3d origin(from[0], from[1], from[2]);
    const Eigen::Vector3d direction = (Eigen::Vector3d(to[0], to[1], to[2]) - origin).normalized();
    const Meeting expected =
        std::visit([&](const auto& form) { return reference_of(form, origin.cast<Real>(), direction.cast<Real>()); },
                   GetParam().shape.geometry);

    const auto hit = geometry.nearest({origin, direction});

    ASSERT_EQ(hit.has_value(), std::isfinite(expected.distance));
    if (!hit) continue;
    ++met;
    // A ray that grazes meets a round surface at the root of a rounding error.
    EXPECT_NEAR(hit->distance, static_cast<double>(expected.distance), 1e-7);
    EXPECT_NEAR(std::abs(hit->normal.dot(expected.normal.cast<double>())), 1, 1e-6);
    EXPECT_TRUE(geometry.is_blocked({origin, direction}, hit->distance + 1e-3));
    EXPECT_FALSE(geometry.is_blocked({origin, direction}, hit->distance - 1e-6));
  }
  EXPECT_GT(met, 400);
}

TEST_P(Shape, IsNotMetAgainFromItsOwnSurface) {
  const SceneGeometry geometry({&GetParam().shape, 1});
  std::mt19937 random(9);
  for (int k = 0; k < 500; ++k) {
    const SpaceVector from = somewhere(random, 6);
    const Eigen::Vector3d origin(from[0], from[1], from[2]);
    const auto hit = geometry.nearest({origin, -origin.normalized()});
    if (!hit) continue;
    const double reach = std::max(origin.cwiseAbs().maxCoeff(), hit->distance);
    const Ray back{origin + hit->distance * -origin.normalized(), origin.normalized(), reach};
    EXPECT_FALSE(geometry.is_blocked(back, hit->distance)) << k;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Of, Shape,
    ::testing::Values(ShapeCase{"sphere", {SphereShape{{0.2, -0.1, 0.3}, 0.9}}},
                      ShapeCase{"far_sphere", {SphereShape{{0, 0, -99}, 99}}},
                      ShapeCase{"box", {BoxShape{{0.1, 0.2, -0.1}, {1, 1.5, 2}, 0.6}}},
                      ShapeCase{"cylinder", {CylinderShape{{-0.3, 0.1, -0.8}, {0.3, 0.4, 1.6}, 0.7}}},
                      ShapeCase{"plane", {PlaneShape{{0, 0.1, -0.5}, {0.2, -0.3, 2}}}},
                      ShapeCase{"rectangle", {PlaneShape{{0, 0.1, 0.2}, {1, -0.3, 0.5}, std::array{2.0, 1.5}}}},
                      ShapeCase{"mesh", {heap()}}),
    ByName());

TEST(SceneGeometry, MeetsTheNearestOfSeveralShapes) {
  const std::vector<SceneShape> shapes{{SphereShape{{0, 0, 0}, 1}}, {PlaneShape{{0, 0, 0.5}}}};
  const SceneGeometry geometry(shapes);

  const auto from_above = geometry.nearest({{0, 0, 3}, {0, 0, -1}});
  const auto beside = geometry.nearest({{2, 0, 3}, {0, 0, -1}});

  EXPECT_EQ(from_above.value().shape, 0U);
  EXPECT_DOUBLE_EQ(from_above->distance, 2);
  EXPECT_EQ(beside.value().shape, 1U);
  EXPECT_DOUBLE_EQ(beside->distance, 2.5);
  EXPECT_FALSE(geometry.nearest({{0, 0, 3}, {0, 0, 1}}));
}

TEST(SurfaceFrame, HasItsXAxisHorizontalAndItsYAxisUphill) {
  const Eigen::Vector3d normal = Eigen::Vector3d(0.3, -0.5, 0.4).normalized();
  const SurfaceFrame frame = frame_of(normal);
  EXPECT_NEAR(frame.x[2], 0, 1e-15);
  EXPECT_GT(frame.y[2], 0);
  EXPECT_NEAR((frame.x.cross(frame.y) - normal).norm(), 0, 1e-15);
  EXPECT_EQ(frame_of({0, 0, 1}).x, Eigen::Vector3d(1, 0, 0));
  EXPECT_EQ(frame_of({0, 0, -1}).y, Eigen::Vector3d(0, -1, 0));
}

/// Reads a mesh from a text.
MeshShape read_obj(const std::string& text) {
  const TemporaryDirectory directory;
  std::ofstream(directory.path() / "a.obj") << text;
  return load_mesh(directory.path() / "a.obj");
}

TEST(Mesh, IsReadWithPolygonsNormalsAndIndicesFromTheEnd) {
  const MeshShape mesh = read_obj(
      "# a square and a triangle\r\no thing\nv 0 0 0\nv 1 0 0\nv 1 1 0 0.5\nv 0 1 0 # corner\n"
      "vn 0 0 2\nvt 0 0\nusemtl red\ns off\nf 1/1/1 2/1/1 3/1/1 4/1/1\nf -4//-1 -3//-1 -2//1\n");

  EXPECT_EQ(mesh.vertices.size(), 4U);
  ASSERT_EQ(mesh.triangles.size(), 3U);
  EXPECT_EQ(mesh.triangles[1], (std::array<std::uint32_t, 3>{0, 2, 3}));
  EXPECT_EQ(mesh.triangles[2], (std::array<std::uint32_t, 3>{0, 1, 2}));
  EXPECT_EQ(mesh.triangle_normals.size(), 3U);
  EXPECT_EQ(mesh.normals.at(0), (SpaceVector{0, 0, 2}));
}

TEST(Mesh, PassesOverPointsAndLinesAndJoinsLinesThatGoOn) {
  const MeshShape mesh = read_obj(
      "mg 1 0.5\nv 0 0 \\\n0\nv 1 0 0\r\nv 1 \\\r\n1 \\\n 0\np 1 2\nl 1 2 3\nlod 2\nf 1 \\\n  2 3 # no more \\\nf 3 2 "
      "1\n");

  ASSERT_EQ(mesh.vertices.size(), 3U);
  EXPECT_EQ(mesh.vertices[2], (SpaceVector{1, 1, 0}));
  ASSERT_EQ(mesh.triangles.size(), 2U);
  EXPECT_EQ(mesh.triangles[0], (std::array<std::uint32_t, 3>{0, 1, 2}));
}

TEST(Mesh, ShadesWithInterpolatedNormals) {
  MeshShape mesh{.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                 .normals = {{0, 0, 1}, {1, 0, 1}, {0, 0, -1}},
                 .triangles = {{0, 1, 2}},
                 .triangle_normals = {{0, 1, 0}}};
  const SceneShape shape{mesh};
  const auto hit = SceneGeometry({&shape, 1}).nearest({{0.5, 0.25, 1}, {0, 0, -1}});

  const Eigen::Vector3d expected =
      (0.5 * Eigen::Vector3d(0, 0, 1) + 0.5 * Eigen::Vector3d(1, 0, 1).normalized()).normalized();
  EXPECT_NEAR((hit.value().shading - expected).norm(), 0, 1e-15);
  EXPECT_NEAR((hit->normal - Eigen::Vector3d(0, 0, 1)).norm(), 0, 1e-15);
}

/// A text of a mesh that cannot be read, and what is said of it.
struct MeshMistake {
  std::string name, text, complaint;
};
std::ostream& operator<<(std::ostream& out, const MeshMistake& mistake) {
  return out << mistake.name;
}

class MeshMistakes : public ::testing::TestWithParam<MeshMistake> {};

TEST_P(MeshMistakes, AreRefusedWithTheirLine) {
  try {
    (void)read_obj(GetParam().text);
    FAIL() << "was read";
  } catch (const IoError& error) {
    EXPECT_THAT(error.what(), HasSubstr(GetParam().complaint));
    EXPECT_THAT(error.what(), HasSubstr("; expected "));
    EXPECT_THAT(error.what(), ::testing::Not(HasSubstr("\n")));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Of, MeshMistakes,
    ::testing::Values(
        MeshMistake{"nothing", "", "a.obj has no faces"}, MeshMistake{"points_only", "v 0 0 0\n", "a.obj has no faces"},
        MeshMistake{"short_vertex", "v 0 0\n", "a.obj:1: a vertex of fewer than three numbers"},
        MeshMistake{"no_number", "v 0 0 0\nv 0 x 0\n", "a.obj:2: 'x' is no number"},
        MeshMistake{"not_finite", "v 0 inf 0\n", "a.obj:1: 'inf' is no number"},
        MeshMistake{"no_direction", "vn 0 0 0\n", "a.obj:1: a normal without direction"},
        MeshMistake{"curve", "curv 0 1 1 2\n", "'curv' is no element"},
        MeshMistake{"control", "\x1b[2J 1\n", "'\\x1b[2J' is no element"},
        MeshMistake{"two_corners", "v 0 0 0\nv 1 0 0\nf 1 2\n", "a.obj:3: a face of 2 corners"},
        MeshMistake{"index_0", "v 0 0 0\nf 0 1 1\n", "there is no vertex 0"},
        MeshMistake{"later_vertex", "v 0 0 0\nf 1 1 2\nv 1 1 1\n", "there is no vertex 2"},
        MeshMistake{"too_far_back", "v 0 0 0\nf 1 1 -2\n", "there is no vertex -2"},
        MeshMistake{"huge_index", "v 0 0 0\nf 1 1 99999999999999999999\n", "is no index of a vertex"},
        MeshMistake{"no_normals", "v 0 0 0\nf 1//1 1//1 1//1\n", "there is no normal 1"},
        MeshMistake{"many_slashes", "v 0 0 0\nf 1/1/1/1 1 1\n", "is no corner of a face"},
        MeshMistake{"some_normals", "v 0 0 0\nvn 0 0 1\nf 1//1 1 1\n", "normals at some of its corners"},
        MeshMistake{"line_that_goes_on", "v 0 0 0\nf 1 \\\n1 \\", "the file ends in a line that is to go on"},
        MeshMistake{"place_of_lines_that_go_on", "v 0 \\\n0 \\\n0\nf 1 \\\n1\n", "a.obj:4: a face of 2 corners"},
        MeshMistake{"surface", "v 0 0 0\nsurf 0 1 0 1\n", "'surf' is no element of a mesh"},
        MeshMistake{"other_faces", "v 0 0 0\nvn 0 0 1\nf 1 1 1\nf 1//1 1//1 1//1\n", "faces with and without normals"}),
    ByName());

TEST(Mesh, ThatIsMissingIsAnIoError) {
  EXPECT_THROW((void)load_mesh("nowhere.obj"), IoError);
}

}  // namespace
}  // namespace lobe::test
