// Tensor trees in the XML of Radiance: against an independent reading, by what a tree of a known function must give,
// and damaged.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <numbers>
#include <random>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "energy/albedo.hpp"
#include "io/window_xml_cases.hpp"
#include "lobe/core/error.hpp"
#include "lobe/energy/albedo.hpp"
#include "lobe/formats/measured.hpp"
#include "lobe/model/specification.hpp"
#include "lobe/reflectance/as_function.hpp"
#include "metric/routes.hpp"
#include "support/device.hpp"
#include "support/measured_data.hpp"
#include "support/temporary_directory.hpp"
#include "table/tabulate.hpp"

namespace lobe::test {
namespace {

namespace fs = std::filesystem;
using std::numbers::pi;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::string kBasis = "<AngleBasis>LBNL/Shirley-Chiu</AngleBasis>";
const std::string kThree = "<IncidentDataStructure>TensorTree3</IncidentDataStructure>";
const std::string kFour = "<IncidentDataStructure>TensorTree4</IncidentDataStructure>";

/// The square of a vector in the disc, by the four sectors of the map (Shirley and Chiu 1997).
std::array<double, 2> square_of(double x, double y) {
  const double r = std::sqrt(x * x + y * y);
  double phi = std::atan2(y, x);
  if (phi < -pi / 4) phi += 2 * pi;
  double a = 0;
  double b = 0;
  if (phi < pi / 4) {
    a = r;
    b = phi * a / (pi / 4);
  } else if (phi < 3 * pi / 4) {
    b = r;
    a = -(phi - pi / 2) * b / (pi / 4);
  } else if (phi < 5 * pi / 4) {
    a = -r;
    b = (phi - pi) * a / (pi / 4);
  } else {
    b = -r;
    a = -(phi - 3 * pi / 2) * b / (pi / 4);
  }
  return {a / 2 + 0.5, b / 2 + 0.5};
}

/// The coordinates at which Radiance looks up a tree; its incident vectors point to the source.
std::vector<double> coordinates(const Directions& pair, std::size_t dimensions) {
  const double in_x = std::sin(pair.theta_in) * std::cos(pair.phi_in);
  const double in_y = std::sin(pair.theta_in) * std::sin(pair.phi_in);
  const double phi_out = pair.phi_in + pair.delta_phi;
  const double out_x = std::sin(pair.theta_out) * std::cos(phi_out);
  const double out_y = std::sin(pair.theta_out) * std::sin(phi_out);
  if (dimensions == 4) {
    const auto in = square_of(-in_x, -in_y);
    const auto out = square_of(out_x, out_y);
    return {in[0], in[1], out[0], out[1]};
  }
  const double turn = -std::atan2(-in_y, -in_x);
  const auto out =
      square_of(out_x * std::cos(turn) - out_y * std::sin(turn), out_x * std::sin(turn) + out_y * std::cos(turn));
  return {0.5 - 0.5 * std::sqrt(in_x * in_x + in_y * in_y), out[0], out[1]};
}

/// Skips blanks.
char next(const std::string& text, std::size_t& at) {
  while (std::isspace(static_cast<unsigned char>(text.at(at))) != 0 || text.at(at) == ',') ++at;
  return text.at(at);
}

/// Looks a value up in the text of a tree itself, without ever making one.
double looked_up(const std::string& text, std::size_t& at, const std::vector<double>& place) {
  EXPECT_EQ(next(text, at), '{');
  ++at;
  double found = 0;
  if (next(text, at) == '{') {
    std::size_t wanted = 0;
    std::vector<double> within;
    for (std::size_t k = 0; k < place.size(); ++k) {
      const bool is_upper = place[k] >= 0.5;
      if (is_upper) wanted += std::size_t{1} << k;
      within.push_back(2 * place[k] - (is_upper ? 1 : 0));
    }
    for (std::size_t part = 0; part < (std::size_t{1} << place.size()); ++part) {
      const double value = looked_up(text, at, within);
      if (part == wanted) found = value;
    }
  } else {
    std::vector<double> values;
    while (next(text, at) != '}') {
      std::size_t length = 0;
      values.push_back(std::stod(text.substr(at, 40), &length));
      at += length;
    }
    const double side =
        std::round(std::pow(static_cast<double>(values.size()), 1.0 / static_cast<double>(place.size())));
    double index = 0;
    for (const double x : place) index = index * side + std::floor(std::min(x, 0.999999999) * side);
    found = values.at(static_cast<std::size_t>(index));
  }
  EXPECT_EQ(next(text, at), '}');
  ++at;
  return found;
}

double looked_up(const std::string& text, const Directions& pair, std::size_t dimensions) {
  std::size_t at = 0;
  return looked_up(text, at, coordinates(pair, dimensions));
}

std::vector<Directions> tree_pairs() {
  std::vector<Directions> pairs;
  for (int i = 0; i < 20; ++i) pairs.push_back({0.02 + 0.077 * i, 1.5 - 0.07 * i, 0.31 * i - 3, 0.5 * i - 4});
  return pairs;
}

std::string tree_text(const std::string& xml, const std::string& direction) {
  const std::size_t begin = xml.find("<ScatteringData>", xml.find(direction)) + 16;
  return xml.substr(begin, xml.find('<', begin) - begin);
}

void expect_values(const BrdfFunction& brdf, const std::string& tree, std::size_t dimensions) {
  const auto pairs = tree_pairs();
  const auto values = brdf.at(pairs).value;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    EXPECT_EQ(values(static_cast<Eigen::Index>(i), 0), looked_up(tree, pairs[i], dimensions)) << i;
  }
}

class TensorTreeData : public MeasuredData {
 protected:
  TensorTreeData() : MeasuredData("klems_computed") {}
};

TEST_F(TensorTreeData, HasTheValuesOfAnIndependentReading) {
  const std::string blinds = text_of(data_ / "blindsT3.xml");
  for (const char* side : {"Reflection Front", "Reflection Back"}) {
    SCOPED_TRACE(side);
    const auto brdf = load_measured(data_ / "blindsT3.xml", {.component = side});
    EXPECT_TRUE(brdf.is_isotropic);
    EXPECT_FALSE(brdf.cells);
    expect_values(brdf, tree_text(blinds, side), 3);
  }
  const auto small = load_measured(data_ / "testBSDF.xml");
  EXPECT_THAT(small.remarks, ElementsAre(HasSubstr("reflection back was taken")));
  EXPECT_EQ(small.name, "Bogus");
  expect_values(small, tree_text(text_of(data_ / "testBSDF.xml"), "Reflection Back"), 3);
}

/// Mean of the values about one azimuth, up to 45 degrees from it.
double mean_about(const BrdfFunction& brdf, double delta_phi) {
  std::vector<Directions> pairs;
  for (int i = 1; i < 15; ++i) {
    for (int k = 1; k < 15; ++k) {
      for (int j = -7; j <= 7; ++j) pairs.push_back({0.1 * i, 0.1 * k, delta_phi + 0.1 * j, 0});
    }
  }
  return brdf.at(pairs).value.mean();
}

TEST_F(TensorTreeData, BlindsHaveExactSumsWithinTheErrorsOfQuadrature) {
  const auto blinds = load_measured(data_ / "blindsT3.xml");
  ASSERT_TRUE(blinds.ring_cells);
  BrdfFunction values = blinds;
  values.ring_cells = nullptr;
  const std::vector<double> theta{0, 0.3, 0.9, 1.5};

  const auto exact = albedo(blinds, theta);
  const auto found = albedo(values, theta);
  for (std::size_t k = 0; k < theta.size(); ++k) {
    // Jumps on all sides: at 0 degrees it is off by 1.5 times the stated error.
    EXPECT_NEAR(found[0][k].value, exact[0][k].value, 2 * found[0][k].error) << theta[k];
    EXPECT_LT(exact[0][k].error, 1e-13) << k;
  }
  EXPECT_NEAR(mean_albedo(values)[0].value, mean_albedo(blinds)[0].value, mean_albedo(values)[0].error);
  const auto norm = [](const BrdfFunction& one) {
    const auto result = measure_functions({&one, 1}, Lighting::point()).combined;
    return Estimate{result.gram(0, 0), result.gram_error(0, 0)};
  };
  EXPECT_NEAR(norm(values).value, norm(blinds).value, norm(values).error);
  EXPECT_LT(norm(blinds).error, 1e-12);
}

TEST_F(TensorTreeData, BlindsAreTheSameOnBothSidesOfThePlaneOfIncidence) {
  // Their tree was traced by rays with noise; what lies along the plane of incidence differs from what lies across it.
  const auto brdf = load_measured(data_ / "blindsT3.xml");
  const double left = mean_about(brdf, pi / 2);
  const double right = mean_about(brdf, -pi / 2);
  const double mirror = mean_about(brdf, pi);
  const double retro = mean_about(brdf, 0);
  EXPECT_NEAR(left, right, 0.05 * (left + right));
  EXPECT_GT(mirror, 1.1 * retro);
}

class TensorTreeFile : public ::testing::Test {
 protected:
  BrdfFunction load(const std::string& text, const ReadOptions& options = {}) const {
    const fs::path path = directory_.path() / "file.xml";
    std::ofstream(path, std::ios::binary) << text;
    return load_measured(path, options);
  }
  BrdfFunction load_tree(const std::string& structure, const std::string& data) const {
    return load(window_xml(structure, {{.bases = kBasis, .data = data}}));
  }
  void expect_refusal(const std::string& text, const std::string& complaint) const {
    try {
      (void)load(text);
      FAIL() << "not refused; expected '" << complaint << "'";
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr(complaint));
    }
  }

  TemporaryDirectory directory_;
};

using TreeShape = std::function<double(const std::vector<double>&)>;

/// A tree down to a depth, with grids of two levels at its ends and single numbers in some branches.
std::string tree_of(const TreeShape& value, std::size_t dimensions, int depth, const std::vector<double>& low,
                    double size) {
  std::ostringstream text;
  text.precision(17);
  text << "{ ";
  const std::size_t parts = std::size_t{1} << dimensions;
  const auto middle_of = [&](const std::vector<double>& corner, double side) {
    std::vector<double> middle;
    for (const double x : corner) middle.push_back(x + side / 2);
    return middle;
  };
  if (depth == 0) {
    // A grid of 4 along each axis, the first coordinate slowest.
    for (std::size_t index = 0; index < parts * parts; ++index) {
      std::vector<double> corner = low;
      std::size_t rest = index;
      for (std::size_t k = dimensions; k-- > 0; rest /= 4) corner[k] += size / 4 * static_cast<double>(rest % 4);
      text << value(middle_of(corner, size / 4)) << " ";
    }
  } else {
    for (std::size_t part = 0; part < parts; ++part) {
      std::vector<double> corner = low;
      for (std::size_t k = 0; k < dimensions; ++k) corner[k] += (part >> k & 1U) != 0 ? size / 2 : 0;
      if (part == 5) {
        text << "{" << value(middle_of(corner, size / 2)) << "}\n";
      } else {
        text << tree_of(value, dimensions, depth - 1, corner, size / 2);
      }
    }
  }
  text << "}\n";
  return text.str();
}

/// A branch down to a depth, everything else single numbers.
std::string narrow_tree(int depth, int parts) {
  if (depth == 0) return "{1}";
  std::string text = "{" + narrow_tree(depth - 1, parts);
  for (int k = 1; k < parts; ++k) text += "{0}";
  return text + "}";
}

double some_value(const std::vector<double>& place) {
  double sum = 0.1;
  double weight = 1;
  for (const double x : place) sum += (weight *= 0.7) * x;
  return sum;
}

TEST_F(TensorTreeFile, OfThreeDimensionsHasTheValuesOfAnIndependentReading) {
  const std::string tree = tree_of(some_value, 3, 2, {0, 0, 0}, 1);
  const auto brdf = load_tree(kThree, tree);
  EXPECT_TRUE(brdf.is_isotropic);
  expect_values(brdf, tree, 3);
}

/// Sums over cells of a tree of three dimensions, looked up in its text: the first coordinate is (1 - sin(theta)) / 2,
/// the others span a disc of area pi.
class TreeSums {
 public:
  TreeSums(std::string text, int side) : text_(std::move(text)), side_(side) {}

  [[nodiscard]] double at(int ring, int a, int b) const {
    std::size_t begin = 0;
    return looked_up(text_, begin, {0.5 - (ring + 0.5) / side_, (a + 0.5) / side_, (b + 0.5) / side_});
  }
  [[nodiscard]] double over_cells(const std::function<double(int, int)>& value) const {
    double sum = 0;
    for (int a = 0; a < side_; ++a) {
      for (int b = 0; b < side_; ++b) sum += value(a, b) * pi / (side_ * side_);
    }
    return sum;
  }
  [[nodiscard]] double over_rings(const std::function<double(int)>& value) const {
    double sum = 0;
    const double step = 2.0 / side_;  // of sin(theta)
    for (int ring = 0; 2 * ring < side_; ++ring) {
      sum += value(ring) * pi * (std::pow((ring + 1) * step, 2) - std::pow(ring * step, 2));
    }
    return sum;
  }

 private:
  std::string text_;
  int side_;
};

TEST_F(TensorTreeFile, OfThreeDimensionsHasExactSums) {
  const std::string text = tree_of(some_value, 3, 2, {0, 0, 0}, 1);
  const auto brdf = load_tree(kThree, text);
  const TreeSums sums(text, 16);
  const auto of_ring = [&](int ring) { return sums.over_cells([&](int a, int b) { return sums.at(ring, a, b); }); };

  std::vector<double> theta;
  for (int ring = 0; ring < 8; ++ring) theta.push_back(std::asin((ring + 0.3) / 8));
  const auto albedos = albedo(brdf, theta).at(0);
  for (int ring = 0; ring < 8; ++ring) {
    SCOPED_TRACE(ring);
    const Estimate& found = albedos[static_cast<std::size_t>(ring)];
    EXPECT_NEAR(found.value, of_ring(ring), found.error) << ring;
    EXPECT_LT(found.error, 1e-12);
  }
  const Estimate mean = mean_albedo(brdf).at(0);
  EXPECT_NEAR(mean.value, sums.over_rings(of_ring) / pi, mean.error);
}

TEST_F(TensorTreeFile, OfThreeDimensionsHasExactProducts) {
  // The second one has larger leaves.
  const std::string text = tree_of(some_value, 3, 2, {0, 0, 0}, 1);
  const auto other = [](const std::vector<double>& x) { return 0.5 - 0.3 * x[0] + 0.2 * x[1] * x[2]; };
  const std::string coarse = tree_of(other, 3, 1, {0, 0, 0}, 1);
  const std::vector<BrdfFunction> brdfs{load_tree(kThree, text), load_tree(kThree, coarse)};
  const TreeSums f(text, 16);
  const TreeSums g(coarse, 8);
  const auto integral = [&](const std::function<double(double, double)>& combine) {
    return f.over_rings([&](int ring) {
      return f.over_cells([&](int a, int b) { return combine(f.at(ring, a, b), g.at(ring / 2, a / 2, b / 2)); });
    });
  };

  const auto found = measure_functions(brdfs, Lighting::point()).combined;
  EXPECT_NEAR(found.gram(0, 1), integral([](double x, double y) { return x * y; }), found.gram_error(0, 1));
  EXPECT_NEAR(found.gram(0, 0), integral([](double x, double) { return x * x; }), found.gram_error(0, 0));
  EXPECT_NEAR(found.distance(0, 1), std::sqrt(integral([](double x, double y) { return (x - y) * (x - y); })),
              found.distance_error(0, 1));
  EXPECT_LT(found.distance_error(0, 1), 1e-12);
  const auto means = measure_functions(brdfs, Lighting::mean_albedo()).combined;
  EXPECT_NEAR(means.gram(0, 1),
              integral([](double x, double) { return x; }) * integral([](double, double y) { return y; }),
              means.gram_error(0, 1));
  // Of directions up to an angle, and beside other functions, products are integrals as ever.
  EXPECT_GT(measure_functions(brdfs, Lighting::point(), {.theta_max = 1.2}).combined.gram_error(0, 1), 1e-9);
}

TEST_F(TensorTreeFile, OfThreeDimensionsMixesBandsExactly) {
  const std::string tree = tree_of(some_value, 3, 1, {0, 0, 0}, 1);
  const std::string bands =
      window_xml(kThree, {{.band = "Visible", .bases = kBasis, .data = tree},
                          {.direction = "Reflection Front", .band = "Solar", .bases = kBasis, .data = "{0.25}"}});
  const auto brdf = load(bands, {.channels = {"Solar"}});
  EXPECT_NEAR(mean_albedo(brdf).at(0).value, 0.25 * pi, 1e-13);
  const auto limited = load(bands, {.theta_max = 1.2});
  EXPECT_FALSE(limited.ring_cells);
}

TEST_F(TensorTreeFile, OfFourDimensionsHasTheValuesOfAnIndependentReading) {
  const std::string tree = tree_of(some_value, 4, 1, {0, 0, 0, 0}, 1);
  const auto brdf = load_tree(kFour, tree);
  EXPECT_FALSE(brdf.is_isotropic);
  expect_values(brdf, tree, 4);
  ASSERT_TRUE(brdf.cells);
  EXPECT_EQ(brdf.cells->grid, HemisphereGrid::shirley_chiu(8));
  // Its cells are the function itself: constant on each.
  const auto nodes = brdf.cells->grid.directions();
  for (std::size_t k = 0; k < 4096; k += 37) {
    const Direction& in = nodes[k / 64];
    const Direction& out = nodes[k % 64];
    const auto value = brdf.at(std::vector<Directions>{{in.theta, out.theta, out.phi - in.phi, in.phi}}).value(0, 0);
    EXPECT_EQ(brdf.cells->values[k], value) << k;
  }
}

TEST_F(TensorTreeFile, OfFourDimensionsKeepsItsLightOnPatches) {
  const auto brdf = load_tree(kFour, tree_of(some_value, 4, 1, {0, 0, 0, 0}, 1));
  const double before = row_albedos(*brdf.cells).mean.front().value;
  const auto after = row_albedos(tabulate(brdf, HemisphereGrid::klems(145))).mean.front();
  EXPECT_NEAR(after.value, before, after.error);
  EXPECT_LT(after.error, 1e-12);
}

TEST_F(TensorTreeFile, HasMirrorsOnTheMirrorSide) {
  // Light that is not turned: equal squares, in the convention of the file.
  const auto mirror4 = [](const std::vector<double>& x) {
    return std::abs(x[0] - x[2]) + std::abs(x[1] - x[3]) < 1e-9 ? 1.0 : 0.0;
  };
  const auto four = load_tree(kFour, tree_of(mirror4, 4, 0, {0, 0, 0, 0}, 1));
  const auto values = four.at(std::vector<Directions>{{0.8, 0.8, pi, 0.3}, {0.8, 0.8, 0, 0.3}}).value;
  EXPECT_EQ(values(0, 0), 1);
  EXPECT_EQ(values(1, 0), 0);
  // Turned to azimuth 0, the mirror direction is that of growing first coordinates.
  const auto mirror3 = [](const std::vector<double>& x) { return x[1] > 0.5 ? 1.0 : 0.0; };
  const auto three = load_tree(kThree, tree_of(mirror3, 3, 0, {0, 0, 0}, 1));
  for (const double phi_in : {0.0, 1.0, 4.0}) {
    SCOPED_TRACE(phi_in);
    const auto found = three.at(std::vector<Directions>{{0.8, 0.8, pi, phi_in}, {0.8, 0.8, 0, phi_in}}).value;
    EXPECT_EQ(found(0, 0), 1);
    EXPECT_EQ(found(1, 0), 0);
  }
}

TEST_F(TensorTreeFile, IsDefinedFromTheNormalToTheHorizon) {
  const auto upper_half = [](const std::vector<double>& x) { return x[0] > 0.5 ? -7.0 : 0.25; };
  const auto brdf = load_tree(kThree, tree_of(upper_half, 3, 1, {0, 0, 0}, 1));
  const double horizon = std::nextafter(pi / 2, 0);
  for (const double theta : {0.0, 1e-12, 1.0, horizon}) {
    SCOPED_TRACE(theta);
    const auto values = brdf.at(std::vector<Directions>{{theta, horizon, pi, 0}, {theta, 0, 0.1, 2}}).value;
    EXPECT_EQ(values(0, 0), 0.25);
    EXPECT_EQ(values(1, 0), 0.25);
  }
  EXPECT_THAT(brdf.remarks, ElementsAre(HasSubstr("values are negative, and kept")));
}

TEST_F(TensorTreeFile, HasAChannelForEachBand) {
  const auto brdf = load(window_xml(kFour, {{.band = "Visible", .bases = kBasis, .data = "{0.2}"},
                                            {.direction = "Reflection Back", .bases = kBasis, .data = "{9}"},
                                            {.band = "Solar", .bases = kBasis, .data = narrow_tree(2, 16)}}));
  EXPECT_THAT(brdf.channels, ElementsAre("Visible", "Solar"));
  EXPECT_EQ(brdf.at(std::vector<Directions>{{0.5, 1, 2, 3}}).value(0, 0), 0.2);
  EXPECT_EQ(brdf.cells->channels, 2U);
  EXPECT_EQ(brdf.cells->grid, HemisphereGrid::shirley_chiu(4));
  EXPECT_EQ(std::ranges::count(brdf.cells->channel(1), 1.0), 1);
}

TEST_F(TensorTreeFile, OfOneNumberIsLambertian) {
  const auto brdf = load_tree(kFour, "{0.2}");
  EXPECT_EQ(brdf.at(std::vector<Directions>{{0.5, 1, 2, 3}}).value(0, 0), 0.2);
  EXPECT_EQ(brdf.cells->grid, HemisphereGrid::shirley_chiu(2));
}

TEST_F(TensorTreeFile, ThatIsDeepTakesNoMoreThanItsLeaves) {
  // A dense table of the same resolution would have 16^19 numbers.
  const auto brdf = load_tree(kFour, narrow_tree(19, 16));
  EXPECT_FALSE(brdf.cells);
  EXPECT_EQ(brdf.at(std::vector<Directions>{{0.5, 1, 2, 3}}).value(0, 0), 0);
}

TEST_F(TensorTreeFile, AfterALongGeometryIsRecognised) {
  const std::string long_text(100000, '#');
  const auto brdf = load("Recover using: genBSDF\n<WindowElement><Optical><Layer><Geometry><MGFblock>" + long_text +
                         "</MGFblock></Geometry><DataDefinition>" + kThree +
                         "</DataDefinition><WavelengthData><WavelengthDataBlock><WavelengthDataDirection>Reflection "
                         "Front</WavelengthDataDirection>" +
                         kBasis +
                         "<ScatteringData>{ 0.5 }</ScatteringData></WavelengthDataBlock></WavelengthData>"
                         "</Layer></Optical></WindowElement>");
  EXPECT_THAT(brdf.format, HasSubstr("Tensor tree"));
  EXPECT_EQ(brdf.at(std::vector<Directions>{{0.5, 1, 2, 3}}).value(0, 0), 0.5);
}

TEST_F(TensorTreeFile, ThatIsDamagedIsRefusedWithItsPlace) {
  const auto with = [&](const std::string& data) { return window_xml(kThree, {{.bases = kBasis, .data = data}}); };
  expect_refusal(window_xml("<IncidentDataStructure>TensorTree5</IncidentDataStructure>", {}),
                 "IncidentDataStructure 'TensorTree5'; expected TensorTree3 or TensorTree4");
  expect_refusal(window_xml(kThree, {{.bases = klems_bases("Full"), .data = "{1}"}}),
                 "line 8: angle basis ''; expected LBNL/Shirley-Chiu");
  expect_refusal(with(""), "line 8: the tree is not closed");
  expect_refusal(with("{1"), "line 8: the tree is not closed");
  expect_refusal(with("\n1"), "line 9: '1' outside the tree");
  expect_refusal(with("{1}\n}"), "line 9: '}' without '{'");
  expect_refusal(with("{1}{1}"), "'{' after the end of the tree");
  expect_refusal(with("{}"), "a leaf of 0 numbers; expected a power of 8");
  expect_refusal(with("{1 2 3}"), "a leaf of 3 numbers; expected a power of 8");
  expect_refusal(with("{1 2 {3}}"), "'{' among numbers");
  expect_refusal(with("{{1}{1}{1}{1}{1}{1}{1}{1} 2}"), "'2' among branches");
  expect_refusal(with("{{1}{1}{1}{1}{1}{1}{1}}"), "fewer braces than branches of 8 parts need");
  expect_refusal(with("{{1}{1}{1}{1}{1}{1}{1}{1}{1}}"), "a branch of more than 8 parts");
  expect_refusal(with("{{{1}{1}{1}{1}{1}{1}{1}{1}}{1}{1}{1}{1}{1}{1}}"), "fewer braces than branches of 8 parts need");
  expect_refusal(with("{ 1 nan 2 3 4 5 6 7 }"), "line 8: 'nan' is no finite number");
  expect_refusal(with("{ 1 1e999 2 3 4 5 6 7 }"), "line 8: '1e999' is no finite number");
  expect_refusal(with(narrow_tree(25, 8)), "a tree of more than 20 levels");
  expect_refusal(with(std::string(1'000'000, '{')), "levels");
}

TEST_F(TensorTreeFile, ThatIsCutOrHasChangedBytesGivesOneLine) {
  const std::string text = window_xml(kThree, {{.bases = kBasis, .data = tree_of(some_value, 3, 1, {0, 0, 0}, 1)}});
  expect_robust(text, 29, [&](const std::string& damaged) { (void)load(damaged); });
}

/// A leaf's number, by the independent coordinates of a pair.
std::size_t leaf_of(const Directions& pair, std::size_t side, std::size_t dimensions) {
  std::size_t leaf = 0;
  for (const double x : coordinates(pair, dimensions)) {
    leaf = leaf * side + static_cast<std::size_t>(std::min(x, 0.999999999) * static_cast<double>(side));
  }
  return leaf;
}

/// Pairs even in the projected solid angle of both directions.
std::vector<Directions> even_pairs(std::size_t count) {
  std::mt19937_64 engine(7);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<Directions> pairs(count);
  for (Directions& pair : pairs) {
    pair = {std::asin(std::sqrt(unit(engine))), std::asin(std::sqrt(unit(engine))), 2 * pi * unit(engine),
            2 * pi * unit(engine)};
  }
  return pairs;
}

class WrittenTensorTree : public ::testing::Test {
 protected:
  BrdfFunction written(const std::string& material, std::size_t leaves) {
    save_measured(device(), parse_material(material), "tensor-tree", path(), {.overwrite = true, .leaves = leaves});
    return load_measured(path());
  }

  /// Holds all leaves against means over random pairs within, of which they are the expected values.
  void expect_averages(const std::string& material, std::size_t side, std::size_t dimensions) {
    constexpr double kDeviations = 5;
    constexpr double kRule = 5e-3;  // what the rules of a leaf leave over
    const BrdfFunction file = written(material, side);
    EXPECT_EQ(file.is_isotropic, dimensions == 3) << material;
    const auto pairs = even_pairs(400'000);
    const Eigen::MatrixXd exact = as_function(device(), parse_material(material)).at(pairs).value;
    const Eigen::MatrixXd stored = file.at(pairs).value;
    struct Moments {
      double count = 0, sum = 0, squares = 0, leaf = 0;
    };
    std::map<std::size_t, Moments> leaves;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      Moments& here = leaves[leaf_of(pairs[i], side, dimensions)];
      const auto row = static_cast<Eigen::Index>(i);
      ++here.count;
      here.sum += exact(row, 0);
      here.squares += exact(row, 0) * exact(row, 0);
      if (here.count == 1) here.leaf = stored(row, 0);
      EXPECT_EQ(here.leaf, stored(row, 0)) << material << " " << i;
    }
    EXPECT_EQ(leaves.size(), dimensions == 3 ? side * side * side / 2 : side * side * side * side) << material;
    const double mean = exact.col(0).mean();
    for (const auto& [number, leaf] : leaves) {
      const double expected = leaf.sum / leaf.count;
      const double deviation = std::sqrt(std::max(0.0, leaf.squares / leaf.count - expected * expected) / leaf.count);
      EXPECT_NEAR(leaf.leaf, expected, kDeviations * deviation + kRule * std::max(expected, mean))
          << material << " " << number;
    }
  }

  [[nodiscard]] fs::path path() const { return folder_.path() / "written.xml"; }

 private:
  TemporaryDirectory folder_;
};

TEST_F(WrittenTensorTree, HoldsAveragesOverRingsAndSquares) {
  expect_averages("ward:m=0.4", 4, 3);
  expect_averages("lafortune:c_xy=-0.6,c_z=0.9,n=6", 8, 3);
}

TEST_F(WrittenTensorTree, HoldsAveragesOverPairsOfSquares) {
  expect_averages("ward_anisotropic:m_x=0.3,m_y=0.6,rotation=0.4", 2, 4);
  expect_averages("ward_anisotropic:m_x=0.5,m_y=0.8,rotation=0.4", 4, 4);
}

TEST_F(WrittenTensorTree, KeepsTheLightOfNarrowLobes) {
  const double exact = mean_albedo(device(), parse_material("ggx:alpha=0.03"), {.tolerance = 1e-6}).at(0).value;
  const double stored = mean_albedo(device(), written("ggx:alpha=0.03", 16)).at(0).value;
  EXPECT_NEAR(stored, exact, 2e-3 * exact);
  const BrdfFunction lambert = written("lambert:scale=0.5", 0);
  EXPECT_NEAR(lambert.at(std::vector<Directions>{{0.5, 1, 2, 3}}).value(0, 0), 0.5 / pi, 1e-7);
}

TEST_F(WrittenTensorTree, IsTheSameForBothSidesAndHasTheNamesOfChannels) {
  const BrdfFunction colours = written("lambert:scale=0.5/0.3/0.2", 2);
  EXPECT_EQ(colours.channels.size(), 3U);
  const auto values = colours.at(std::vector<Directions>{{0.5, 1, 2, 3}}).value;
  EXPECT_NEAR(values(0, 2), 0.2 / pi, 1e-7);
  EXPECT_THAT(written("lambert", 2).channels, ElementsAre("Visible"));
  const BrdfFunction back = load_measured(path(), {.component = "reflection back"});
  EXPECT_NEAR(back.at(std::vector<Directions>{{0.5, 1, 2, 3}}).value(0, 0), 1 / pi, 1e-7);
}

TEST_F(WrittenTensorTree, RefusesOtherNumbersOfLeavesThanPowersOfTwoAndDeltaParts) {
  for (const auto& [material, leaves, reason] : std::vector<std::tuple<std::string, std::size_t, std::string>>{
           {"lambert", 3, "3 leaves along an axis of an isotropic tensor tree; expected a power of two from 2 to 128"},
           {"lambert", 1, "from 2 to 128"},
           {"lambert", 256, "from 2 to 128"},
           {"ward_anisotropic:m_x=0.5,m_y=0.8", 64, "an anisotropic tensor tree; expected a power of two from 2 to 32"},
           {"lambert:scale=0.5+mirror:scale=0.2", 4, "delta"}}) {
    try {
      (void)written(material, leaves);
      FAIL() << material << " " << leaves;
    } catch (const ArgumentError& error) {
      EXPECT_THAT(error.what(), HasSubstr(reason)) << material << " " << leaves;
    }
    EXPECT_FALSE(fs::exists(path())) << material << " " << leaves;
  }
}

TEST_F(WrittenTensorTree, IsNotWrittenIfStoppedOrOfNoFiniteNumbers) {
  const auto stop = [](std::string_view, double) { return false; };
  EXPECT_THROW(save_measured(device(), parse_material("lambert"), "tensor-tree", path(), {.progress = stop}),
               Cancelled);
  BrdfFunction odd;
  odd.name = "odd";
  odd.channels = {"value"};
  odd.at = [](std::span<const Directions> pairs) {
    BrdfValues values;
    values.value.setConstant(static_cast<Eigen::Index>(pairs.size()), 1, std::nan(""));
    return values;
  };
  EXPECT_THROW(save_measured(device(), odd, "tensor-tree", path()), NumericError);
  EXPECT_FALSE(fs::exists(path()));
}

}  // namespace
}  // namespace lobe::test
