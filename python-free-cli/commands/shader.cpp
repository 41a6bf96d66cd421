#include "lobe/render/shader.hpp"

#include <fmt/format.h>

#include <string>
#include <utility>

#include "interface/colours.hpp"
#include "interface/command.hpp"
#include "interface/options.hpp"
#include "interface/output_file.hpp"
#include "interface/report.hpp"
#include "interface/session.hpp"
#include "lobe/core/error.hpp"
#include "lobe/core/files.hpp"

namespace lobe::cli {
namespace {

constexpr Text kFunction{"function"};

ExitCode execute_shader(Session& session) {
  const auto& arguments = session.arguments();
  const Operand operand = session.operand(argument::material);
  const Material* material = operand.shape().formula();
  if (material == nullptr) {
    throw ArgumentError("'" + operand.label() +
                        "' has no formula; expected a material of catalogue models ('lobe fit' " +
                        "finds one that is near a file)");
  }
  ShaderOptions options;
  options.weights = colours_of(operand.shape()).weights;
  if (options.weights.rows() == 1 && options.weights.cols() > 1) {
    throw ArgumentError(
        fmt::format("'{}' has {} channels without a colour; expected 1, a grey, or 3, red, green and blue",
                    operand.label(), options.weights.cols()));
  }
  if (arguments.has(kFunction)) options.function = arguments.text(kFunction);
  Shader shader = glsl_shader(*material, options);
  if (session.wants_json()) {
    Json answer = json_answer("shader");
    answer["material"] = material_json(*material);
    answer["language"] = "GLSL ES 3.00";
    answer["function"] = options.function;
    answer["text"] = std::move(shader.text);
    session.print_json(answer);
  } else {
    session.print(shader.text);
  }
  return ExitCode::success;
}

}  // namespace

Command shader_command() {
  return {
      .name = "shader",
      .group = "Materials",
      .summary = "print a material as a function for shaders",
      .description =
          "Prints the formulas of a material as a function of the OpenGL shading language, vec3 lobe_brdf(vec3 L, "
          "vec3 V): f in sr^-1 without the cosine, for unit vectors in coordinates of the surface with z along its "
          "normal. The text is GLSL ES 3.00 without a #version line, which desktop GLSL from 3.30 on reads as well. "
          "It is translated from the kernels that lobe itself runs, with their sources in comments, and computes in "
          "single precision: values are right to about 1e-5 except for very narrow lobes, where the rounding of "
          "directions counts.\n"
          "Several channels become red, green and blue. Delta parts and '@pump' are refused.",
      .positionals = {{.handle = argument::material,
                       .help = "the material, of models, factors and formulas",
                       .is_material = true}},
      .options = {{.handle = kFunction, .value = "NAME", .help = "name of the function (default lobe_brdf)"},
                  json_option()},
      .examples = {{"a paint for a fragment shader", "lobe shader lambert:scale=0.3/0.1/0.1+ggx:alpha=0.2,f0=0.04"},
                   {"an anisotropic metal under a name of its own",
                    "lobe shader ward_anisotropic:m_x=0.1,m_y=0.3 --function brushed"}},
      .execute = execute_shader};
}

}  // namespace lobe::cli
