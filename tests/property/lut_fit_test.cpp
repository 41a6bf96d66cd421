// Functions that stand for lookup tables: against best approximations that are known, against Chebyshev's alternation,
// and as compilers evaluate what is written.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <numbers>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "io/command.hpp"
#include "lobe/core/error.hpp"
#include "lobe/lut.hpp"
#include "lut/minimax.hpp"
#include "support/device.hpp"
#include "support/temporary_directory.hpp"

namespace lobe::test {
namespace {

using ::testing::HasSubstr;

/// Chebyshev polynomials at places from -1 to 1.
Eigen::MatrixXd chebyshev(const Eigen::VectorXd& places, Eigen::Index degree) {
  Eigen::MatrixXd basis(places.size(), degree + 1);
  for (Eigen::Index n = 0; n <= degree; ++n) {
    basis.col(n) = places.unaryExpr(
        [&](double x) { return std::cos(static_cast<double>(n) * std::acos(std::clamp(x, -1.0, 1.0))); });
  }
  return basis;
}

/// Extrema of T_120, which are those of T_n for all n that divide 120, too.
Eigen::VectorXd extrema() {
  return Eigen::VectorXd::NullaryExpr(
      121, [](Eigen::Index i) { return std::cos(std::numbers::pi * static_cast<double>(120 - i) / 120); });
}

Eigen::VectorXd ones(const Eigen::VectorXd& places) {
  return Eigen::VectorXd::Ones(places.size());
}

Eigen::VectorXd zeros(const Eigen::VectorXd& places) {
  return Eigen::VectorXd::Zero(places.size());
}

/// Points in a row at which differences are the largest, with signs that alternate.
int alternations(const Eigen::VectorXd& differences, double share) {
  const double largest = differences.cwiseAbs().maxCoeff();
  int count = 0;
  double sign = 0;
  for (const double difference : differences) {
    if (std::abs(difference) < (1 - share) * largest || difference * sign > 0) continue;
    sign = difference;
    ++count;
  }
  return count;
}

// Chebyshev 1854: x^n less its best polynomial of degree n - 1 is T_n / 2^(n - 1).
TEST(BestPolynomial, OfAPowerIsOffByAChebyshevPolynomial) {
  const Eigen::VectorXd x = extrema();
  for (const Eigen::Index n : {1, 2, 3, 4, 5, 6, 8, 10, 12}) {
    const Eigen::VectorXd values = x.array().pow(static_cast<double>(n));
    const Minimax best = minimax(chebyshev(x, n - 1), ones(x), values, zeros(x));
    const double known = std::exp2(1.0 - static_cast<double>(n));
    EXPECT_NEAR(best.largest, known, 1e-9 * known) << n;
    EXPECT_NEAR(best.bound, known, 1e-9 * known) << n;
    EXPECT_LE(best.bound, best.largest * (1 + 1e-12)) << n;
  }
}

// |x|: x^2 + 1/8. The problem is degenerate: a cubic term changes nothing.
TEST(BestPolynomial, OfAnAbsoluteValueIsAParabola) {
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(201, -1, 1);
  for (const Eigen::Index degree : {2, 3}) {
    const Minimax best = minimax(chebyshev(x, degree), ones(x), x.cwiseAbs(), zeros(x));
    EXPECT_NEAR(best.largest, 0.125, 1e-9) << degree;
    EXPECT_NEAR(best.bound, 0.125, 1e-9) << degree;
    EXPECT_NEAR(best.numerator[2], 0.5, 1e-8) << degree;  // x^2 = (1 + T_2) / 2
  }
}

TEST(BestPolynomial, EquioscillatesAtOnePointMoreThanItHasCoefficients) {
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(400, -1, 1);
  const Eigen::VectorXd values = x.array().exp();
  for (const Eigen::Index degree : {0, 1, 3, 6}) {
    const Eigen::MatrixXd basis = chebyshev(x, degree);
    const Minimax best = minimax(basis, ones(x), values, zeros(x));
    EXPECT_EQ(alternations(values - basis * best.numerator, 1e-8), degree + 2) << degree;
    EXPECT_NEAR(best.bound, best.largest, 1e-8 * best.largest) << degree;
  }
}

// Of two arguments nothing alternates: the bound must meet the error all the same.
TEST(BestPolynomial, OfTwoArgumentsMeetsItsBound) {
  Eigen::VectorXd values(144);
  Eigen::MatrixXd basis(144, 6);
  for (Eigen::Index i = 0; i < 144; ++i) {
    const double x = static_cast<double>(i / 12) / 11;
    const double y = static_cast<double>(i % 12) / 11;
    values[i] = std::exp(x * y) + std::abs(x - y);
    basis.row(i) << 1, x, y, x * x, x * y, y * y;
  }
  const Minimax best = minimax(basis, Eigen::VectorXd::Ones(144), values, Eigen::VectorXd::Zero(144));
  EXPECT_GT(best.largest, 0.01);
  EXPECT_NEAR(best.bound, best.largest, 1e-8 * best.largest);
  const Minimax uncertain = minimax(basis, Eigen::VectorXd::Ones(144), values, Eigen::VectorXd::Constant(144, 1e-3));
  EXPECT_NEAR(uncertain.bound, best.bound - 1e-3, 1e-9);
}

TEST(BestQuotient, IsFoundWhereTheValuesAreOne) {
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(50, -1, 1);
  const Eigen::VectorXd values = (1 + 2 * x.array()) / (3 + x.array() + 0.5 * x.array().square());
  const Minimax best = minimax(chebyshev(x, 1), chebyshev(x, 2), values, zeros(x));
  EXPECT_LT(best.largest, 1e-12);
  // 3 + x + x^2 / 2 = 3.25 + T_1 + T_2 / 4
  EXPECT_NEAR(best.denominator[0], 1, 1e-12);
  EXPECT_NEAR(best.denominator[1], 1 / 3.25, 1e-9);
  EXPECT_NEAR(best.denominator[2], 0.25 / 3.25, 1e-9);
}

// Achieser: a quotient of degrees m and n with m + n + 2 alternations is the best one.
TEST(BestQuotient, EquioscillatesAtTwoPointsMoreThanItsDegrees) {
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(400, -1, 1);
  const Eigen::VectorXd values = (3 * x.array()).exp();
  for (const auto& [m, n] :
       std::vector<std::pair<Eigen::Index, Eigen::Index>>{{0, 1}, {1, 1}, {2, 1}, {1, 3}, {3, 3}}) {
    const Eigen::MatrixXd above = chebyshev(x, m);
    const Eigen::MatrixXd below = chebyshev(x, n);
    const Minimax best = minimax(above, below, values, zeros(x));
    const Eigen::VectorXd q = below * best.denominator;
    EXPECT_GT(q.minCoeff(), 0) << m << n;
    EXPECT_EQ(alternations(values - (above * best.numerator).cwiseQuotient(q), 1e-5), m + n + 2) << m << n;
    EXPECT_LE(best.bound, best.largest) << m << n;
    EXPECT_GT(best.bound, 0.9999 * best.largest) << m << n;
  }
}

LutRequest request_for(const std::string& material, const std::vector<std::string>& axes,
                       const std::string& split = {}) {
  LutRequest request{.reflectance = parse_material(material)};
  for (const auto& axis : axes) request.axes.push_back(parse_lut_axis(axis, request.reflectance));
  request.split = split;
  return request;
}

/// The two terms of GGX by roughness and an angle in degrees: one axis whose coordinate is its argument, and one that
/// is not.
const Lut& terms() {
  static const Lut kTerms = make_lut(
      device(),
      request_for("ggx:alpha=0.5,f0=1", {"alpha:count=7,from=0,to=1,map=sqrt", "theta:count=8,entries=nodes"}, "f0"));
  return kTerms;
}

/// A table of any function of the coordinates, without errors.
Lut table_of(const std::vector<std::string>& axes, const std::function<double(const std::vector<double>&)>& value) {
  Lut table{.request = request_for("ggx:alpha=0.5,f0=1", axes), .columns = {"albedo"}, .values = {}, .errors = {}};
  for (std::size_t i = 0; i < table.entries(); ++i) {
    std::vector<double> at(axes.size());
    std::size_t rest = i;
    for (std::size_t a = axes.size(); a-- > 0;) {
      const LutAxis& axis = table.request.axes[a];
      at[a] = axis.coordinate(rest % axis.count);
      rest /= axis.count;
    }
    table.values.push_back(value(at));
  }
  table.errors.assign(table.values.size(), 0.0);
  return table;
}

TEST(LookupTableFit, HasTheCoefficientsOfAPolynomial) {
  const Lut table = table_of({"alpha:count=5", "cos_theta:count=6"}, [](const std::vector<double>& u) {
    return 1 + 2 * u[1] + 3 * u[0] - 4 * u[0] * u[1] * u[1];
  });
  const LutFit fit = fit_lut(device(), table, parse_lut_fit_form("polynomial:1,2"), 1);
  ASSERT_FALSE(fit.is_centred);
  const std::vector<double> known{1, 2, 0, 3, 0, -4};
  ASSERT_EQ(fit.functions[0].numerator.size(), known.size());
  for (std::size_t i = 0; i < known.size(); ++i) EXPECT_NEAR(fit.functions[0].numerator[i], known[i], 1e-12) << i;
  // A sum of exponents of 2 lacks the last term, one of 3 has it.
  EXPECT_GT(fit_lut(device(), table, parse_lut_fit_form("polynomial:2"), 1).functions[0].errors.entries.largest, 0.01);
  const LutFit total = fit_lut(device(), table, parse_lut_fit_form("polynomial:3"), 1);
  EXPECT_LT(total.functions[0].errors.entries.largest, 1e-12);
  EXPECT_EQ(total.functions[0].numerator.size(), 10U);
  EXPECT_NEAR(lut_fit_value(total, std::vector{0.3, 0.7}, 0), 1 + 1.4 + 0.9 - 4 * 0.3 * 0.49, 1e-12);
}

TEST(LookupTableFit, HasTheCoefficientsOfAQuotient) {
  const Lut table = table_of({"alpha:count=6", "cos_theta:count=6"},
                             [](const std::vector<double>& u) { return (1 + u[0]) / (2 + u[1] + 4 * u[0] * u[1]); });
  const LutFit fit = fit_lut(device(), table, parse_lut_fit_form("rational:1,1/1,1"), 1);
  const std::vector<double> above{0.5, 0, 0.5, 0};
  const std::vector<double> below{1, 0.5, 0, 2};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(fit.functions[0].numerator[i], above[i], 1e-9) << i;
    EXPECT_NEAR(fit.functions[0].denominator[i], below[i], 1e-9) << i;
  }
  EXPECT_EQ(lut_fit_size(fit.form, 2), 7U);
}

TEST(LookupTableFit, StatesErrorsWithThoseOfItsEntries) {
  const LutFitForm form = parse_lut_fit_form("polynomial:2,2");
  Lut rough = terms();
  const LutFit plain = fit_lut(device(), rough, form, 1);
  for (double& error : rough.errors) error += 1e-3;
  const LutFit fit = fit_lut(device(), rough, form, 1);
  for (std::size_t c = 0; c < 2; ++c) {
    EXPECT_NEAR(fit.functions[c].errors.entries.largest, plain.functions[c].errors.entries.largest + 1e-3, 1e-6) << c;
    EXPECT_NEAR(fit.functions[c].bound, plain.functions[c].bound - 1e-3, 1e-6) << c;
    EXPECT_GT(plain.functions[c].bound, 0.999 * plain.functions[c].errors.entries.largest) << c;
  }
}

// A table that is finer by half has the points at which the errors of the coarse one are measured.
TEST(LookupTableFit, StatesItsLargestErrorBetweenTheEntries) {
  const std::vector<std::string> coarse{"cos_theta:count=5,entries=nodes"};
  const Lut table = make_lut(device(), request_for("ggx:alpha=0.3,f0=1", coarse));
  const Lut fine = make_lut(device(), request_for("ggx:alpha=0.3,f0=1", {"cos_theta:count=9,entries=nodes"}));
  const LutFit fit = fit_lut(device(), table, parse_lut_fit_form("polynomial:3"), 2);
  double largest = 0;
  for (std::size_t i = 0; i < 9; ++i) {
    const double value = lut_fit_value(fit, std::vector{static_cast<double>(i) / 8}, 0);
    largest = std::max(largest, std::abs(value - fine.values[i]));
  }
  const LutErrors& errors = fit.functions[0].errors;
  EXPECT_GT(largest, 1.05 * errors.entries.largest);
  EXPECT_NEAR(errors.between.largest, largest, 0.1 * largest);
  EXPECT_GE(errors.between.largest, largest);
  EXPECT_EQ(errors.points, 9U);
}

TEST(LookupTableFit, IsWrittenInCentredPowersWhereSinglePrecisionNeedsThem) {
  const Lut table = table_of({"cos_theta:count=60,entries=nodes"},
                             [](const std::vector<double>& u) { return 1 / (1 + 25 * std::pow(2 * u[0] - 1, 2)); });
  const LutFit high = fit_lut(device(), table, parse_lut_fit_form("polynomial:18"), 1);
  EXPECT_TRUE(high.is_centred);
  const double largest = high.functions[0].errors.entries.largest;
  // Without it a degree of 18 has coefficients up to 10^6, and single precision loses all of the fit.
  EXPECT_LT(high.functions[0].single_errors.entries.largest, 1.1 * largest);
  EXPECT_NEAR(high.functions[0].bound, largest, 1e-3 * largest);
  EXPECT_FALSE(fit_lut(device(), table, parse_lut_fit_form("polynomial:4"), 1).is_centred);
}

class WrittenFit : public ::testing::Test {
 protected:
  [[nodiscard]] std::string output_of(const std::string& command) const {
    const CommandResult result = run_command("cd '" + directory_.path().string() + "' && " + command + " 2>&1");
    EXPECT_EQ(result.status, 0) << command << ": " << result.output;
    return result.output;
  }
  void write(const std::string& name, const std::string& content) const {
    std::ofstream(directory_.path() / name) << content;
  }
  /// The largest difference of the columns from the terms, as a program evaluates functions at the entries.
  /// \param number type of the functions
  [[nodiscard]] std::vector<double> errors_of_program(const std::string& functions, const std::string& number) const {
    std::string main = functions + "\n#include <stdio.h>\nint main(void) {\n";
    const auto& axes = terms().request.axes;
    for (std::size_t i = 0; i < axes[0].count; ++i) {
      for (std::size_t k = 0; k < axes[1].count; ++k) {
        const double root = std::sqrt(axes[0].value(axes[0].coordinate(i)));
        const double theta = axes[1].value(axes[1].coordinate(k));
        std::ostringstream arguments;
        arguments.precision(17);
        arguments << "((" << number << ")" << root << ", (" << number << ")" << theta << ")";
        main += "  printf(\"%.17g\\n%.17g\\n\", (double)dfg_scale" + arguments.str() + ", (double)dfg_bias" +
                arguments.str() + ");\n";
      }
    }
    write("main.c", main + "  return 0;\n}\n");
    (void)output_of(LOBE_C_COMPILER
                    " -std=c99 -pedantic-errors -Wall -Wextra -Werror -ffp-contract=off main.c -o main");
    std::istringstream printed(output_of("./main"));
    std::vector<double> largest(2, 0.0);
    for (std::size_t i = 0; i < terms().values.size(); ++i) {
      double value = 0;
      printed >> value;
      largest[i % 2] = std::max(largest[i % 2], std::abs(value - terms().values[i]) + terms().errors[i]);
    }
    return largest;
  }

 private:
  TemporaryDirectory directory_;
};

TEST_F(WrittenFit, HasTheErrorsThatItStatesInC) {
  for (const char* form : {"polynomial:3", "polynomial:6,6", "rational:2,2/2,1"}) {
    const LutFit fit = fit_lut(device(), terms(), parse_lut_fit_form(form), 1);
    const std::string text = lut_fit_file(fit, {.language = LutFitLanguage::c, .name = "dfg"});
    const auto largest = errors_of_program(text, "float");
    for (std::size_t c = 0; c < 2; ++c) {
      EXPECT_NEAR(largest[c], fit.functions[c].single_errors.entries.largest, 1e-9) << form << c;
    }
    EXPECT_THAT(text, HasSubstr("static inline float dfg_bias(float sqrt_alpha, float theta_deg) {")) << form;
    EXPECT_THAT(text, HasSubstr("of this form is below ")) << form;
    EXPECT_THAT(text, HasSubstr("// argument sqrt_alpha: sqrt(alpha), for alpha from 0 to 1, 7 cell centres")) << form;
  }
}

TEST_F(WrittenFit, IsTakenByACompilerOfGlsl) {
  ASSERT_TRUE(has_program("glslangValidator")) << "glslangValidator is missing; install glslang-tools";
  const LutFit fit = fit_lut(device(), terms(), parse_lut_fit_form("rational:2/1"), 1);
  write("main.frag", "#version 450\n" + lut_fit_file(fit, {.language = LutFitLanguage::glsl, .name = "dfg"}) +
                         "layout(location = 0) in vec2 at;\nlayout(location = 0) out vec2 terms;\n"
                         "void main() { terms = dfg(at.x, at.y); }\n");
  (void)output_of("glslangValidator -V main.frag -o main.spv");
  // GLSL and C differ in declarations and suffixes alone.
  const std::string c = lut_fit_file(fit, {.language = LutFitLanguage::c, .name = "dfg"});
  std::string glsl = lut_fit_file(fit, {.language = LutFitLanguage::glsl, .name = "dfg"});
  std::string plain;
  for (std::size_t i = 0; i < c.size(); ++i) {
    const bool is_suffix = c[i] == 'f' && i > 0 && (std::isdigit(static_cast<unsigned char>(c[i - 1])) != 0) &&
                           std::isalnum(static_cast<unsigned char>(c[i + 1])) == 0;
    if (!is_suffix) plain += c[i];
  }
  for (const char* words : {"static inline ", "const "}) {
    for (std::size_t at = plain.find(words); at != std::string::npos; at = plain.find(words)) {
      plain.erase(at, std::string(words).size());
    }
  }
  EXPECT_EQ(glsl.substr(0, plain.size()), plain);
}

// Without an interpreter: Python's statements become C line by line.
TEST_F(WrittenFit, HasTheErrorsThatItStatesInPython) {
  const LutFit fit = fit_lut(device(), terms(), parse_lut_fit_form("rational:2,2/1,1"), 1);
  std::istringstream python(lut_fit_file(fit, {.language = LutFitLanguage::python, .name = "dfg"}));
  std::string c;
  for (std::string line; std::getline(python, line);) {
    if (line.starts_with("def ")) {
      const std::size_t open = line.find('(');
      EXPECT_EQ(line.substr(open), "(sqrt_alpha, theta_deg):") << line;
      c += "static double " + line.substr(4, open - 4) + "(double sqrt_alpha, double theta_deg) {\n";
    } else if (line.starts_with("    return ")) {
      c += line + ";\n}\n";
    } else if (line.starts_with("    ")) {
      c += "const double " + line.substr(4) + ";\n";
    } else {
      EXPECT_TRUE(line.empty() || line.starts_with("# ")) << line;
    }
  }
  const auto largest = errors_of_program(c, "double");
  for (std::size_t k = 0; k < 2; ++k) EXPECT_NEAR(largest[k], fit.functions[k].errors.entries.largest, 1e-12) << k;
}

TEST(LookupTableFit, IsWrittenInTheSameBytesAgain) {
  const auto text = [] {
    return lut_fit_file(fit_lut(device(), terms(), parse_lut_fit_form("rational:2,2/1,1"), 1),
                        {.language = LutFitLanguage::c, .name = "dfg"});
  };
  EXPECT_EQ(text(), text());
}

// Every fit at one place, from its source: a row of numbers with a mistake is off there.
TEST(PublishedFit, HasItsPublishedNumbers) {
  const LutTerms karis = published_lut_fit(PublishedLutFit::karis, 1, 1);
  EXPECT_NEAR(karis.scale, 0.4524, 1e-12);
  EXPECT_NEAR(karis.bias, -0.0024, 1e-12);
  const double rough = 0.5;  // r = (0.5, 0.02875, 0.754, -0.029), a004 = 0.25 * 0.5 + 0.02875 at grazing
  const LutTerms grazing = published_lut_fit(PublishedLutFit::karis, rough * rough, 0);
  EXPECT_NEAR(grazing.scale, 0.754 - 1.04 * 0.15375, 1e-12);
  EXPECT_NEAR(grazing.bias, 1.04 * 0.15375 - 0.029, 1e-12);
  // Gloss 1: exponent 8192. a0 = 2^-9.28 / 0.96 + 0.0025 / 0.96.
  const LutTerms lazarov = published_lut_fit(PublishedLutFit::lazarov, std::sqrt(2.0 / 8194), 1);
  EXPECT_NEAR(lazarov.bias, 0.00427976688083, 1e-13);
  EXPECT_NEAR(lazarov.scale, 1 - 0.00427976688083, 1e-12);
  const LutTerms materialx = published_lut_fit(PublishedLutFit::materialx, 0.25, 0.5);
  EXPECT_NEAR(materialx.scale, 0.838065465618, 1e-10);
  EXPECT_NEAR(materialx.bias, 0.0225672141062, 1e-10);
}

TEST(PublishedFit, IsGradedLikeAFit) {
  const auto errors = published_lut_fit_errors(device(), PublishedLutFit::karis, terms(), 1);
  ASSERT_EQ(errors.size(), 2U);
  double largest = 0;
  double sum = 0;
  const auto& axes = terms().request.axes;
  for (std::size_t i = 0; i < terms().entries(); ++i) {
    const double alpha = axes[0].value(axes[0].coordinate(i / axes[1].count));
    const double theta = axes[1].value(axes[1].coordinate(i % axes[1].count)) * std::numbers::pi / 180;
    const double off =
        std::abs(published_lut_fit(PublishedLutFit::karis, alpha, std::cos(theta)).bias - terms().values[2 * i + 1]);
    largest = std::max(largest, off + terms().errors[2 * i + 1]);
    sum += off * off;
  }
  EXPECT_NEAR(errors[1].entries.largest, largest, 1e-12);
  EXPECT_NEAR(errors[1].entries.rms, std::sqrt(sum / static_cast<double>(terms().entries())), 1e-12);
}

TEST(LookupTableFit, IsRefusedInOneLine) {
  const auto complaint = [](const std::function<void()>& call) -> std::string {
    try {
      call();
    } catch (const ArgumentError& error) {
      return error.what();
    }
    return "taken";
  };
  const auto form = [&](const std::string& text) { return complaint([&] { (void)parse_lut_fit_form(text); }); };
  EXPECT_THAT(form("spline:3"), HasSubstr("'spline:3' is no form of a fit; expected polynomial:DEGREES"));
  EXPECT_THAT(form("rational:3"), HasSubstr("is no form of a fit"));
  EXPECT_THAT(form("polynomial:"), HasSubstr("'' in form 'polynomial:' is no degree"));
  EXPECT_THAT(form("polynomial:2,x"), HasSubstr("'x' in form 'polynomial:2,x' is no degree"));
  EXPECT_THAT(form("rational:2/-1"), HasSubstr("'-1' in form"));
  EXPECT_THAT(form("polynomial:21"), HasSubstr("degree 21 of form 'polynomial:21' is out of range; expected 0 to 20"));
  EXPECT_THAT(form("polynomial:99999999999"), HasSubstr("is out of range"));
  for (const char* text : {"polynomial:3", "polynomial:3,0", "rational:2,2/1", "rational:0/3"}) {
    EXPECT_EQ(to_string(parse_lut_fit_form(text)), text);
  }
  const auto fit = [&](const std::string& text) {
    return complaint([&] { (void)fit_lut(device(), terms(), parse_lut_fit_form(text), 1); });
  };
  EXPECT_THAT(fit("polynomial:2,2,2"), HasSubstr("has 3 degrees for 2 axes; expected one, or one for each axis"));
  EXPECT_THAT(fit("polynomial:10"), HasSubstr("has 66 coefficients for 56 entries; expected more entries"));
  EXPECT_THAT(fit("polynomial:7,0"), HasSubstr("axis alpha has 7 entries for degree 7 of form polynomial:7,0"));
  EXPECT_EQ(fit("polynomial:6,0"), "taken");
  const LutFit good = fit_lut(device(), terms(), parse_lut_fit_form("polynomial:1"), 1);
  EXPECT_THAT(complaint([&] { (void)lut_fit_file(good, {.name = "2d"}); }), HasSubstr("cannot be named '2d'"));
  EXPECT_THAT(complaint([] { (void)lut_fit_language_of("a.tiff"); }), HasSubstr("has the ending '.tiff'; expected .h"));
  EXPECT_THAT(complaint([] { (void)parse_lut_fit_language("rust"); }), HasSubstr("unknown language 'rust'"));
  EXPECT_THAT(complaint([] { (void)parse_published_lut_fit("kairs"); }), HasSubstr("did you mean 'karis'"));
  const Lut curve = make_lut(device(), request_for("ggx:alpha=0.3,f0=1", {"cos_theta:count=3"}));
  EXPECT_THAT(complaint([&] { (void)published_lut_fit_errors(device(), PublishedLutFit::karis, curve, 1); }),
              HasSubstr("the fit karis is one of scale and bias in f0"));
}

// 1 / (u - 0.05) is exact at the centres of cells, and infinite between the first of them and the end.
TEST(LookupTableFit, IsRefusedWithAZeroOfItsDenominator) {
  const Lut table = table_of({"cos_theta:count=4"}, [](const std::vector<double>& u) { return 1 / (u[0] - 0.05); });
  try {
    (void)fit_lut(device(), table, parse_lut_fit_form("rational:0/1"), 1);
    FAIL() << "it did not throw";
  } catch (const ArgumentError& error) {
    EXPECT_THAT(error.what(),
                HasSubstr("the denominator of the best fit of form rational:0/1 has a zero near cos_theta 0"));
  }
}

}  // namespace
}  // namespace lobe::test
