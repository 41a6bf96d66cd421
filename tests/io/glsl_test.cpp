// Functions of GLSL: their values against the same formulas in C++, their language, and what is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "formats/format.hpp"
#include "hemisphere/unit_vector.hpp"
#include "io/measured_files.hpp"
#include "lobe/core/directions.hpp"

namespace lobe::test {
namespace {

using std::numbers::pi;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using Vector = Eigen::Vector3d;

BrdfFunction read_shader(const std::string& text, const ReadOptions& options = {}) {
  return read_measured(kGlslFormat, FileBytes::copy("brdf.glsl", text), options);
}

/// Value of an expression, which may use L and V, at one pair of directions.
double value_of(const std::string& expression, const std::string& before = {}) {
  const BrdfFunction brdf =
      read_shader(before + "\nfloat f(vec3 L, vec3 V) {\n  return float(" + expression + ");\n}\n");
  return brdf.at(std::vector<Directions>{{0.5, 0.3, 1, 0}}).value(0, 0);
}

/// Values at twenty pairs, pairs x channels.
Eigen::MatrixXd values_of(const BrdfFunction& brdf) {
  return brdf.at(twenty_geometries()).value;
}

/// Relative rounding of some ten operations on numbers of one sign, with room.
constexpr double kRounding = 1e-13;

/// A function in C++ at the same pairs. Functions that seem isotropic are evaluated with L in the x-z plane.
template <typename Function>
void expect_values(const std::string& text, const Function& function, const ReadOptions& options = {}) {
  const BrdfFunction brdf = read_shader(text, options);
  const Eigen::MatrixXd values = values_of(brdf);
  const auto pairs = twenty_geometries();
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const double phi = brdf.is_isotropic ? 0 : pairs[k].phi_in;
    const Vector light = unit_vector(pairs[k].theta_in, phi);
    const Vector view = unit_vector(pairs[k].theta_out, phi + pairs[k].delta_phi);
    const double expected = function(light, view);
    EXPECT_NEAR(values(static_cast<Eigen::Index>(k), 0), expected, kRounding * std::abs(expected)) << "pair " << k;
  }
}

constexpr const char* kGgx = R"(#version 300 es
precision highp float;
#define PI 3.14159265358979
#define saturate(x) clamp(x, 0.0, 1.0)
#define sqr(x) ((x) * (x))
const float alpha = 0.3;
uniform vec3 f0;

float D(float nh, float a) {
  float a2 = a * a;
  return a2 / (PI * sqr(sqr(nh) * (a2 - 1.0) + 1.0));
}
float G1(vec3 w) { return 2.0 * w.z / (w.z + sqrt(alpha * alpha + (1.0 - sqr(alpha)) * w.z * w.z)); }

/* Schlick */
vec3 fresnel(vec3 lower, float c) { return lower + (1.0 - lower) * pow(1.0 - c, 5.0); }

vec3 brdf(vec3 L, vec3 V) {
  if (L.z <= 0.0 || V.z <= 0.0) { return vec3(0); }
  vec3 H = normalize(L + V);
  float d = D(saturate(H.z), alpha);
  return fresnel(f0, dot(L, H)) * d * G1(L) * G1(V) / (4.0 * L.z * V.z);  // Walter et al. 2007
}
)";

double ggx(const Vector& light, const Vector& view) {
  // In tangents of the half-vector, as Walter et al. write it.
  const Vector half = light + view;
  const double tan2 = (half.x() * half.x() + half.y() * half.y()) / (half.z() * half.z());
  const double cos2 = 1 / (1 + tan2);
  const double a2 = 0.09;
  const double d = a2 / (3.14159265358979 * cos2 * cos2 * std::pow(a2 + tan2, 2));
  const auto masking = [&](const Vector& w) {
    return 2 / (1 + std::sqrt(1 + a2 * (1 - w.z() * w.z()) / (w.z() * w.z())));
  };
  const double cosine = light.dot(half) / half.norm();
  return (0.2 + 0.8 * std::pow(1 - cosine, 5)) * d * masking(light) * masking(view) / (4 * light.z() * view.z());
}

TEST(Glsl, MicrofacetsHaveTheValuesOfTheirFormula) {
  // What cancels in cos^2 (a^2 - 1) + 1 costs up to 1/a^2 of the rounding.
  const ReadOptions options{.uniforms = {{"f0", {0.2, 0.5, 1}}}};
  const BrdfFunction brdf = read_shader(kGgx, options);
  EXPECT_THAT(brdf.channels, ElementsAre("red", "green", "blue"));
  EXPECT_TRUE(brdf.is_isotropic);
  EXPECT_THAT(brdf.remarks, IsEmpty());
  EXPECT_THAT(brdf.conventions, HasSubstr("f0 = 0.2/0.5/1"));
  expect_values(kGgx, ggx, options);
}

TEST(Glsl, AnglesAndChoicesHaveTheValuesOfTheirFormula) {
  expect_values(
      R"(const float sigma = 0.5;
float oren_nayar(vec3 lightDir, vec3 viewDir) {
  float s2 = sigma * sigma, A = 1. - .5 * s2 / (s2 + .33), B = .45 * s2 / (s2 + .09);
  float ti = acos(lightDir.z), to = acos(viewDir.z);
  vec2 a = normalize(lightDir.xy), b = normalize(viewDir.xy);
  float c = max(0., dot(a, b));
  float big = ti > to ? ti : to, small = min(ti, to);
  return (A + B * c * sin(big) * tan(small)) / radians(180.);
})",
      [](const Vector& light, const Vector& view) {
        const double in = std::atan2(std::hypot(light.x(), light.y()), light.z());
        const double out = std::atan2(std::hypot(view.x(), view.y()), view.z());
        const double phi = std::atan2(view.y(), view.x()) - std::atan2(light.y(), light.x());
        const double a = 1 - 0.5 * 0.25 / (0.25 + 0.33);
        const double b = 0.45 * 0.25 / (0.25 + 0.09);
        return (a + b * std::max(0.0, std::cos(phi)) * std::sin(std::max(in, out)) * std::tan(std::min(in, out))) / pi;
      });
}

TEST(Glsl, NormalAndTangentsAreGivenByNameOrPlace) {
  const auto ward = [](const Vector& light, const Vector& view) {
    const Vector half = (light + view) / (light + view).norm();
    const double exponent = (std::pow(half.x() / 0.1, 2) + std::pow(half.y() / 0.4, 2)) / std::pow(half.z(), 2);
    return std::exp(-exponent) / std::sqrt(light.z() * view.z()) / (4 * pi * 0.04);
  };
  const std::string body = R"({
  vec3 H = normalize(L + V);
  float e = (pow(abs(dot(H, X)) / 0.1, 2.) + pow(abs(dot(H, Y)) / 0.4, 2.)) / pow(dot(H, N), 2.0);
  return vec3(exp(-e) * inversesqrt(dot(N, L) * dot(N, V)) / (4. * 3.141592653589793 * 0.04));
})";
  expect_values("vec3 BRDF(vec3 L, vec3 V, vec3 N, vec3 X, vec3 Y)" + body, ward);
  expect_values("vec3 BRDF(in vec3 N, in vec3 X, in vec3 Y, vec3 L, const vec3 V)" + body, ward);
  EXPECT_FALSE(read_shader("vec3 BRDF(vec3 L, vec3 V, vec3 N, vec3 X, vec3 Y)" + body).is_isotropic);
  expect_values("float f(vec3 V, vec3 L) { return L.z; }",
                [](const Vector& light, const Vector&) { return light.z(); });
  expect_values("float f(vec3 a, vec3 b) { return a.z; }",
                [](const Vector& light, const Vector&) { return light.z(); });
  expect_values("float f(vec3 wo, vec3 a) { return a.z; }",
                [](const Vector& light, const Vector&) { return light.z(); });
  expect_values("float f(vec3 n, vec3 v, vec3 l) { return dot(n, l); }",
                [](const Vector& light, const Vector&) { return light.z(); });
}

TEST(Glsl, LoopsStructuresArraysAndMatricesCompute) {
  expect_values(
      R"(struct Series { float c[3]; int n; };
const float k[3] = float[3](0.5, 0.25, 0.125);
Series made(float s) {
  Series t;
  t.n = k.length();
  for (int i = 0; i < t.n; i++) t.c[i] = s * k[i];
  return t;
}
void add(inout float sum, float x) { sum += x; }
float series(Series t, float x) {
  float sum = 0.0, power = 1.0;
  int i = 0;
  while (true) {
    if (i == t.n) break;
    add(sum, t.c[i] * power);
    power *= x;
    ++i;
  }
  return sum;
}
mat3 turn(float a) { return mat3(cos(a), sin(a), 0., -sin(a), cos(a), 0., 0., 0., 1.); }
float f(vec3 L, vec3 V) {
  vec3 T = turn(0.4) * L;
  vec3 B = L * turn(-0.4);
  float x = distance(T, B) < 1e-12 ? 1. : 0.;
  do { x += 0.5; } while (x < 1.2);
  return series(made(2.0), L.z) * x + turn(0.4)[0][1] * 0.0;
})",
      [](const Vector& light, const Vector&) { return 1.5 * (1 + 0.5 * light.z() + 0.25 * light.z() * light.z()); });
}

TEST(Glsl, ExpressionsHaveTheirValues) {
  struct Case {
    const char* expression;
    double value;
  };
  const Case cases[] = {
      {"1 + 2 * 3", 7},
      {"7 / 2", 3},
      {"-7 / 2", -3},
      {"7 % 4", 3},
      {"0x1F + 010", 39},
      {"2147483647 + 1", -2147483648.0},
      {"uint(3) - 4u", 4294967295.0},
      {"1.5e1 / .5", 30},
      {"(1.0 - 0.25) * 4.f", 3},
      {"true && !false ? 2 : 3", 2},
      {"false || 1 > 2 ^^ true ? 2 : 3", 2},
      {"vec3(1, 2, 3).zyx.x", 3},
      {"dot(vec3(1, 2, 3).bgr, vec3(1, 10, 100))", 123},
      {"length(vec4(1, vec2(2), 4).xyzw)", 5},
      {"vec2(3, 4) == vec2(3, 4) ? 1.0 : 0.0", 1},
      {"vec2(3, 4) != vec2(3, 5) ? 1.0 : 0.0", 1},
      {"cross(vec3(1, 0, 0), vec3(0, 1, 0)).z", 1},
      {"reflect(vec3(1, -1, 0), vec3(0, 1, 0)).y", 1},
      {"refract(vec3(0, 0, -1), vec3(0, 0, 1), 0.5).z", -1},
      {"faceforward(vec3(0, 0, 1), vec3(0, 0, 1), vec3(0, 0, 1)).z", -1},
      {"mod(-1.5, 1.0)", 0.5},
      {"fract(-0.25)", 0.75},
      {"sign(-2.0) + step(0.5, 0.5) + floor(-0.5) + ceil(0.25) + trunc(-1.5)", -1},
      {"clamp(2.0, 0.0, 1.0) + mix(1.0, 3.0, 0.25)", 2.5},
      {"mix(vec2(1), vec2(2), bvec2(true, false)).x", 2},
      {"smoothstep(0.0, 1.0, 0.25)", 0.15625},
      {"min(1, 2) + max(3.0, 4)", 5},
      {"abs(-3) + abs(-0.5)", 3.5},
      {"degrees(atan(1.0, -1.0))", 135},
      {"exp2(3.0) + log2(8.0)", 11},
      {"any(lessThan(vec2(1, 5), vec2(2))) && !all(lessThan(vec2(1, 5), vec2(2))) ? 1 : 0", 1},
      {"(mat2(1, 2, 3, 4) * vec2(1, 10)).x", 31},
      {"(vec2(1, 10) * mat2(1, 2, 3, 4)).x", 21},
      {"(mat2(1, 2, 3, 4) * mat2(1, 2, 3, 4))[1].y", 22},
      {"transpose(mat2(1, 2, 3, 4))[0][1]", 3},
      {"outerProduct(vec2(1, 2), vec2(3, 4))[1][0]", 4},
      {"mat3(2.0)[2][2] + matrixCompMult(mat2(3), mat2(3))[1][1]", 11},
      {"int(2.9) + int(-2.9) + int(true)", 1},
      {"float[](4.0, 5.0)[1]", 5},
      {"isnan(0.0 / 0.0) ? 1 : 0", 1},
      {"max(0.0, 0.0 / 0.0)", 0},
      {"roundEven(2.5) + round(0.4)", 2},
  };
  for (const auto& [expression, value] : cases) {
    EXPECT_NEAR(value_of(expression), value, kRounding * std::abs(value)) << expression;
  }
  // The same where nothing is constant: numbers come from a direction.
  EXPECT_DOUBLE_EQ(value_of("sin(L.x) + cos(L.z) - tan(V.x) + asin(L.x) * acos(V.z) + atan(V.y)"),
                   std::sin(std::sin(0.5)) + std::cos(std::cos(0.5)) - std::tan(std::sin(0.3) * std::cos(1)) +
                       0.5 * 0.3 + std::atan(std::sin(0.3) * std::sin(1)));
}

TEST(Glsl, StatementsWriteWhereTheySay) {
  struct Case {
    const char* body;
    double value;
  };
  const Case cases[] = {
      {"vec3 v = vec3(1, 2, 3); v.xy = v.yx; return dot(v, vec3(100, 10, 1));", 213},
      {"vec3 v = vec3(1, 2, 3); v.yz = v.xy; return dot(v, vec3(100, 10, 1));", 112},
      {"vec4 v = vec4(0); v.wx += vec2(1, 2); return v.x * 10.0 + v.w;", 21},
      {"float a, b; a = b = 2.0; a *= b; a -= 1.0; return a;", 3},
      {"int n = 0; for (int i = 0; i < 10; i += 3) { if (i == 3) continue; n += i; } return float(n);", 15},
      {"int n = 0; for (;;) { ++n; if (n > 4) break; n++; } return float(n);", 5},
      {"float x = 1.0; { float x = 2.0; x++; } return x;", 1},
      {"mat3 m = mat3(0.0); for (int i = 0; i < 3; ++i) m[i][i] = float(i); return m[1][1] + m[2].z;", 3},
      {"vec3 v = vec3(0); int i = 2; v[i] = 5.0; v[i - 1] = 1.0; return v.z + v.y;", 6},
      {"float t[2] = float[2](1.0, 2.0); float u[2] = t; u[0] = 7.0; return t[0] + u[0];", 8},
      {"if (L.z > 2.0) return 1.0; else if (L.z > 0.0) return 2.0; return 3.0;", 2},
  };
  for (const auto& [body, value] : cases) {
    const BrdfFunction brdf = read_shader("float f(vec3 L, vec3 V) {" + std::string(body) + "}");
    EXPECT_EQ(brdf.at(std::vector<Directions>{{0.5, 0.3, 1, 0}}).value(0, 0), value) << body;
  }
}

TEST(Glsl, VariablesOfTheFileStartAnewForEachValueAndOrderCounts) {
  const BrdfFunction brdf = read_shader(
      "float count = 1.0;\nfloat next() { count += 1.0; return count; }\n"
      "float f(vec3 L, vec3 V) { return count + 10.0 * next() + 100.0 * next(); }");
  EXPECT_TRUE((values_of(brdf).array() == 321).all());
  const std::string before =
      "float next(inout float x) { x += 1.0; return x; }\nfloat two(float a, float b) { return a + 10.0 * b; }\n";
  for (const char* value : {"two(x, next(x))", "x + 10.0 * next(x)", "dot(vec2(x, next(x)), vec2(1, 10))"}) {
    const BrdfFunction ordered =
        read_shader(before + "float f(vec3 L, vec3 V) { float x = 1.0; return " + value + "; }");
    EXPECT_EQ(values_of(ordered)(0, 0), 21) << value;
  }
}

TEST(Glsl, MacrosAndConditionsOfThePreprocessorCount) {
  EXPECT_EQ(value_of("sqr(sqr(2.0)) + HALF(3.0)",
                     "#define sqr(x) ((x)*(x))\n#define TWO 2.0\n"
                     "#define HALF(x) \\\n  ((x) / TWO)"),
            17.5);
  EXPECT_EQ(value_of("A", "#ifdef NONE\n#define A 1.0\n#else\n#define A 2.0\n#endif"), 2);
  EXPECT_EQ(value_of("A",
                     "#define ON 1\n#if ON\n#ifndef B\n#define A 3.0\n#endif\n#endif\n#ifdef GL_ES\nprecision "
                     "mediump float;\n#endif\n"),
            3);
  EXPECT_EQ(value_of("A", "#define A A_\n#define A_ 4.0\n#undef B"), 4);
  EXPECT_EQ(value_of("f_(1.0)", "#define f_ g_\nfloat g_(float x) { return x + 1.0; }"), 2);
}

TEST(Glsl, AFunctionIsChosen) {
  const std::string two = "float a(vec3 L, vec3 V) { return 1.0; }\nfloat b(vec3 L, vec3 V) { return 2.0; }\n";
  EXPECT_EQ(values_of(read_shader(two))(0, 0), 2);
  EXPECT_THAT(read_shader(two).remarks, ElementsAre(HasSubstr("2 functions take two directions; the last one, 'b'")));
  EXPECT_EQ(values_of(read_shader(two, {.entry = "a"}))(0, 0), 1);
  expect_complaint([&] { (void)read_shader(two, {.entry = "c"}); }, "'brdf' has no function 'c'; known: a, b");
  expect_complaint(
      [&] { (void)read_shader(two + "float c(float x) { return x; }", {.entry = "c"}); },
      "function 'c' of 'brdf' is none of two directions; expected float or vec3 NAME(vec3 light, vec3 view)");
}

TEST(Glsl, UniformsHaveValues) {
  const std::string text =
      "uniform float a;\nuniform vec2 b;\nuniform int n = 3;\nuniform bool on = true;\n"
      "float f(vec3 L, vec3 V) { return on ? a + b.x + 10.0 * b.y + 100.0 * float(n) : 0.0; }";
  EXPECT_EQ(values_of(read_shader(text, {.uniforms = {{"a", {1}}, {"b", {2, 3}}}}))(0, 0), 333);
  EXPECT_EQ(values_of(read_shader(text, {.uniforms = {{"a", {1}}, {"b", {2}}, {"n", {0}}}}))(0, 0), 23);
  expect_complaint([&] { (void)read_shader(text); }, "line 1, column 15: no value of the uniforms a, b; expected");
  expect_complaint(
      [&] {
        (void)read_shader(text, {.uniforms = {{"a", {1}}, {"c", {2}}}});
      },
      "'brdf' has no uniform 'c'; known: a, b, n, on");
  expect_complaint(
      [&] {
        (void)read_shader(text, {.uniforms = {{"a", {1, 2}}}});
      },
      "uniform 'a' of 'brdf' is given 2 numbers; expected 1 for float");
  expect_complaint([&] { (void)read_shader(text, {.uniforms = {{"n", {0.5}}}}); }, "expected whole numbers for int");
  EXPECT_EQ(parse_uniform("f0=0.1/0.2/3e-1"), (UniformValue{"f0", {0.1, 0.2, 0.3}}));
  for (const char* wrong : {"f0", "=1", "f0=", "f0=red", "f0=1/"}) {
    expect_complaint([&] { (void)parse_uniform(wrong); },
                     std::string("'") + wrong + "' sets no uniform; expected NAME=");
  }
}

TEST(Glsl, DependenceOnTheAzimuthOfTheLightIsFound) {
  EXPECT_TRUE(read_shader("float f(vec3 L, vec3 V) { return 1.0 + dot(L, V); }").is_isotropic);
  // A lobe of 0.6 degrees: rounding of directions counts a thousandfold.
  EXPECT_TRUE(read_shader("float f(vec3 L, vec3 V) { vec3 H = normalize(L + V); return "
                          "exp((H.z * H.z - 1.0) / (H.z * H.z * 1e-4)); }")
                  .is_isotropic);
  EXPECT_FALSE(read_shader("float f(vec3 L, vec3 V) { return 1.0 + 1e-5 * L.x; }").is_isotropic);
  EXPECT_FALSE(read_shader("float f(vec3 L, vec3 V) { return 1.0 + 1e-5 * cos(4.0 * atan(V.y, V.x)); }").is_isotropic);
}

/// A text around a body, so that columns of the body count from 1 in line 2.
std::string around(const std::string& body) {
  return "float f(vec3 L, vec3 V) {\n" + body + "\n}\n";
}

TEST(Glsl, RefusesWithThePlaceAndWhatIsExpected) {
  struct Case {
    std::string text;
    const char* complaint;
  };
  const Case cases[] = {
      {"float f(vec3 L, vec3 V) { return 1.0 }", "line 1, column 38: unexpected '}'; expected ';'"},
      {around("return x;"), "line 2, column 8: unknown name 'x'"},
      {around("return texture(L, V).x;"), "line 2, column 8: unknown function 'texture'"},
      {around("return sqr(L.x);"), "unknown function 'sqr'; did you mean 'sqrt'?"},
      {around("return dot(L, L.xy);"), "line 2, column 8: no function dot(vec3, vec2); expected vectors of one size"},
      {around("return L;"), "line 2, column 8: what is returned is vec3; expected float"},
      {around("return L.w;"), "'w' picks no components of vec3; expected some of xyz"},
      {around("return L[3];"), "index 3 of 3 elements; expected 0 to 2"},
      {around("vec2 a = L + V.xy; return a.x;"), "'+' between vec3 and vec2; expected operands of one size"},
      {around("return 1.0 % 2.0;"), "expected integers"},
      {around("return L.x & 1;"), "'&' works on bits, which is not read"},
      {around("if (L.x) return 1.0; return 0.0;"), "the condition is float; expected bool"},
      {around("const float a = 1.0; a = 2.0; return a;"), "this cannot be assigned to; expected a variable"},
      {around("float a = 1.0; return (a = 2.0);"), "an assignment within an expression is not read"},
      {around("float a = 1.0; return a++;"), "unexpected '++'; expected ';'"},
      {around("int i = 1.5; return 1.0;"), "the value of 'i' is float; expected int"},
      {around("float a = 1.0; float a = 2.0; return a;"), "'a' is declared twice"},
      {around("return f(L, V);"), "line 2, column 8: function 'f' calls itself"},
      {"float g(float x);\nfloat h(float x) { return g(x); }\nfloat g(float x) { return h(x); }\n" +
           around("return g(L.x);"),
       "calls itself, at last; expected no recursion"},
      {"float g(float x);\n" + around("return g(L.x);"), "function 'g' has no body; expected one"},
      {around("switch (1) {} return 1.0;"), "'switch' in a function is not read"},
      {around("discard;"), "'discard' in a function is not read"},
      {around("break;"), "'break' outside a loop"},
      {around("return 1.0; /* open"), "line 2, column 13: nothing closes this comment"},
      {around("float v[L.x > 0.0 ? 1 : 2]; return 1.0;"), "the size of an array is not known here"},
      {around("return 09.0x;"), "'09.0x' is no number of GLSL"},
      {around("return 3000000000000;"), "'3000000000000' is no number of GLSL"},
      {around("return \"text\";"), "line 2, column 8: unexpected character '\"'"},
      {around("return 1.0; \x01"), "unexpected byte \\x01"},
      {"in vec3 light;\n" + around("return 1.0;"), "'in' connects stages of a pipeline"},
      {"uniform sampler2D map;\n" + around("return 1.0;"), "'sampler2D' is no type that is read"},
      {"float3 f(float3 L, float3 V) { return L; }", "line 1, column 1: 'float3' is no type that is read"},
      {"float f(float x) { return x; }", "no function of two directions; expected float or vec3 NAME("},
      {"float lambert(vec3 n, vec3 l) { return dot(n, l); }", "no function of two directions"},
      {"#include <brdf>\n" + around("return 1.0;"), "line 1, column 1: #include is not read"},
      {"#ifdef A\n" + around("return 1.0;"), "line 1, column 1: nothing closes this condition"},
      {"#endif\n" + around("return 1.0;"), "#endif without a condition"},
      {"#define F(a, b) a\n" + around("return F(1.0);"), "'F' has 1 arguments; expected 2"},
      {"#define F(a) a\n" + around("return F(1.0;"), "nothing closes the arguments of 'F'"},
      {"#if A + 1\n#endif\n" + around("return 1.0;"), "#if has an expression, which is not read"},
      {"float a = f(vec3(0), vec3(0));\n" + around("return 1.0;"), "unknown function 'f'"},
      {"float v = 1.0;\nconst float c = v;\n" + around("return c;"), "line 2, column 17: 'v' is no constant"},
      {"float g() { return 1.0; }\nfloat a = g();\n" + around("return 1.0;"), "calls a function of this file"},
      {"const int z = 0;\nconst float a[2] = float[2](1.0, 2.0);\nconst float b = a[1 / z];\n" + around("return b;"),
       "line 3, column 21: an integer is divided by 0"},
  };
  for (const auto& [text, complaint] : cases) {
    SCOPED_TRACE(text);
    expect_complaint([&, &t = text] { (void)read_shader(t); }, complaint);
    expect_complaint([&, &t = text] { (void)read_shader(t); }, "cannot read brdf.glsl: line ");
  }
}

TEST(Glsl, BoundsWhatATextMayAsk) {
  std::string nested = "1.0";
  for (int k = 0; k < 5000; ++k) nested = "(" + nested + ")";
  std::string blocks;
  for (int k = 0; k < 5000; ++k) blocks += "{";
  std::string laughs = "#define A0 1.0 +\n";
  for (int k = 1; k < 30; ++k) {
    laughs += "#define A" + std::to_string(k) + " A" + std::to_string(k - 1) + " A" + std::to_string(k - 1) + "\n";
  }
  std::string calls = "#define g(x) x x\nfloat f(vec3 L, vec3 V) { return ";
  for (int k = 0; k < 40; ++k) calls += "g(";
  const std::pair<std::string, const char*> cases[] = {
      {around("return " + nested + ";"), "nested too deep"},
      {around(blocks), "nested too deep"},
      {laughs + around("return A29 0.0;"), "macros stand for more than 32768 tokens"},
      {calls, "macros nest more than 32 deep"},
      {around("float a[60000], b[60000]; return 1.0;"), "more than 65536 components"},
      {around("float a[100000]; return 1.0;"),
       "the size of an array is not known here; expected a constant from 1 to 65536"},
      {"struct S { float a[60000]; float b[60000]; };" + around("return 1.0;"), "the structure is too large"},
      {around("return 1.0;") + std::string(200'000, ' '), "the shader has 200040 bytes; expected at most 131072"},
  };
  for (const auto& [text, complaint] : cases) {
    SCOPED_TRACE(complaint);
    expect_complaint([&, &t = text] { (void)read_shader(t); }, complaint);
  }
}

TEST(Glsl, ValuesThatAreNoneAreRefusedWithTheirPlace) {
  const std::pair<std::string, const char*> cases[] = {
      {"while (true) {} return 1.0;", "column 1: a value takes more than 100000 steps at theta_in"},
      {"int i = L.z > 0.0 ? 3 : 0; return L[i];", "line 2, column 36: an index is outside its array"},
      {"int i = L.z > 0.0 ? 0 : 1; return float(3 / i);", "line 2, column 43: an integer is divided by 0"},
      {"float a = L.z - L.z; return 1.0 + a / a;", "line 2, column 37: a result is not a number"},
      {"return 1.0 / (L.z - L.z);", "line 2, column 12: a result is infinite"},
      {"return sqrt(L.z - 2.0);", "line 2, column 8: a result is not a number"},
      {"return pow(L.z - 2.0, 2.0);", "line 2, column 8: a result is not a number"},
      {"float a; return a;", "a result is not a number"},
      {"if (L.z > 2.0) return 1.0;", "a result is not a number"},
  };
  for (const auto& [body, complaint] : cases) {
    SCOPED_TRACE(body);
    const BrdfFunction brdf = read_shader(around(body));
    expect_complaint([&] { (void)values_of(brdf); }, complaint);
    EXPECT_THROW((void)values_of(brdf), NumericError);
  }
}

TEST(Glsl, TextsAreRecognisedByTheirFirstWords) {
  for (const char* text : {"// here\n/* there */ float f(vec3 L", "#version 300 es", "#define PI 3", "const float a",
                           "uniform float a", "vec3 brdf(", "struct S {", "\xef\xbb\xbfvec3 f(", "float[2] f("}) {
    EXPECT_EQ(format_of(FileBytes::copy("a", text)), &kGlslFormat) << text;
  }
  for (const char* text :
       {"float 1 2", "float,vec3", "floats", "# define", "int = 3", "1 2 3", "in 2 out 3", "vec3", ""}) {
    const Format* format = format_of(FileBytes::copy("a", text));
    EXPECT_NE(format, &kGlslFormat) << text;
  }
}

}  // namespace
}  // namespace lobe::test
