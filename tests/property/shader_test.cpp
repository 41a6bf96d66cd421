// Shaders against the library: their text is compiled by the reference compiler of GLSL, and, as the part of GLSL that
// it uses is also one of C++, by the compiler of these tests, in single precision.
#include "lobe/render/shader.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include "io/command.hpp"
#include "lobe/core/error.hpp"
#include "lobe/formats/measured.hpp"
#include "lobe/reflectance/adjusted.hpp"
#include "lobe/reflectance/evaluate.hpp"
#include "lobe/reflectance/tabulate.hpp"
#include "model/catalogue.hpp"
#include "support/device.hpp"
#include "support/random_materials.hpp"
#include "support/temporary_directory.hpp"

namespace lobe::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kShim = R"(
#include <cmath>
struct vec3 {
  float x, y, z;
  vec3(float a, float b, float c) : x(a), y(b), z(c) {}
  vec3& operator+=(const vec3& v) { x += v.x; y += v.y; z += v.z; return *this; }
};
inline vec3 operator*(const vec3& v, float s) { return vec3(v.x * s, v.y * s, v.z * s); }
inline float min(float a, float b) { return b < a ? b : a; }
inline float max(float a, float b) { return a < b ? b : a; }
#define FUNCTION(name) inline float name(float x) { return std::name(x); }
FUNCTION(exp) FUNCTION(exp2) FUNCTION(log) FUNCTION(floor) FUNCTION(trunc) FUNCTION(sqrt) FUNCTION(sin) FUNCTION(cos) FUNCTION(tan) FUNCTION(asin) FUNCTION(acos)
inline float pow(float x, float y) { return std::pow(x, y); }
inline float sign(float x) { return x > 0 ? 1 : x < 0 ? -1 : 0; }
inline float step(float e, float x) { return x < e ? 0 : 1; }
inline float mix(float a, float b, float t) { return a * (1 - t) + b * t; }
inline float inversesqrt(float x) { return 1 / std::sqrt(x); }
inline float clamp(float x, float a, float b) { return min(max(x, a), b); }
inline float abs(float x) { return std::fabs(x); }
inline float atan(float x) { return std::atan(x); }
inline float atan(float y, float x) { return std::atan2(y, x); }
struct vec4 { float x, y, z, w; };
#define uniform static
#define highp
struct sampler3D {};
// Filtered linearly and clamped to the edge, as the texture is to be.
const unsigned short* texels;
int size[3];
inline float half_number(unsigned bits) {
  const int exponent = (bits >> 10) & 31, fraction = bits & 1023;
  const float value = exponent == 0 ? std::ldexp(float(fraction), -24) : std::ldexp(float(1024 + fraction), exponent - 25);
  return bits & 0x8000 ? -value : value;
}
inline vec4 texture(sampler3D, vec3 at) {
  const float place[3] = {at.x * size[0] - 0.5f, at.y * size[1] - 0.5f, at.z * size[2] - 0.5f};
  float sum[4] = {0, 0, 0, 0};
  for (int corner = 0; corner < 8; ++corner) {
    float weight = 1;
    long texel = 0;
    for (int axis = 2; axis >= 0; --axis) {
      const int low = int(std::floor(place[axis])), above = corner >> axis & 1;
      weight *= above ? place[axis] - low : 1 - (place[axis] - low);
      const int node = low + above;
      texel = texel * size[axis] + (node < 0 ? 0 : node >= size[axis] ? size[axis] - 1 : node);
    }
    for (int c = 0; c < 4; ++c) sum[c] += weight * half_number(texels[4 * texel + c]);
  }
  return vec4{sum[0], sum[1], sum[2], sum[3]};
}
)";

/// Functions of shaders, compiled.
class CompiledShaders {
 public:
  explicit CompiledShaders(const std::vector<Material>& materials) : CompiledShaders(texts_of(materials)) {}
  explicit CompiledShaders(const std::vector<std::string>& texts) {
    std::ofstream source(directory_.path() / "shaders.cpp");
    source << "namespace shim {" << std::string(kShim).substr(std::string(kShim).find("struct")) << "}\n";
    std::string table;
    for (std::size_t i = 0; i < texts.size(); ++i) {
      source << "namespace shim { namespace m" << i << " {\n" << texts[i] << "} }\n";
      table += fmt::format("shim::m{}::lobe_brdf, ", i);
    }
    source << "static shim::vec3 (*const table[])(shim::vec3, shim::vec3) = {" << table << "};\n"
           << "extern \"C\" void evaluate(int which, const float* v, float* out) {\n"
              "  const shim::vec3 f = table[which](shim::vec3(v[0], v[1], v[2]), shim::vec3(v[3], v[4], v[5]));\n"
              "  out[0] = f.x; out[1] = f.y; out[2] = f.z;\n}\n"
              "extern \"C\" void bind(const unsigned short* texels, const int* size) {\n"
              "  shim::texels = texels;\n  for (int i = 0; i < 3; ++i) shim::size[i] = size[i];\n}\n";
    source.close();
    const auto made =
        run_command("cd '" + directory_.path().string() +
                    "' && { echo '#include <cmath>'; cat shaders.cpp; } > all.cpp && " + LOBE_CXX_COMPILER +
                    " -std=c++20 -O1 -w -ffp-contract=off -fsingle-precision-constant "
                    "-fPIC -shared all.cpp -o shaders.so 2>&1");
    EXPECT_EQ(made.status, 0) << made.output.substr(0, 3000);
    library_ = ::dlopen((directory_.path() / "shaders.so").c_str(), RTLD_NOW);
    if (library_ == nullptr) return;
    evaluate_ = reinterpret_cast<Evaluate>(::dlsym(library_, "evaluate"));
    bind_ = reinterpret_cast<Bind>(::dlsym(library_, "bind"));
  }
  ~CompiledShaders() {
    if (library_ != nullptr) ::dlclose(library_);
  }
  CompiledShaders(const CompiledShaders&) = delete;
  CompiledShaders& operator=(const CompiledShaders&) = delete;

  [[nodiscard]] bool are_there() const { return evaluate_ != nullptr; }
  [[nodiscard]] std::array<float, 3> at(std::size_t which, const std::array<float, 6>& pair) const {
    std::array<float, 3> value{};
    evaluate_(static_cast<int>(which), pair.data(), value.data());
    return value;
  }

  /// The texture that textured shaders look values up in, which has to stay.
  void bind(const TexturedShader& shader) const {
    const std::array<int, 3> size{static_cast<int>(shader.size[0]), static_cast<int>(shader.size[1]),
                                  static_cast<int>(shader.size[2])};
    bind_(shader.texels.data(), size.data());
  }

 private:
  using Evaluate = void (*)(int, const float*, float*);
  using Bind = void (*)(const std::uint16_t*, const int*);

  static std::vector<std::string> texts_of(const std::vector<Material>& materials) {
    std::vector<std::string> texts;
    for (const Material& material : materials) texts.push_back(glsl_shader(material).text);
    return texts;
  }

  TemporaryDirectory directory_;
  void* library_ = nullptr;
  Evaluate evaluate_ = nullptr;
  Bind bind_ = nullptr;
};

/// Pairs of unit vectors in single precision: anywhere, and about the mirror direction.
std::vector<std::array<float, 6>> random_pairs(std::size_t count) {
  Dice dice(7);
  std::vector<std::array<float, 6>> pairs;
  const auto vector = [](double theta, double phi) {
    return std::array{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
  };
  constexpr double kHighest = 1.55;
  while (pairs.size() < count) {
    const auto in = vector(std::acos(dice.uniform(0.02, 1)), dice.uniform(0, 2 * std::numbers::pi));
    auto out = vector(std::acos(dice.uniform(0.02, 1)), dice.uniform(0, 2 * std::numbers::pi));
    if (pairs.size() % 2 == 1) {
      const double theta = std::acos(in[2]) + dice.uniform(-0.3, 0.3);
      if (theta < 0 || theta > kHighest) continue;
      out = vector(theta, std::atan2(in[1], in[0]) + std::numbers::pi + dice.uniform(-0.3, 0.3));
    }
    pairs.push_back({static_cast<float>(in[0]), static_cast<float>(in[1]), static_cast<float>(in[2]),
                     static_cast<float>(out[0]), static_cast<float>(out[1]), static_cast<float>(out[2])});
  }
  return pairs;
}

Directions directions_of(const std::array<float, 6>& pair) {
  const std::array<double, 6> v{pair[0], pair[1], pair[2], pair[3], pair[4], pair[5]};
  const double phi_in = std::atan2(v[1], v[0]);
  return {.theta_in = std::atan2(std::hypot(v[0], v[1]), v[2]),
          .theta_out = std::atan2(std::hypot(v[3], v[4]), v[5]),
          .delta_phi = std::atan2(v[4], v[3]) - phi_in,
          .phi_in = phi_in};
}

/// A material of each model without delta part, at its typical values.
std::vector<Material> typical_materials() {
  std::vector<Material> materials;
  for (const Model& model : catalogue()) {
    if (model.traits.has_delta) continue;
    const CatalogueEntry& entry = find_entry(model.name);
    std::vector<NamedValue> values;
    for (std::size_t i = 0; i < model.parameters.size(); ++i) {
      values.emplace_back(model.parameters[i].name, entry.typical[i]);
    }
    materials.push_back(make_material(model.name, values));
  }
  return materials;
}

/// Values of the library, pairs x channels.
Eigen::MatrixXd values_at(const Material& material, const std::vector<std::array<float, 6>>& pairs, double tilt) {
  std::vector<Directions> directions;
  for (const auto& pair : pairs) {
    directions.push_back(directions_of(pair));
    Directions& last = directions.back();
    last.theta_out = std::max(0.0, last.theta_out + tilt);
    last.delta_phi += tilt;
  }
  return evaluate(device(), material, directions).value;
}

/// The largest deviation where f is above a thousandth of its largest value, relative to f. What tilts of a direction
/// by a unit of single precision make of f is taken off: directions come in that precision, and are rounded inside
/// again.
double worst_deviation(const CompiledShaders& shaders, std::size_t which, const Material& material,
                       const std::vector<std::array<float, 6>>& pairs) {
  constexpr double kUnit = 0x1p-23;
  const Eigen::MatrixXd expected = values_at(material, pairs, 0);
  const Eigen::MatrixXd change = (values_at(material, pairs, kUnit) - expected)
                                     .cwiseAbs()
                                     .cwiseMax((values_at(material, pairs, -kUnit) - expected).cwiseAbs());
  const double floor = expected.cwiseAbs().maxCoeff() / 1000;
  double worst = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto value = shaders.at(which, pairs[i]);
    for (Eigen::Index c = 0; c < 3; ++c) {
      const auto row = static_cast<Eigen::Index>(i);
      const Eigen::Index column = expected.cols() == 3 ? c : 0;
      const double f = expected(row, column);
      if (std::abs(f) < floor) continue;
      const double deviation = (std::abs(value[static_cast<std::size_t>(c)] - f) - change(row, column)) / std::abs(f);
      worst = std::isfinite(deviation) ? std::max(worst, deviation) : INFINITY;
    }
  }
  return worst;
}

TEST(Shader, EveryModelHasTheValuesOfTheLibrary) {
  const auto materials = typical_materials();
  ASSERT_GT(materials.size(), 70U);
  const CompiledShaders shaders(materials);
  ASSERT_TRUE(shaders.are_there());
  const auto pairs = random_pairs(10'000);
  // A power of 40, as some models typically have, makes 40 times as much of the rounding of its base, some units of
  // 6e-8.
  constexpr double kMost = 2e-5;
  std::size_t above = 0;
  for (std::size_t i = 0; i < materials.size(); ++i) {
    const double worst = worst_deviation(shaders, i, materials[i], pairs);
    EXPECT_LE(worst, kMost) << materials[i].name;
    if (worst > 1e-5) ++above;
  }
  EXPECT_LE(above, materials.size() / 14);
}

TEST(Shader, EveryModelReadAsAFileHasTheValuesOfTheLibrary) {
  // Constants have 24 bits; an exponent of 7, which makes a thousandth, makes 7 * 6e-8 of that, and several factors
  // add up. The series for erfc is right to 1.2e-7.
  constexpr double kMost = 2e-6;
  const TemporaryDirectory directory;
  const auto path = directory.path() / "model.glsl";
  const auto pairs = random_pairs(300);
  std::vector<Directions> directions;
  for (const auto& pair : pairs) directions.push_back(directions_of(pair));
  for (const Material& material : typical_materials()) {
    std::ofstream(path) << glsl_shader(material).text;
    const BrdfFunction read = load_measured(path);
    // Typical values may make a model isotropic that need not be.
    EXPECT_TRUE(read.is_isotropic || !Reflectance(material).is_isotropic()) << material.name;
    const Eigen::MatrixXd expected = evaluate(device(), material, directions).value;
    const Eigen::VectorXd found = read.at(directions).value.col(0);
    const double floor = expected.cwiseAbs().maxCoeff() / 1000;
    for (Eigen::Index i = 0; i < found.size(); ++i) {
      const double f = expected(i, 0);
      EXPECT_NEAR(found(i), f, kMost * std::max(std::abs(f), floor)) << material.name << ", pair " << i;
    }
  }
}

TEST(Shader, SumsFactorsAndColoursHaveTheValuesOfTheLibrary) {
  std::vector<Material> materials;
  for (const char* text :
       {"lambert:scale=0.3+ward:m=0.3,scale=0.5", "lambert:scale=0.3/0.2/0.1+phong:n=10/20/30*cos_max:p=0.5",
        "ggx:alpha=0.4*lacquer:s=0.1*half_cosine:alpha=0.5*fresnel:ior=1.5,k=0",
        "oren_nayar:sigma=0.3*power_mean:p=2,alpha=-0.5*transmission:ior=1.5,k=0",
        "ward_anisotropic:m_x=0.3,m_y=0.6,rotation=0.4,scale=0.2+ggx:alpha=0.5", "phong:n=20*cos_max:p=1@normalise"}) {
    materials.push_back(*adjusted(device(), parse_material(text)).formula());
  }
  const CompiledShaders shaders(materials);
  ASSERT_TRUE(shaders.are_there());
  const auto pairs = random_pairs(2'000);
  for (std::size_t i = 0; i < materials.size(); ++i) {
    EXPECT_LE(worst_deviation(shaders, i, materials[i], pairs), 1e-5) << materials[i].name;
    // At and below the horizon there is nothing.
    for (const std::array<float, 6>& below :
         {std::array<float, 6>{0, 0, 1, 1, 0, 0}, std::array<float, 6>{0.6F, 0, -0.8F, 0, 0, 1}}) {
      EXPECT_EQ(shaders.at(i, below), (std::array<float, 3>{0, 0, 0})) << materials[i].name;
    }
  }
}

/// A material of a user's formula.
Material formula(const std::string& text, const std::vector<NamedValue>& parameters = {}) {
  Formula made{.text = text, .reciprocal = false};
  Term term{.model = std::string(kCustomModel), .values = {}, .weight = {1}};
  for (const auto& [name, value] : parameters) {
    made.parameters.push_back(name);
    term.values.push_back(value);
  }
  term.formula = made;
  return {.name = text, .family = "custom", .terms = {term}};
}

std::vector<Material> formulas() {
  Material sum = formula("a * cos_h", {{"a", 0.2}});
  sum.terms.push_back(formula("mix(0.1, 0.3, step(0.5, cos_i * cos_o)) + 0.05 * half_x * half_x").terms.front());
  return {formula("(n + 2) / (2 * pi) * exp(n * log_rv)", {{"n", 7}}),
          formula("where(cos_rv > 0.5 && !(cos_i < 0.1) || distance_p <= 0.2, 1 + erf(cos_o), 0.3) / pi"),
          formula("fresnel(cos_d, 1.5, 0.2) * pow(cos_h, 3.5) * pow(-cos_lv - 1.5, 2) / (4 * max(cos_i, cos_o))"),
          formula("exp10(-tan2_h) + log10(1 + cos_i * cos_o) + cbrt(cos_d) + hypot(cos_i, cos_o) + fmod(theta_i + "
                  "theta_o, 10)"),
          formula("0.3 + 0.1 * in_x * out_x + fdim(half_y, 0.9) * fma(0.1, cos_i * cos_o, 0.2) + rsqrt(1 + cos_h)"),
          sum};
}

TEST(Shader, FormulasOfUsersHaveTheValuesOfTheLibrary) {
  const auto materials = formulas();
  const CompiledShaders shaders(materials);
  ASSERT_TRUE(shaders.are_there());
  const auto pairs = random_pairs(2'000);
  for (std::size_t i = 0; i < materials.size(); ++i) {
    EXPECT_LE(worst_deviation(shaders, i, materials[i], pairs), 1e-5) << materials[i].name;
  }
}

/// \param files names in the directory, with a space before each
void expect_compiled(const TemporaryDirectory& directory, const std::string& files) {
  const auto checked = run_command("cd '" + directory.path().string() + "' && glslangValidator" + files + " 2>&1");
  EXPECT_EQ(checked.status, 0) << checked.output.substr(0, 3000);
  EXPECT_THAT(checked.output, Not(HasSubstr("ERROR")));
}

TEST(Shader, CompilersOfGlslTakeEveryModel) {
  const TemporaryDirectory directory;
  std::string files;
  auto materials = typical_materials();
  materials.push_back(parse_material(
      "ggx:alpha=0.4*lacquer:s=0.1*half_cosine:alpha=0.5*fresnel:ior=1.5,k=0+lambert:scale=0.3/0.2/0.1"));
  for (const Material& one : formulas()) materials.push_back(one);
  for (std::size_t i = 0; i < materials.size(); ++i) {
    for (const bool has_uniforms : {false, true}) {
      for (const auto& [version, precision] : {std::pair("300 es", "precision highp float;\n"), std::pair("330", "")}) {
        const std::string name =
            fmt::format("{}_{}_{}_{}.frag", i, materials[i].terms.front().model, has_uniforms, version[1] == '3');
        std::ofstream(directory.path() / name)
            << "#version " << version << "\n"
            << precision << glsl_shader(materials[i], {.has_uniforms = has_uniforms}).text
            << "in vec3 l;\nin vec3 v;\nout vec4 f;\n"
               "void main() { f = vec4(lobe_brdf(l, v), 1.0); }\n";
        files += " " + name;
      }
    }
  }
  expect_compiled(directory, files);
}

TEST(Shader, UniformsHoldWhatTheTextWouldHold) {
  const Material material = parse_material("lambert:scale=0.3/0.2/0.1+ward:m=0.3,scale=0.5");
  const Shader shader = glsl_shader(material, {.has_uniforms = true});
  EXPECT_THAT(shader.text, HasSubstr("uniform vec4 lobe_constants[8];"));
  ASSERT_EQ(shader.constants.size(), 2U);
  ASSERT_EQ(shader.weights.size(), 2U);
  const std::string fixed = glsl_shader(material).text;
  for (std::size_t lobe = 0; lobe < 2; ++lobe) {
    EXPECT_THAT(
        fixed, HasSubstr(fmt::format("lobe_coefficients({}, {}", shader.constants[lobe][0], shader.constants[lobe][1])))
        << lobe;
  }
  // Materials of the same models share a text.
  EXPECT_EQ(shader.text, glsl_shader(parse_material("lambert+ward:m=0.1"), {.has_uniforms = true}).text);
}

TEST(Shader, TakesNamesThatCompilersTake) {
  const TemporaryDirectory directory;
  const auto write = [&](const std::string& name, const std::string& text) {
    std::ofstream(directory.path() / (name + ".frag")) << "#version 300 es\nprecision highp float;\n"
                                                       << text << "out vec4 f;\nvoid main() { f = vec4(1.0); }\n";
  };
  const Material material = parse_material("ward:m=0.3*cos_max:p=0.5+ggx:alpha=0.3");
  std::string files;
  for (const char* name :
       {"matt", "lobe_", "lobe_gloss", "float_", "mains", "Mix", "sum", "g", "k0", "L", "x", "cos_i"}) {
    write(name, glsl_shader(material, {.function = name}).text);
    files += std::string(" ") + name + ".frag";
  }
  const auto checked = run_command("cd '" + directory.path().string() + "' && glslangValidator" + files + " 2>&1");
  EXPECT_EQ(checked.status, 0) << checked.output.substr(0, 3000);

  // The compiler refuses these as well, all but the prefix that the language reserves.
  for (const char* name :
       {"float",  "main", "for",         "uniform",      "sampler2D", "if",          "true",   "vec3",
        "mat4x3", "asm",  "namespace",   "union",        "double",    "highp",       "layout", "texture",
        "dot",    "mix",  "inversesqrt", "packHalf2x16", "gl_f",      "usamplerCube"}) {
    EXPECT_THROW((void)glsl_shader(material, {.function = name}), ArgumentError) << name;
    write(name, std::string("vec3 ") + name + "(vec3 L, vec3 V) { return L; }\n");
    const auto refused =
        run_command("cd '" + directory.path().string() + "' && glslangValidator " + name + ".frag 2>&1");
    EXPECT_TRUE(refused.status != 0 || std::string_view(name) == "gl_f") << name;
  }
  // The names that the text itself has.
  const std::string text = glsl_shader(material).text;
  for (const char* name : {"lobe_geometry", "lobe_geometry_of", "lobe_coefficients", "lobe_log1p", "lobe_ward",
                           "lobe_ggx", "lobe_factor_cos_max"}) {
    EXPECT_THAT(text, HasSubstr(name));
    EXPECT_THROW((void)glsl_shader(material, {.function = name}), ArgumentError) << name;
  }
  EXPECT_THROW((void)glsl_shader(material, {.function = "lobe_weights", .has_uniforms = true}), ArgumentError);
}

TEST(Shader, RefusesWhatHasNoText) {
  EXPECT_THROW((void)glsl_shader(parse_material("lambert:scale=0.3+mirror:rho=0.2")), NumericError);
  EXPECT_THROW((void)glsl_shader(*adjusted(device(), parse_material("phong:n=20@pump")).formula()), NumericError);
  EXPECT_THROW((void)glsl_shader(parse_material("phong:n=20@pump")), ArgumentError);
  EXPECT_THROW((void)glsl_shader(parse_material("lambert:scale=0.1/0.2")), ArgumentError);
  for (const char* name : {"", "1f", "a b", "gl_f", "a__b", "smooth", "f;"}) {
    EXPECT_THROW((void)glsl_shader(make_material("lambert"), {.function = name}), ArgumentError) << name;
  }
  EXPECT_THAT(glsl_shader(make_material("lambert"), {.function = "matt"}).text, HasSubstr("vec3 matt(vec3 L, vec3 V)"));
  Eigen::MatrixXd weights = Eigen::MatrixXd::Ones(3, 2);
  EXPECT_THROW((void)glsl_shader(make_material("lambert"), {.weights = weights}), ArgumentError);
}

double number_of_half(std::uint16_t bits) {
  const int exponent = (bits >> 10U) & 0x1fU;
  const int fraction = bits & 0x3ffU;
  const double size = exponent == 0 ? std::ldexp(fraction, -24) : std::ldexp(1024 + fraction, exponent - 25);
  return (bits & 0x8000U) != 0 ? -size : size;
}

/// Cosine of the lowest viewer that a sphere shows, at 0.97 of its radius.
constexpr float kLowestViewer = 0.243F;

TEST(TexturedShader, HasTheValuesOfTheLibraryAsCloselyAsPicturesNeed) {
  struct Case {
    Reflectance reflectance;
    double middle, ninth,
        largest;  // median, what nine of ten stay below, and all, of values above a thousandth of the largest
  };
  const auto of = [](const char* text) { return adjusted(device(), parse_material(text)); };
  constexpr double kHalf = 3 * 0x1p-11;  // cubes of numbers of 11 bits
  const HemisphereGrid grid = HemisphereGrid::gauss(24, 48);
  const std::vector<Case> cases{
      {of("lambert:scale=0.3"), kHalf, kHalf, kHalf},
      {of("ggx:alpha=0.2+lambert:scale=0.3"), 2e-3, 1e-2, 0.1},
      {of("ggx:alpha=0.3@pump"), 2e-3, 1e-2, 0.1},
      {of("ggx:alpha=0.5@turquin"), 2e-3, 1e-2, 0.1},
      {tabulate(device(), parse_material("lambert:scale=0.3+ggx:alpha=0.6"), grid), 2e-3, 1e-2, 0.1},
      {of("ward_anisotropic:m_x=0.2,m_y=0.5"), 1e-2, 8e-2, 5}};
  std::vector<TexturedShader> shaders;
  std::vector<std::string> texts;
  for (const Case& one : cases) {
    shaders.push_back(textured_shader(device(), one.reflectance));
    texts.push_back(shaders.back().text);
    EXPECT_EQ(shaders.back().texels.size(),
              4 * shaders.back().size[0] * shaders.back().size[1] * shaders.back().size[2])
        << one.reflectance.name();
  }
  const CompiledShaders compiled(texts);
  ASSERT_TRUE(compiled.are_there());
  const auto pairs = random_pairs(4'000);
  std::vector<Directions> directions;
  for (const auto& pair : pairs) directions.push_back(directions_of(pair));
  for (std::size_t k = 0; k < cases.size(); ++k) {
    const std::string& name = cases[k].reflectance.name();
    compiled.bind(shaders[k]);
    const Eigen::VectorXd expected = evaluate(device(), cases[k].reflectance, directions).value.col(0);
    std::vector<double> off;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const double f = expected(static_cast<Eigen::Index>(i));
      if (pairs[i][5] < kLowestViewer || std::abs(f) < expected.cwiseAbs().maxCoeff() / 1000) continue;
      off.push_back(std::abs(compiled.at(k, pairs[i])[0] / f - 1));
    }
    std::ranges::sort(off);
    ASSERT_GT(off.size(), 500U) << name;
    EXPECT_LE(off[off.size() / 2], cases[k].middle) << name;
    EXPECT_LE(off[9 * off.size() / 10], cases[k].ninth) << name;
    EXPECT_LE(off.back(), cases[k].largest) << name;
  }
}

TEST(TexturedShader, HasValuesWhereAnglesAreNone) {
  const auto unit = [](double theta, double phi) {
    return std::array{static_cast<float>(std::sin(theta) * std::cos(phi)),
                      static_cast<float>(std::sin(theta) * std::sin(phi)), static_cast<float>(std::cos(theta))};
  };
  std::vector<std::array<float, 6>> pairs;
  const auto add = [&](const std::array<float, 3>& in, const std::array<float, 3>& out) {
    pairs.push_back({in[0], in[1], in[2], out[0], out[1], out[2]});
  };
  add(unit(0, 0), unit(0, 0));
  for (const double phi : {0., 1., 2 * std::numbers::pi - 1e-6, std::numbers::pi, 4.}) {
    add(unit(0.6, phi), unit(0.6, phi));                     // theta_d = 0
    add(unit(0.6, phi), unit(0.6, phi + std::numbers::pi));  // H at the normal
    add(unit(0.6, phi), unit(0.2, phi));                     // H between both, of azimuth phi
    add(unit(1.2, phi), unit(0.3, phi + 1e-7));
  }
  std::vector<Directions> directions;
  for (const auto& pair : pairs) directions.push_back(directions_of(pair));
  for (const char* text : {"lambert:scale=0.2+ggx:alpha=0.7", "lambert:scale=0.2+ward_anisotropic:m_x=0.6,m_y=0.8"}) {
    const TexturedShader shader = textured_shader(device(), parse_material(text));
    const CompiledShaders compiled(std::vector<std::string>{shader.text});
    ASSERT_TRUE(compiled.are_there()) << text;
    compiled.bind(shader);
    const Eigen::VectorXd expected = evaluate(device(), parse_material(text), directions).value.col(0);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const double f = expected(static_cast<Eigen::Index>(i));
      EXPECT_NEAR(compiled.at(0, pairs[i])[0], f, 0.02 * f) << text << ", pair " << i;
    }
    for (const auto& below : {std::array<float, 6>{0, 0, 1, 1, 0, 0}, std::array<float, 6>{0.6F, 0, -0.8F, 0, 0, 1}}) {
      EXPECT_EQ(compiled.at(0, below), (std::array<float, 3>{0, 0, 0})) << text;
    }
  }
}

TEST(TexturedShader, IsOneTextForAllIsotropicReflectances) {
  const BrdfTable table = tabulate(device(), parse_material("ggx:alpha=0.4"), HemisphereGrid::gauss(8, 16));
  const TexturedShader shader = textured_shader(device(), table);
  EXPECT_EQ(shader.text, textured_shader(device(), parse_material("lambert")).text);
  EXPECT_NE(shader.text, textured_shader(device(), parse_material("ward_anisotropic:m_x=0.2,m_y=0.5")).text);
}

TEST(TexturedShader, HasColoursAsRedGreenAndBlue) {
  const TexturedShader shader = textured_shader(device(), parse_material("lambert:scale=0.3/0.2/0.1"));
  for (std::size_t c = 0; c < 3; ++c) {
    const double expected = std::cbrt(std::array{0.3, 0.2, 0.1}[c] / std::numbers::pi);
    EXPECT_NEAR(number_of_half(shader.texels[c]), expected, 0x1p-11 * expected) << c;
  }
  EXPECT_EQ(shader.texels[3], 0);
}

TEST(TexturedShader, RefusesWhatHasNone) {
  const auto reason = [](const char* text, const ShaderOptions& options) -> std::string {
    try {
      (void)textured_shader(device(), parse_material(text), options);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(reason("mirror", {}), HasSubstr("'mirror' has delta parts"));
  EXPECT_THAT(reason("lambert:scale=0.5@mirror", {}), HasSubstr("has delta parts"));
  EXPECT_THAT(reason("lambert:scale=0.1/0.2", {}), HasSubstr("2 channels"));
  EXPECT_THAT(reason("lambert", {.function = "no name"}), HasSubstr("is no name of a function in GLSL"));
  EXPECT_THAT(reason("lambert", {.function = "lobe_values"}), HasSubstr("a name that the text itself uses"));
}

TEST(TexturedShader, HoldsWhatNumbersOf16BitsCan) {
  const auto texel = [](double value) {
    BrdfFunction function;
    function.name = "all";
    function.channels = {"value"};
    function.at = [value](std::span<const Directions> pairs) {
      return BrdfValues{Eigen::MatrixXd::Constant(static_cast<Eigen::Index>(pairs.size()), 1, value), {}};
    };
    return number_of_half(textured_shader(device(), function).texels.front());
  };
  EXPECT_EQ(texel(8), 2);
  EXPECT_EQ(texel(-27), -3);
  EXPECT_EQ(texel(0), 0);
  EXPECT_EQ(texel(1e300), 65504);
  EXPECT_EQ(texel(INFINITY), 65504);
  EXPECT_EQ(texel(NAN), 0);
}

TEST(TexturedShader, MayBeCancelled) {
  double last = 0;
  const auto told = [&](std::string_view /*stage*/, double share) {
    last = share;
    return share < 0.5;
  };
  EXPECT_THROW((void)textured_shader(device(), parse_material("lambert"), {.progress = told}), Cancelled);
  EXPECT_GE(last, 0.5);
  EXPECT_LT(last, 1);
}

TEST(TexturedShader, CompilersOfGlslTakeIt) {
  const TemporaryDirectory directory;
  std::string files;
  for (const char* text : {"lambert", "ward_anisotropic:m_x=0.2,m_y=0.5"}) {
    const std::string name = fmt::format("{}.frag", std::string(text).substr(0, 4));
    std::ofstream(directory.path() / name) << "#version 300 es\nprecision highp float;\n"
                                           << textured_shader(device(), parse_material(text)).text
                                           << "in vec3 l;\nin vec3 v;\nout vec4 f;\n"
                                              "void main() { f = vec4(lobe_brdf(l, v), 1.0); }\n";
    files += " " + name;
  }
  expect_compiled(directory, files);
}

}  // namespace
}  // namespace lobe::test
