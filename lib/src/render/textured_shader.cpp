#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <span>
#include <string_view>
#include <vector>

#include "hemisphere/unit_vector.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"
#include "lobe/reflectance/adjusted.hpp"
#include "lobe/reflectance/evaluate.hpp"
#include "lobe/render/shader.hpp"
#include "render/shader_text.hpp"

namespace lobe {
namespace {

using Eigen::Index;
using Eigen::Vector3d;

constexpr double kRight = std::numbers::pi / 2;
constexpr double kTurn = 2 * std::numbers::pi;

/// Numbers of nodes; both ends of a turn are nodes.
struct TextureNodes {
  std::size_t half = 0;         ///< of theta_h, equally far in its square root
  std::size_t difference = 0;   ///< of theta_d
  std::size_t around = 0;       ///< of phi_d
  std::size_t half_around = 1;  ///< of phi_h
};

constexpr TextureNodes kIsotropic{.half = 64, .difference = 32, .around = 33};
constexpr TextureNodes kAnisotropic{.half = 40, .difference = 20, .around = 17, .half_around = 33};

double share(std::size_t node, std::size_t nodes) {
  return static_cast<double>(node) / static_cast<double>(nodes - 1);
}

/// A unit vector, raised to half a degree above the horizon where it is lower.
Direction raised(const Vector3d& vector) {
  constexpr double kHighest = 89.5 * kDegree;
  return {std::min(std::atan2(std::hypot(vector.x(), vector.y()), vector.z()), kHighest),
          std::atan2(vector.y(), vector.x())};
}

/// The pair of a half-vector and a difference vector.
Directions pair_of(double theta_h, double phi_h, double theta_d, double phi_d) {
  const auto [in, out] = half_difference_vectors(theta_h, theta_d, phi_d);
  const Direction from = raised(in);
  const Direction to = raised(out);
  return {.theta_in = from.theta, .theta_out = to.theta, .delta_phi = to.phi - from.phi, .phi_in = phi_h + from.phi};
}

/// In the order of texels.
std::vector<Directions> texel_pairs(const TextureNodes& nodes) {
  std::vector<Directions> pairs;
  pairs.reserve(nodes.half * nodes.difference * nodes.around * nodes.half_around);
  for (std::size_t around = 0; around < nodes.around; ++around) {
    for (std::size_t half_around = 0; half_around < nodes.half_around; ++half_around) {
      const double phi_h = nodes.half_around == 1 ? 0 : kTurn * share(half_around, nodes.half_around);
      for (std::size_t difference = 0; difference < nodes.difference; ++difference) {
        for (std::size_t half = 0; half < nodes.half; ++half) {
          const double root = share(half, nodes.half);
          const double theta_h = kRight * root * root;
          const double phi_d = kTurn * share(around, nodes.around);
          const double theta_d = kRight * share(difference, nodes.difference);
          pairs.push_back(pair_of(theta_h, phi_h, theta_d, phi_d));
        }
      }
    }
  }
  return pairs;
}

std::uint16_t texel_number(double value) {
  constexpr double kMostOfHalf = 65504;
  if (std::isnan(value)) return 0;
  return Eigen::numext::bit_cast<std::uint16_t>(
      static_cast<Eigen::half>(static_cast<float>(std::clamp(std::cbrt(value), -kMostOfHalf, kMostOfHalf))));
}

constexpr std::string_view kText = R"(
vec3 {function}(vec3 L, vec3 V) {{
  if (L.z <= 0.0 || V.z <= 0.0) return vec3(0.0, 0.0, 0.0);
  float half_x = L.x + V.x;
  float half_y = L.y + V.y;
  float half_z = L.z + V.z;
  float level = sqrt(half_x * half_x + half_y * half_y);
  float size = sqrt(level * level + half_z * half_z);
  float sine = level / size;  // of theta_h
  float cosine = half_z / size;
  float along_x = sine > 1e-6 ? half_x / level : 1.0;
  float along_y = sine > 1e-6 ? half_y / level : 0.0;
  float in_along = L.x * along_x + L.y * along_y;
  float away = cosine * in_along - L.z * sine;  // L in the frame of the half-vector
  float across = L.y * along_x - L.x * along_y;
  float up = sine * in_along + cosine * L.z;
  float aside = sqrt(away * away + across * across);
  float turn = aside > 1e-6 ? atan(across, away) / 6.28318531 : 0.0;
  float u = ({half}.0 * sqrt(atan(sine, cosine) / 1.57079633) + 0.5) / {width}.0;
  float v = {difference}.0 * min(atan(aside, up) / 1.57079633, 1.0) + 0.5;
  float w = ({around}.0 * (turn - floor(turn)) + 0.5) / {depth}.0;
)";
constexpr std::string_view kIsotropicText = R"(
  vec4 root = texture(lobe_values, vec3(u, v / {height}.0, w));
  return vec3(root.x * root.x * root.x, root.y * root.y * root.y, root.z * root.z * root.z);
}}
)";
constexpr std::string_view kAnisotropicText = R"(
  float half_turn = atan(along_y, along_x) / 6.28318531;
  float place = {half_around}.0 * (half_turn - floor(half_turn));
  float layer = min(floor(place), {half_around}.0 - 1.0);
  float between = place - layer;
  v += {layer}.0 * layer;
  vec4 first = texture(lobe_values, vec3(u, v / {height}.0, w));
  vec4 second = texture(lobe_values, vec3(u, (v + {layer}.0) / {height}.0, w));
  float red = mix(first.x, second.x, between);
  float green = mix(first.y, second.y, between);
  float blue = mix(first.z, second.z, between);
  return vec3(red * red * red, green * green * green, blue * blue * blue);
}}
)";

}  // namespace

TexturedShader textured_shader(const Device& device, const Reflectance& reflectance, const ShaderOptions& options) {
  require_function_name(options.function);
  const Reflectance made = adjusted(device, reflectance);
  if (made.has_delta()) {
    throw NumericError(fmt::format(
        "'{}' has delta parts, which no shader's function has; expected a material without them", reflectance.name()));
  }
  const Eigen::MatrixXd colours = shader_colours(reflectance.name(), reflectance.channels(), options);
  const TextureNodes nodes = reflectance.is_isotropic() ? kIsotropic : kAnisotropic;

  TexturedShader shader;
  shader.size = {nodes.half, nodes.difference * nodes.half_around, nodes.around};
  shader.text = "uniform highp sampler3D lobe_values;  // cube roots of f over theta_h, theta_d and phi_d\n";
  require_free_name(options.function, shader.text);
  shader.text += fmt::format(kText, fmt::arg("function", options.function), fmt::arg("half", nodes.half - 1),
                             fmt::arg("difference", nodes.difference - 1), fmt::arg("around", nodes.around - 1),
                             fmt::arg("width", shader.size[0]), fmt::arg("depth", shader.size[2]));
  shader.text += nodes.half_around == 1
                     ? fmt::format(kIsotropicText, fmt::arg("height", shader.size[1]))
                     : fmt::format(kAnisotropicText, fmt::arg("half_around", nodes.half_around - 1),
                                   fmt::arg("layer", nodes.difference), fmt::arg("height", shader.size[1]));
  const std::vector<Directions> pairs = texel_pairs(nodes);
  shader.texels.reserve(4 * pairs.size());
  constexpr std::size_t kTogether = 1 << 14;
  for (std::size_t first = 0; first < pairs.size(); first += kTogether) {
    const double done = static_cast<double>(first) / static_cast<double>(pairs.size());
    if (options.progress && !options.progress("texture", done)) throw Cancelled("cancelled");
    const auto some = std::span(pairs).subspan(first, std::min(kTogether, pairs.size() - first));
    const Eigen::MatrixXd values = evaluate(device, made, some).value * colours.transpose();
    for (Index pair = 0; pair < values.rows(); ++pair) {
      for (Index row = 0; row < 3; ++row) shader.texels.push_back(texel_number(values(pair, row)));
      shader.texels.push_back(0);
    }
  }
  return shader;
}

}  // namespace lobe
