#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "lobe/core/progress.hpp"
#include "lobe/device/device.hpp"
#include "lobe/model/material.hpp"
#include "lobe/table/reflectance.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// Options for the source of a shader.
struct ShaderOptions {
  std::string function = "lobe_brdf";  ///< name of the function: a letter or '_', then letters, digits and '_'
  /// Colours of the channels: 3 rows for linear red, green and blue, or 1 for a grey; one column per channel. Empty: a
  /// single channel is grey, three are red, green and blue.
  Eigen::MatrixXd weights = {};
  /// Whether constants come from outside instead of standing in the text: `uniform vec4 lobe_constants[4 * lobes]` and
  /// `uniform vec3 lobe_weights[lobes]`, so that materials of the same models share a text.
  bool has_uniforms = false;
  ProgressCallback progress = {};  ///< told of the progress of textured_shader() alone; may cancel
};

/// A material as a function of the OpenGL shading language, GLSL ES 3.00, which later versions of GLSL read as well.
struct Shader {
  std::string text;  ///< `vec3 FUNCTION(vec3 L, vec3 V)` and what it needs, without a version line
  std::vector<std::array<float, 16>> constants;  ///< for uniforms: four vec4 per lobe
  std::vector<std::array<float, 3>> weights;     ///< for uniforms: red, green and blue of each lobe
};

/// Translates the kernels of a material's formulas to GLSL, those of users as well. The function takes unit vectors L
/// and V in coordinates of the surface, z along its normal and x and y along its tangents, and returns f(L, V) in
/// sr^-1, without the cosine; 0 for directions at or below the horizon. It computes in single precision (highp):
/// directions themselves are rounded, which counts where lobes are narrow.
/// \throws ArgumentError for adjustments that adjusted() has not done, a function name that is none, channels for which
///   there are no colours, and weights that do not fit; NumericError for what has no such text: delta parts,
///   pumping-up, and constants beyond single precision
[[nodiscard]] Shader glsl_shader(const Material& material, const ShaderOptions& options = {});

/// A reflectance as a function of the OpenGL shading language that looks values up in a texture.
struct TexturedShader {
  std::string text;  ///< `uniform highp sampler3D lobe_values` and `vec3 FUNCTION(vec3 L, vec3 V)`, without a version
                     ///< line; the same for all isotropic reflectances, and for all others
  std::array<std::size_t, 3> size{};  ///< width, height and depth of the texture
  std::vector<std::uint16_t> texels;  ///< numbers of 16 bits (IEEE 754 binary16), red, green, blue and 0 of each texel
};

/// Values of any reflectance for a shader, on nodes of half-vector and difference (Rusinkiewicz 1998): theta_h, evenly
/// in its square root, along the width, theta_d, evenly, along the height, both from 0 to 90 degrees, and phi_d, over a
/// turn with both ends, along the depth. Of anisotropic reflectances the layers of theta_d follow each other for each
/// phi_h. Texels are cube roots of f, linear red, green and blue, to be filtered linearly and clamped to their edge.
/// The function takes and returns what that of glsl_shader() does; between nodes it is an interpolation, for pictures
/// and not for numbers. Directions below half a degree above the horizon are raised to it; what is no number is 0, and
/// roots end at 65504.
/// \param options `has_uniforms` does not count
/// \throws ArgumentError for a function name that is none, channels for which there are no colours, and weights that do
///   not fit; NumericError for delta parts; Cancelled by `options.progress`; as adjusted(); as evaluate()
[[nodiscard]] TexturedShader textured_shader(const Device& device, const Reflectance& reflectance,
                                             const ShaderOptions& options = {});

}  // namespace lobe
