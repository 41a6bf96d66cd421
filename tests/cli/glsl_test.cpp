// Shaders of other people, on trial by lobe check, and as operands of other commands.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "cli/command_test.hpp"

namespace lobe::test {
namespace {

using cli::ExitCode;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

class ShaderCommand : public CommandTest {
 protected:
  void write(const std::string& name, const std::string& text) const { std::ofstream(file(name)) << text; }
};

constexpr const char* kLambert =
    "const float rho = 0.5;\nfloat f(vec3 L, vec3 V) { return rho / 3.141592653589793; }\n";

TEST_F(ShaderCommand, ChecksWhatItPrintsItself) {
  write("paint.glsl", make({"shader", "lambert:scale=0.3/0.1/0.1+ggx:alpha=0.8,f0=0.04", "--function", "brdf"}).output);
  const auto outcome = run({"check", "paint.glsl"});
  EXPECT_EQ(outcome.status, 0) << outcome.error;
  EXPECT_THAT(outcome.output, StartsWith("paint.glsl: plausible\n"));
  EXPECT_THAT(outcome.output, HasSubstr("largest albedo, red"));
  EXPECT_THAT(outcome.error, IsEmpty());
}

TEST_F(ShaderCommand, FindsWhatIsWrongAndEndsWithOne) {
  struct Case {
    const char* text;
    const char* verdict;
  };
  const Case cases[] = {
      {"float f(vec3 L, vec3 V) { return 1.2 / 3.14159; }", "implausible: more light than it gets"},
      {"float f(vec3 L, vec3 V) { return L.z / 3.14159; }", "implausible: not reciprocal"},
      {"float f(vec3 L, vec3 V) { return 0.1 - 0.15 * pow(1.0 - L.z, 5.0) * pow(1.0 - V.z, 5.0); }",
       "implausible: negative values"},
      // The form without a division, as it is often posted: 2 at grazing incidence.
      {"float f(vec3 L, vec3 V) { return 22.0 / 6.28 * pow(max(dot(reflect(-L, vec3(0, 0, 1)), V), 0.0), 20.0)"
       " / max(L.z, V.z); }",
       "implausible: more light than it gets"},
      {"vec3 f(vec3 L, vec3 V) { return vec3(0.1, 0.2, 0.4 * V.z); }", "implausible: not reciprocal"},
  };
  for (const auto& [text, verdict] : cases) {
    write("f.glsl", text);
    const auto outcome = run({"check", "f.glsl"});
    EXPECT_EQ(outcome.status, static_cast<int>(ExitCode::negative)) << text;
    EXPECT_THAT(outcome.output, StartsWith("f.glsl: " + std::string(verdict) + "\n")) << text;
    EXPECT_THAT(outcome.error, IsEmpty()) << text;
  }
}

TEST_F(ShaderCommand, AlbedosAreThoseOfTheFormula) {
  write("lambert.glsl", kLambert);
  const Json channel = Json::parse(run({"check", "lambert.glsl", "--json"}).output)["materials"][0]["channels"][0];
  for (const char* key : {"largest_albedo", "mean_albedo"}) {
    SCOPED_TRACE(key);
    EXPECT_NEAR(channel[key]["value"].get<double>(), 0.5, channel[key]["error"].get<double>() + 1e-15);
    EXPECT_LT(channel[key]["error"].get<double>(), 1e-4);
  }
}

TEST_F(ShaderCommand, StandsWhereAFileDoes) {
  write("f.glsl",
        "uniform float rho;\nfloat g(vec3 L, vec3 V) { return 0.25; }\n"
        "float f(vec3 L, vec3 V) { return rho; }\n");
  EXPECT_THAT(
      make({"eval", "f.glsl", "--uniform", "rho=0.125", "--theta-in", "30", "--theta-out", "0", "--delta-phi", "0"})
          .output,
      HasSubstr("0.125"));
  EXPECT_THAT(
      make({"eval", "f.glsl[entry=g,uniform=rho=1]", "--theta-in", "30", "--theta-out", "0", "--delta-phi", "0"})
          .output,
      HasSubstr("0.25"));
  const Json distance = json({"distance", "f.glsl[uniform=rho=0.125]", "lambert:scale=0.39269908169872414"});
  EXPECT_LE(distance["distance"]["value"].get<double>(), 1e-12 + distance["distance"]["error"].get<double>());
}

TEST_F(ShaderCommand, RefusesInOneLine) {
  write("f.glsl", "uniform float rho;\nfloat f(vec3 L, vec3 V) { return rho; }\n");
  expect_refusal({"check", "f.glsl"}, ExitCode::file, "line 1, column 15: no value of the uniform rho");
  expect_refusal({"check", "f.glsl", "--uniform", "roh=1"}, ExitCode::usage, "has no uniform 'roh'");
  expect_refusal({"check", "f.glsl", "--uniform", "rho"}, ExitCode::usage, "'rho' sets no uniform");
  expect_refusal({"check", "f.glsl", "--entry", "g", "--uniform", "rho=1"}, ExitCode::usage, "has no function 'g'");
  expect_refusal({"check", "lambert", "--entry", "g"}, ExitCode::usage, "--entry is an option of files");
  write("endless.glsl", "float f(vec3 L, vec3 V) {\n  while (true) {}\n  return 1.0;\n}\n");
  expect_refusal({"check", "endless.glsl"}, ExitCode::numeric, "a value takes more than 100000 steps");
  write("rows.csv", "theta_in_deg,theta_out_deg,delta_phi_deg,red\n0,0,0,1\n0,60,0,1\n60,0,0,1\n60,60,0,1\n");
  expect_refusal({"check", "rows.csv", "--entry", "g"}, ExitCode::usage, "'rows' is no shader");
}

TEST_F(ShaderCommand, WritesNoTextThatIsNoGlsl) {
  const auto refuse = [&](const std::string& name, const std::string& what) {
    expect_refusal({"shader", "lambert", "--function", name}, ExitCode::usage, what);
  };
  refuse("sampler2D", "'sampler2D' is no name of a function in GLSL");
  refuse("gl_brdf", "no word of GLSL itself");
  refuse("lobe__brdf", "letters, digits and single '_'");
  expect_refusal({"shader", "lambert:scale=0.1/0.2"}, ExitCode::usage, "has 2 channels without a colour");
}

}  // namespace
}  // namespace lobe::test
