#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "lobe/model/material.hpp"

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

}  // namespace lobe
