// Klems matrices in the XML of WINDOW and Radiance: against an independent reading, by what is known of the materials,
// and damaged.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>

#include "energy/albedo.hpp"
#include "io/window_xml_cases.hpp"
#include "lobe/algebra/algebra.hpp"
#include "lobe/core/error.hpp"
#include "lobe/formats/measured.hpp"
#include "lobe/table/cell_error.hpp"
#include "metric/table_metric.hpp"
#include "support/device.hpp"
#include "support/measured_data.hpp"
#include "support/temporary_directory.hpp"
#include "table/as_function.hpp"
#include "table/evaluate.hpp"
#include "table/tabulate.hpp"

namespace lobe::test {
namespace {

namespace fs = std::filesystem;
using std::numbers::pi;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class KlemsData : public MeasuredData {
 protected:
  KlemsData() : MeasuredData("klems_measured") {}

  [[nodiscard]] fs::path fabric() const { return data_ / "klems_aniso_high.xml"; }
  [[nodiscard]] fs::path satine() const { return data_.parent_path() / "klems_derived/2011-SA1.XML"; }
};

class KlemsFile : public ::testing::Test {
 protected:
  BrdfFunction load(const std::string& text, const ReadOptions& options = {}) const {
    const fs::path path = directory_.path() / "file.xml";
    std::ofstream(path, std::ios::binary) << text;
    return load_measured(path, options);
  }
  void expect_refusal(const std::string& text, const std::string& complaint, const ReadOptions& options = {}) const {
    try {
      (void)load(text, options);
      FAIL() << "not refused; expected '" << complaint << "'";
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr(complaint));
      EXPECT_THAT(error.what(), HasSubstr("file.xml"));
    }
  }

  TemporaryDirectory directory_;
};

std::vector<Directions> klems_pairs() {
  std::vector<Directions> pairs;
  for (int i = 0; i < 20; ++i) pairs.push_back({0.02 + 0.077 * i, 1.5 - 0.07 * i, 0.31 * i - 3, 0.5 * i - 4});
  return pairs;
}

/// Of a matrix by rows of outgoing patches, as Radiance looks values up: by the patch that the light goes to.
double looked_up(const std::vector<double>& matrix, const KlemsPatches& patches, const Directions& pair) {
  const std::size_t incident = patches.find(pair.theta_in, pair.phi_in + pi);
  const std::size_t outgoing = patches.find(pair.theta_out, pair.phi_in + pair.delta_phi);
  return matrix.at(outgoing * patches.size() + incident);
}

/// |G - G^T| / |G|, weighted by projected solid angles; rows of G may be exchanged.
template <typename Row>
double asymmetry(const BrdfTable& table, const Row& row) {
  const std::size_t n = table.grid.nodes();
  double difference = 0;
  double all = 0;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      const double weight = table.grid.weights()[i] * table.grid.weights()[j];
      const double value = table.values[row(i) * n + j];
      difference += weight * std::pow(value - table.values[row(j) * n + i], 2);
      all += weight * value * value;
    }
  }
  return std::sqrt(difference / all);
}
double asymmetry(const BrdfTable& table) {
  return asymmetry(table, [](std::size_t i) { return i; });
}
double asymmetry_of_the_file(const BrdfTable& table) {
  return asymmetry(table, [&](std::size_t i) { return table.grid.opposite(i); });
}

TEST_F(KlemsData, FabricHasTheValuesOfAnIndependentReading) {
  const auto brdf = load_measured(fabric());
  const auto matrix = scattering_data(text_of(fabric()), "Visible", "Reflection Front");
  ASSERT_EQ(matrix.size(), 21025U);
  const auto values = brdf.at(klems_pairs()).value;
  for (std::size_t i = 0; i < 20; ++i) {
    EXPECT_EQ(values(static_cast<Eigen::Index>(i), 0), looked_up(matrix, klems_patches(145), klems_pairs()[i])) << i;
  }
  EXPECT_EQ(brdf.name, "Mecho_shade_fabric_6216-63__(LBL)");
  EXPECT_THAT(brdf.channels, ElementsAre("Visible"));
  EXPECT_FALSE(brdf.is_isotropic);
  EXPECT_TRUE(brdf.remarks.empty());
  EXPECT_EQ(brdf.cells->grid, HemisphereGrid::klems(145));
}

TEST_F(KlemsData, TurningIncidentDirectionsMakesThemReciprocal) {
  // Blinds and sawtooth were ray-traced, with noise; the other blinds computed.
  const auto blinds =
      load_measured(data_.parent_path() / "klems_computed/test_blinds_kf.xml", {.component = "Reflection Back"}).cells;
  EXPECT_LT(asymmetry(*blinds), 0.14);
  EXPECT_GT(asymmetry_of_the_file(*blinds), 1);
  const auto sawtooth = load_measured(data_.parent_path() / "klems_computed/sawtooth.xml").cells;
  EXPECT_LT(asymmetry(*sawtooth), 0.05);
  EXPECT_GT(asymmetry_of_the_file(*sawtooth), 1);
  for (const char* side : {"reflection front", "reflection back"}) {
    const auto venetian = load_measured(data_.parent_path() / "klems_computed/ven45.xml", {.component = side}).cells;
    // Six decimals.
    EXPECT_LT(asymmetry(*venetian), 1e-4) << side;
    EXPECT_GT(asymmetry_of_the_file(*venetian), 0.1) << side;
  }
}

TEST_F(KlemsData, FabricShinesOnTheMirrorSide) {
  // Turning it by 180 degrees changes it by 3 %, so that its reciprocity, of 13 %, says nothing of the directions of
  // incidence; its gloss at grazing angles does.
  const auto fabric_cells = load_measured(fabric(), {.component = "reflection back"}).cells;
  EXPECT_LT(asymmetry(*fabric_cells), 0.13);
  const std::size_t n = fabric_cells->grid.nodes();
  for (std::size_t in = n - 12; in < n; ++in) {
    const auto row = std::span(fabric_cells->values).subspan(in * n, n);
    EXPECT_EQ(std::ranges::max_element(row) - row.begin(), static_cast<int>(fabric_cells->grid.opposite(in))) << in;
  }
}

TEST_F(KlemsData, RankOneComposesAsItsFormula) {
  // f(L, V) = b(L) composed with itself: b(L) times the integral of b.
  const auto cells = load_measured(satine(), {.channels = {"visible"}}).cells;
  const std::size_t n = cells->grid.nodes();
  double integral = 0;
  for (std::size_t i = 0; i < n; ++i) integral += cells->grid.weights()[i] * cells->values[i * n];
  const BrdfTable composed = compose(device(), *cells, *cells);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      ASSERT_EQ(cells->values[i * n + j], cells->values[i * n]) << i << ' ' << j;
      const double expected = cells->values[i * n] * integral;
      ASSERT_NEAR(composed.values[i * n + j], expected, 1e-12 * expected) << i << ' ' << j;
    }
  }
}

TEST_F(KlemsData, BandsAreChannelsAndSidesAreChosenByName) {
  const auto front = load_measured(satine());
  EXPECT_THAT(front.channels, ElementsAre("Visible", "Solar"));
  EXPECT_EQ(front.cells->values[0], 0.153571);
  EXPECT_EQ(front.cells->channel(1)[0], 0.148154);
  const auto back = load_measured(satine(), {.channels = {"Solar"}, .component = "Reflection Back"});
  EXPECT_THAT(back.channels, ElementsAre("Solar"));
  EXPECT_EQ(back.at(std::vector<Directions>{{0, 0, 0, 0}}).value(0, 0), 0.167364);
  EXPECT_THAT(load_measured(data_.parent_path() / "klems_computed/sawtooth.xml").remarks,
              ElementsAre(HasSubstr("reflection back was taken")));
}

TEST_F(KlemsData, TransmissionsAreRefusedWithWhatTheFileHas) {
  for (const char* name : {"2011-SA1-Small-CommaSeparated", "2011-SA1-Small-TabSeparated",
                           "2011-SA1-Small-CommaSeparated-SingleColumnScattering"}) {
    SCOPED_TRACE(name);
    try {
      (void)load_measured(data_.parent_path() / "klems_computed" / (std::string(name) + ".XML"));
      FAIL() << name;
    } catch (const ArgumentError& error) {
      EXPECT_THAT(error.what(), HasSubstr("no reflection; it has Transmission Front, Transmission Back"));
    }
  }
}

TEST_F(KlemsData, MaterialsThatHaveNoNameOfTheirOwnAreCalledByTheirFile) {
  // genBSDF writes <Name>Name</Name>.
  EXPECT_EQ(load_measured(data_.parent_path() / "klems_computed/sawtooth.xml").name, "sawtooth");
  EXPECT_EQ(load_measured(data_.parent_path() / "klems_computed/blindsT3.xml").name, "blindsT3");
  EXPECT_EQ(load_measured(data_.parent_path() / "klems_computed/testBSDF.xml").name, "Bogus");
}

TEST_F(KlemsData, WrittenFilesReadBackAsTheSame) {
  const TemporaryDirectory directory;
  const auto brdf = load_measured(fabric());
  save_measured(device(), brdf, "klems", directory.path() / "copy.xml", {.command_line = "lobe export --format klems"});
  const auto copy = load_measured(directory.path() / "copy.xml");
  EXPECT_TRUE(copy.cells->values == brdf.cells->values);
  EXPECT_EQ(copy.name, brdf.name);
  EXPECT_EQ(copy.channels, brdf.channels);
  const auto back = load_measured(directory.path() / "copy.xml", {.component = "reflection back"});
  EXPECT_TRUE(back.cells->values == brdf.cells->values);
}

// --- As the operator that the file defines, constant on patches: exact sums.

/// The file's first reflection as a matrix by L and V, by an independent reading; |C| = sum of squares and so on follow
/// from it and the patches' projected solid angles.
struct KlemsMatrix {
  KlemsMatrix(const fs::path& path, const std::string& band, const std::string& direction) {
    const auto data = scattering_data(text_of(path), band, direction);
    const std::size_t n = patches.size();
    values.resize(n * n);
    for (std::size_t in = 0; in < n; ++in) {
      const Direction centre = HemisphereGrid::klems(145).directions()[in];
      const std::size_t column = patches.find(centre.theta, centre.phi + pi);
      for (std::size_t out = 0; out < n; ++out) values[in * n + out] = data.at(out * n + column);
    }
  }
  [[nodiscard]] double albedo(std::size_t in) const {
    double sum = 0;
    for (std::size_t out = 0; out < 145; ++out) sum += patches.solid_angle(out) * values[in * 145 + out];
    return sum;
  }
  [[nodiscard]] double distance(const std::vector<double>& other) const {
    double sum = 0;
    for (std::size_t k = 0; k < values.size(); ++k) {
      sum += patches.solid_angle(k / 145) * patches.solid_angle(k % 145) * std::pow(values[k] - other[k], 2);
    }
    return std::sqrt(sum);
  }

  KlemsPatches patches = klems_patches(145);
  std::vector<double> values;
};

TEST_F(KlemsData, AlbedosAreExactSumsOfTheColumns) {
  const fs::path path = data_.parent_path() / "klems_computed/sawtooth.xml";
  const KlemsMatrix matrix(path, "Visible", "Reflection Back");
  const BrdfTable table = *load_measured(path).cells;
  const std::vector<Direction> incident{{0, 0}, {0.5, 1}, {1.4, -2}};
  const auto found = albedo(table, incident).front();
  const auto cell_errors = albedo_cell_error(table, incident).front();
  for (std::size_t i = 0; i < incident.size(); ++i) {
    const double expected = matrix.albedo(matrix.patches.find(incident[i].theta, incident[i].phi));
    EXPECT_NEAR(found[i].value, expected, found[i].error) << i;
    EXPECT_LT(found[i].error, 1e-12) << i;
    // What a continuous reflectance may be is another question: neighbouring patches differ by multiples.
    EXPECT_GT(cell_errors[i], 0.05) << i;
  }
}

TEST_F(KlemsData, NormsAndDistancesAreExactSums) {
  const fs::path saw = data_.parent_path() / "klems_computed/sawtooth.xml";
  const KlemsMatrix sawtooth(saw, "Visible", "Reflection Back");
  const KlemsMatrix cloth(fabric(), "Visible", "Reflection Front");
  const std::vector<BrdfTable> tables{*load_measured(saw).cells, *load_measured(fabric()).cells};
  const auto between = distance(tables[0], tables[1], Lighting::point());
  EXPECT_NEAR(between.value, sawtooth.distance(cloth.values), between.error);
  EXPECT_LT(between.error, 1e-10);
  const auto square = scalar_product(tables[0], tables[0], Lighting::point());
  EXPECT_NEAR(std::sqrt(square.value), sawtooth.distance(std::vector<double>(21025)), square.error);
  EXPECT_LT(square.error, 1e-9 * square.value);

  double daylight = 0;
  for (std::size_t out = 0; out < 145; ++out) {
    double by_view = 0;
    for (std::size_t in = 0; in < 145; ++in) {
      by_view += sawtooth.patches.solid_angle(in) * sawtooth.values[in * 145 + out];
    }
    daylight += sawtooth.patches.solid_angle(out) * by_view * by_view;
  }
  const auto found = scalar_product(tables[0], tables[0], Lighting::daylight());
  EXPECT_NEAR(found.value, daylight, found.error);
  EXPECT_LT(found.error, 1e-11);
}

TEST_F(KlemsData, CompositionsAreExactProductsOfMatrices) {
  const fs::path saw = data_.parent_path() / "klems_computed/sawtooth.xml";
  const KlemsMatrix sawtooth(saw, "Visible", "Reflection Back");
  const auto twice = self_compose(test::device(), *load_measured(saw).cells);
  for (std::size_t k = 3; k < 21025; k += 997) {
    double expected = 0;
    for (std::size_t x = 0; x < 145; ++x) {
      expected +=
          sawtooth.values[k / 145 * 145 + x] * sawtooth.patches.solid_angle(x) * sawtooth.values[x * 145 + k % 145];
    }
    const std::size_t ring_in = twice.grid.ring_of(k / 145);
    const double error = twice.error[ring_in * 9 + twice.grid.ring_of(k % 145)];
    EXPECT_NEAR(twice.values[k], expected, error) << k;
    EXPECT_LT(error, 1e-11) << k;
  }
}

TEST(CellErrors, AreWhatNeighboursDifferBy) {
  // f = 1 + 0.1 times the number of V's ring: the rings beside differ by 0.1, albedos by half of it.
  BrdfTable table;
  table.grid = HemisphereGrid::klems(41);
  table.form = TableForm::general;
  table.values.resize(table.size());
  table.error.assign(25, 0.0);
  for (std::size_t at = 0; at < table.size(); ++at) {
    table.values[at] = 1 + 0.1 * static_cast<double>(table.grid.ring_of(at % 41));
  }
  EXPECT_NEAR(albedo_cell_error(table, std::vector<Direction>{{0.7, 2}}).front().front(), pi * 0.05, 1e-12);
  EXPECT_GT(cell_error(table).front(), 0.05 / 1.4);
  EXPECT_LT(cell_error(table).front(), 0.05);
  EXPECT_FALSE(is_constant_on_cells(tabulate(test::device(), parse_material("lambert"), HemisphereGrid::cells(3, 4))));
}

/// The words of the n-th block with a direction.
std::vector<std::string> printed(const std::string& xml, const std::string& direction) {
  const std::size_t begin = xml.find("<ScatteringData>", xml.find(direction)) + 16;
  std::string text = xml.substr(begin, xml.find('<', begin) - begin);
  std::ranges::replace(text, ',', ' ');
  std::istringstream stream(text);
  return {std::istream_iterator<std::string>(stream), {}};
}

TEST_F(KlemsData, WrittenFilesHaveThePrintedDigits) {
  const TemporaryDirectory directory;
  save_measured(device(), load_measured(satine()), "klems", directory.path() / "copy.xml");
  const auto original = printed(text_of(satine()), "Reflection Front");
  const auto copy = printed(text_of(directory.path() / "copy.xml"), "Reflection Front");
  ASSERT_EQ(copy.size(), original.size());
  for (std::size_t i = 0; i < 20; ++i) {
    SCOPED_TRACE(i);
    // The original has six decimals, whatever they are.
    std::string digits = original[i * 1051];
    digits.erase(digits.find_last_not_of('0') + 1);
    EXPECT_EQ(copy[i * 1051], digits);
  }
}

// --- Files by a writer of the test's own.

/// value(o, i) as a matrix by rows of outgoing patches.
template <typename Value>
std::string matrix_text(std::size_t n, const Value& value, const std::string& separator = " ",
                        const std::string& end = "\n") {
  std::ostringstream text;
  text.precision(17);
  for (std::size_t row = 0; row < n; ++row) {
    for (std::size_t column = 0; column < n; ++column) {
      text << value(row, column) << (column + 1 == n ? end : separator);
    }
  }
  return text.str();
}

double some_value(std::size_t o, std::size_t i) {
  return 0.01 * static_cast<double>(o) + 1e-5 * static_cast<double>(i * i) + 0.125;
}

const std::string kColumns = "<IncidentDataStructure>Columns</IncidentDataStructure>";

std::string angle_basis(const std::string& name, const KlemsPatches& patches) {
  std::ostringstream text;
  text << "<AngleBasis>";
  for (std::size_t ring = 0; ring < patches.counts.size(); ++ring) {
    text << "<AngleBasisBlock><nPhis>" << patches.counts[ring] << "</nPhis><ThetaBounds><UpperTheta>"
         << patches.limits_deg[ring + 1] << "</UpperTheta><LowerTheta>" << patches.limits_deg[ring]
         << "</LowerTheta></ThetaBounds></AngleBasisBlock>\n";
  }
  text << "<AngleBasisName>" << name << "</AngleBasisName></AngleBasis>";
  return text.str();
}

struct BasisCase {
  int patches;
  const char* name;
};

class KlemsBasis : public KlemsFile, public ::testing::WithParamInterface<BasisCase> {};

INSTANTIATE_TEST_SUITE_P(all, KlemsBasis,
                         ::testing::Values(BasisCase{145, "Full"}, BasisCase{77, "Half"}, BasisCase{73, "Half"},
                                           BasisCase{41, "Quarter"}),
                         [](const auto& test) { return "of" + std::to_string(test.param.patches); });

TEST_P(KlemsBasis, IsFoundByTheNumberOfValuesOrByItsRings) {
  const KlemsPatches patches = klems_patches(GetParam().patches);
  const std::size_t n = patches.size();
  const XmlBlock block{.bases = klems_bases(GetParam().name), .data = matrix_text(n, some_value)};
  const auto by_number = load(window_xml(kColumns, {block}));
  const auto by_rings =
      load(window_xml(angle_basis("LBNL/Klems " + std::string(GetParam().name), patches) + kColumns, {block}));
  EXPECT_EQ(by_number.cells->grid, HemisphereGrid::klems(n));
  EXPECT_TRUE(by_number.cells->values == by_rings.cells->values);
  std::vector<double> matrix;
  for (std::size_t o = 0; o < n; ++o) {
    for (std::size_t i = 0; i < n; ++i) matrix.push_back(some_value(o, i));
  }
  const auto values = by_number.at(klems_pairs()).value;
  for (std::size_t i = 0; i < 20; ++i) {
    EXPECT_EQ(values(static_cast<Eigen::Index>(i), 0), looked_up(matrix, patches, klems_pairs()[i])) << i;
  }
}

TEST_P(KlemsBasis, IsWrittenAndReadBack) {
  const std::size_t n = klems_patches(GetParam().patches).size();
  const auto brdf = load(window_xml(
      kColumns, {{.bases = klems_bases(GetParam().name), .data = matrix_text(n, some_value)},
                 {.band = "CIE-X", .bases = klems_bases(GetParam().name), .data = matrix_text(n, some_value)}}));
  save_measured(device(), brdf, "klems", directory_.path() / "copy.xml");
  const auto copy = load_measured(directory_.path() / "copy.xml");
  EXPECT_EQ(copy.cells->grid, brdf.cells->grid);
  EXPECT_TRUE(copy.cells->values == brdf.cells->values);
  EXPECT_THAT(copy.channels, ElementsAre("Visible", "CIE-X"));
  EXPECT_EQ(copy.name, "Cloth & co");
}

TEST_F(KlemsFile, WithOtherSeparatorsAreTheSame) {
  const auto with = [&](const std::string& separator, const std::string& end) {
    return load(
        window_xml(kColumns, {{.bases = klems_bases("Quarter"), .data = matrix_text(41, some_value, separator, end)}}));
  };
  const auto expected = with(" ", "\n").cells->values;
  EXPECT_TRUE(with("\t", "\t\n").cells->values == expected);
  EXPECT_TRUE(with(",", ",").cells->values == expected);
  EXPECT_TRUE(with(",   ", ",\r\n  ").cells->values == expected);
  EXPECT_TRUE(with("\n", "\n\n").cells->values == expected);
  EXPECT_TRUE(with(" , ", "\n").cells->values == expected);
}

TEST_F(KlemsFile, ByRowsIsTheTransposed) {
  const auto transposed = [](std::size_t row, std::size_t column) { return some_value(column, row); };
  const auto columns =
      load(window_xml(kColumns, {{.bases = klems_bases("Quarter"), .data = matrix_text(41, some_value)}}));
  const auto rows = load(window_xml("<IncidentDataStructure>Rows</IncidentDataStructure>",
                                    {{.bases = klems_bases("Quarter"), .data = matrix_text(41, transposed)}}));
  EXPECT_TRUE(rows.cells->values == columns.cells->values);
}

TEST_F(KlemsFile, ElementsMayComeInAnyOrder) {
  const std::string data = matrix_text(41, some_value);
  const auto usual = load(window_xml(kColumns, {{.bases = klems_bases("Quarter"), .data = data}}));
  const auto turned =
      load("<w:WindowElement><Optical><Layer><WavelengthData><WavelengthDataBlock><ScatteringData>" + data +
           "</ScatteringData>" + klems_bases("quarter") +
           "<WavelengthDataDirection> reflection\n FRONT </WavelengthDataDirection></WavelengthDataBlock><Wavelength "
           "unit='nanometer'>550</Wavelength></WavelengthData><DataDefinition>" +
           kColumns + "</DataDefinition></Layer></Optical></w:WindowElement>");
  EXPECT_TRUE(turned.cells->values == usual.cells->values);
  EXPECT_THAT(turned.channels, ElementsAre("550 nm"));
  EXPECT_THAT(turned.wavelengths, ElementsAre(550));
  EXPECT_EQ(turned.name, "file");
}

TEST_F(KlemsFile, InUtf16IsRead) {
  const std::string text =
      window_xml(kColumns, {{.bases = klems_bases("Quarter"), .data = matrix_text(41, some_value)}});
  std::string wide = "\xFF\xFE";
  for (const char c : text.substr(text.find('\n') + 1)) wide += {c, '\0'};
  EXPECT_TRUE(load(wide).cells->values == load(text).cells->values);
}

TEST_F(KlemsFile, MirrorsInItsConventionAreMirrors) {
  // Light that is not turned: the same patch, in the convention of the file. Its mirror is the dissertation's (1.29).
  const KlemsPatches patches = klems_patches(41);
  const auto mirror = [&](std::size_t o, std::size_t i) {
    return o == i ? (0.5 + 0.01 * static_cast<double>(i)) / patches.solid_angle(o) : 0.0;
  };
  const auto brdf = load(window_xml(kColumns, {{.bases = klems_bases("Quarter"), .data = matrix_text(41, mirror)}}));
  const BrdfTable& table = *brdf.cells;
  EXPECT_THAT(brdf.remarks, ElementsAre(HasSubstr("delta parts")));
  EXPECT_TRUE(table.retro.empty());
  ASSERT_EQ(table.mirror.size(), 41U);
  for (std::size_t in = 0; in < 41; ++in) {
    const double expected = 0.5 + 0.01 * static_cast<double>(table.grid.opposite(in));
    EXPECT_NEAR(table.mirror[in], expected, 1e-14) << in;
  }
  for (const double value : table.values) EXPECT_EQ(value, 0);
  // Two mirrors are a retro-reflector.
  const BrdfTable twice = compose(device(), table, table);
  EXPECT_NEAR(twice.retro[3], table.mirror[3] * table.mirror[table.grid.opposite(3)], 1e-14);
  for (const double factor : twice.mirror) EXPECT_EQ(factor, 0);
}

TEST_F(KlemsFile, RetroReflectorsInItsConventionAreRetroReflectors) {
  const KlemsPatches patches = klems_patches(41);
  const auto retro = [&](std::size_t o, std::size_t i) {
    const double theta = o < 1 ? 0 : o < 9 ? 18 : o < 21 ? 36 : o < 33 ? 56 : 78;
    const int count = o < 1 ? 1 : o < 9 ? 8 : o < 21 ? 12 : o < 33 ? 12 : 8;
    const int first = o < 1 ? 0 : o < 9 ? 1 : o < 21 ? 9 : o < 33 ? 21 : 33;
    const double phi = 2 * pi * (static_cast<double>(o) - first) / count;
    return i == patches.find(theta * pi / 180, phi + pi) ? 0.75 / patches.solid_angle(o) : 0.0;
  };
  const auto brdf = load(window_xml(kColumns, {{.bases = klems_bases("Quarter"), .data = matrix_text(41, retro)}}));
  EXPECT_TRUE(brdf.cells->mirror.empty());
  for (const double factor : brdf.cells->retro) EXPECT_NEAR(factor, 0.75, 1e-14);
  for (const double value : brdf.cells->values) EXPECT_EQ(value, 0);
}

TEST_F(KlemsFile, DeltaPartsAreWrittenAndReadBack) {
  BrdfTable table;
  table.grid = HemisphereGrid::klems(73);
  table.form = TableForm::general;
  table.values.assign(73 * 73, 0.0);
  table.error.assign(7 * 7, 0.0);
  for (int i = 0; i < 73; ++i) {
    table.mirror.push_back(0.5 + 0.001 * i);
    // At the normal both are the same direction, and read as a mirror.
    table.retro.push_back(i == 0 ? 0 : 0.25);
  }
  save_measured(device(), as_function(table), "klems", directory_.path() / "delta.xml");
  const auto read = load_measured(directory_.path() / "delta.xml");
  EXPECT_THAT(read.channels, ElementsAre("Visible"));
  for (std::size_t i = 0; i < 73; ++i) {
    EXPECT_NEAR(read.cells->mirror[i], table.mirror[i], 1e-15) << i;
    EXPECT_NEAR(read.cells->retro[i], table.retro[i], 1e-15) << i;
  }
}

TEST_F(KlemsFile, AMirrorBesideOtherValuesStaysAnAverage) {
  const auto both = [](std::size_t o, std::size_t i) { return (o == i ? 5.0 : 0.0) + (o == 3 && i == 17 ? 0.1 : 0.0); };
  const auto brdf = load(window_xml(kColumns, {{.bases = klems_bases("Quarter"), .data = matrix_text(41, both)}}));
  EXPECT_FALSE(brdf.cells->has_delta());
  // Its peak lies on the mirror side.
  const auto values = brdf.at(std::vector<Directions>{{0.6, 0.6, pi, 0.2}, {0.6, 0.6, 0, 0.2}}).value;
  EXPECT_EQ(values(0, 0), 5);
  EXPECT_EQ(values(1, 0), 0);
}

TEST_F(KlemsFile, NegativeValuesAreKeptAndCounted) {
  const auto negative = [](std::size_t o, std::size_t i) { return o == 2 && i < 3 ? -0.5 : 0.25; };
  const auto brdf = load(window_xml(kColumns, {{.bases = klems_bases("Quarter"), .data = matrix_text(41, negative)}}));
  EXPECT_THAT(brdf.remarks, ElementsAre("3 of 1681 values are negative, and kept"));
  EXPECT_EQ(std::ranges::count(brdf.cells->values, -0.5), 3);
}

/// A file with the same numbers in front and back.
std::string two_sided(const std::string& front, const std::string& back, const std::string& transmission) {
  const auto block = [](const char* direction, const std::string& data) {
    return XmlBlock{.direction = direction, .bases = klems_bases("Quarter"), .data = data};
  };
  return window_xml(kColumns, {block("Transmission Front", transmission), block("Reflection Front", front),
                               block("Reflection Back", back)});
}

TEST_F(KlemsFile, WithTransmissionsAndReflectancesOfZerosIsNotReadAsBlack) {
  const std::string values = matrix_text(41, some_value);
  const std::string zeros = matrix_text(41, [](std::size_t, std::size_t) { return "-0.000e+00"; });
  expect_refusal(two_sided(zeros, zeros, values), "holds transmission only: its reflectances are 0 everywhere");
  const auto asked = load(two_sided(zeros, zeros, values), {.component = "reflection front"});
  EXPECT_THAT(asked.remarks, ElementsAre("reflection front is 0 everywhere"));
  EXPECT_EQ(asked.cells->values[0], 0);
  const auto front = load(two_sided(zeros, values, values));
  EXPECT_THAT(front.remarks, ElementsAre("reflection front is 0 everywhere; reflection back is not"));
  EXPECT_EQ(front.cells->values[0], 0);
  // Something that absorbs all light.
  EXPECT_THAT(load(two_sided(zeros, zeros, zeros)).remarks, ElementsAre("reflection front is 0 everywhere"));
  EXPECT_TRUE(load(two_sided(values, zeros, values)).remarks.empty());
}

TEST_F(KlemsFile, ABandWithoutTheComponentIsNamed) {
  const std::string data = matrix_text(41, some_value);
  const auto brdf = load(window_xml(
      kColumns, {{.bases = klems_bases("Quarter"), .data = data},
                 {.direction = "Reflection Back", .band = "Solar", .bases = klems_bases("Quarter"), .data = data}}));
  EXPECT_THAT(brdf.channels, ElementsAre("Visible"));
  EXPECT_THAT(brdf.remarks, ElementsAre("'Solar' has no reflection front and is left out"));
}

// XML has no escapes, but the control characters of ISO 8859-1, which terminals obey as well.
TEST_F(KlemsFile, NamesWithControlCharactersAreRefused) {
  const std::string data = matrix_text(41, some_value);
  const XmlBlock good{.bases = klems_bases("Quarter"), .data = data};
  std::string named = window_xml(kColumns, {good});
  named.replace(named.find("Cloth"), 5, "Cloth&#x9b;2J");
  expect_refusal(named, "its name 'Cloth\\x9b2J & co' has control characters");
  XmlBlock band = good;
  band.band = "Vis&#x9b;2J";
  expect_refusal(window_xml(kColumns, {band}), "the channel 'Vis\\x9b2J' has control characters");
  band.direction = "Reflection Back";
  expect_refusal(window_xml(kColumns, {good, band}),
                 "what is said of it, ''Vis\\x9b2J' has no reflection front and is...' has control");
}

TEST_F(KlemsFile, FunctionsAreWrittenAsAveragesOverPatches) {
  BrdfFunction brdf;
  brdf.name = "a <lobe> & \"more\" -- here";
  brdf.channels = {"red", "value"};
  brdf.at = [](std::span<const Directions> pairs) {
    BrdfValues values;
    values.value.resize(static_cast<Eigen::Index>(pairs.size()), 2);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const Directions& pair = pairs[i];
      const auto row = static_cast<Eigen::Index>(i);
      values.value(row, 0) = 0.2 - 0.1 * std::sin(pair.theta_in) * std::sin(pair.theta_out) * std::cos(pair.delta_phi);
      values.value(row, 1) = 0.3;
    }
    return values;
  };
  const fs::path path = directory_.path() / "function.xml";
  save_measured(device(), brdf, "klems", path, {.command_line = "lobe export --format=klems -- x"});
  const auto read = load_measured(path);
  EXPECT_EQ(read.name, brdf.name);
  EXPECT_THAT(read.channels, ElementsAre("red", "value"));
  const auto values = read.at(std::vector<Directions>{{0.7, 0.7, pi, 1}, {0.7, 0.7, 0, 1}}).value;
  // Patches of 10 degrees.
  EXPECT_NEAR(values(0, 0), 0.2 + 0.1 * std::pow(std::sin(0.7), 2), 0.01);
  EXPECT_NEAR(values(1, 0), 0.2 - 0.1 * std::pow(std::sin(0.7), 2), 0.01);
  EXPECT_NEAR(values(0, 1), 0.3, 1e-14);  // a mean of 256 numbers
}

TEST_F(KlemsFile, OneChannelWithoutANameOfItsOwnIsVisibleLight) {
  const auto wavelength_of = [&](const std::vector<std::string>& channels) {
    BrdfFunction brdf;
    brdf.name = "lambert";
    brdf.channels = channels;
    brdf.at = [count = static_cast<Eigen::Index>(channels.size())](std::span<const Directions> pairs) {
      return BrdfValues{Eigen::MatrixXd::Constant(static_cast<Eigen::Index>(pairs.size()), count, 0.3), {}};
    };
    const fs::path path = directory_.path() / (channels.front() + std::to_string(channels.size()) + ".xml");
    save_measured(device(), brdf, "klems", path);
    const std::string text = text_of(path);
    const std::string mark = "<Wavelength unit=\"Integral\">";
    const std::size_t begin = text.find(mark) + mark.size();
    return text.substr(begin, text.find('<', begin) - begin);
  };
  EXPECT_EQ(wavelength_of({"value"}), "Visible");
  EXPECT_EQ(wavelength_of({"luminance"}), "Visible");
  EXPECT_EQ(wavelength_of({"gloss"}), "gloss");
  EXPECT_EQ(wavelength_of({"value", "gloss"}), "value");
}

TEST_F(KlemsFile, WhatCannotBeWrittenIsRefused) {
  BrdfTable table;
  table.grid = HemisphereGrid::cells(2, 4);
  table.form = TableForm::general;
  table.values.assign(64, 0.1);
  table.error.assign(4, 0.0);
  table.mirror.assign(8, 0.5);
  EXPECT_THROW(save_measured(device(), as_function(table), "klems", directory_.path() / "x.xml"), ArgumentError);
  table.grid = HemisphereGrid::klems(41);
  table.values.assign(41 * 41, std::nan(""));
  table.error.assign(25, 0.0);
  table.mirror.clear();
  EXPECT_THROW(save_measured(device(), as_function(table), "klems", directory_.path() / "x.xml"), NumericError);
  EXPECT_FALSE(fs::exists(directory_.path() / "x.xml"));
}

TEST_F(KlemsFile, ThatIsDamagedIsRefusedWithItsPlace) {
  const std::string data = matrix_text(41, some_value);
  const XmlBlock good{.bases = klems_bases("Quarter"), .data = data};
  const auto with = [&](XmlBlock block) { return window_xml(kColumns, {std::move(block)}); };
  expect_refusal("<WindowElement", "line 1: it is no well-formed XML: unclosed token");
  expect_refusal("<Other><WindowElement/></Other>", "line 1: the root is 'Other'; expected WindowElement");
  expect_refusal("<WindowElement></WindowElement>", "line 1: IncidentDataStructure ''; expected Columns or Rows");
  expect_refusal(window_xml("<IncidentDataStructure>Diagonals</IncidentDataStructure>", {good}), "'Diagonals'");
  expect_refusal(window_xml(kColumns, {}), "no reflection; it has no data at all");
  expect_refusal(with({.direction = "Transmission Back", .bases = klems_bases("Quarter"), .data = data}),
                 "no reflection; it has Transmission Back");
  expect_refusal(with(good), "no reflection back; it has Reflection Front", {.component = "Reflection Back"});
  expect_refusal(with(good), "is no reflectance; expected reflection front or reflection back",
                 {.component = "transmission front"});
  expect_refusal(with({.bases = klems_bases("Quarter"), .data = "1, 2, 3"}),
                 "line 8: ScatteringData of 3 numbers; expected 1681 (41 x 41)");
  expect_refusal(with({.bases = klems_bases("Half"), .data = data}),
                 "ScatteringData of 1681 numbers; expected 5929 (77 x 77) or 5329 (73 x 73)");
  expect_refusal(with({.bases = klems_bases("Tiny"), .data = data}), "unknown angle basis 'LBNL/Klems Tiny'");
  expect_refusal(with({.bases = "", .data = data}), "unknown angle basis ''");
  expect_refusal(with({.bases = "<ColumnAngleBasis>LBNL/Klems Full</ColumnAngleBasis>", .data = data}),
                 "expected the same basis");
  expect_refusal(window_xml(angle_basis("Mine", {{0, 30, 90}, {1, 8}}) + kColumns,
                            {{.bases = "<ColumnAngleBasis>Mine</ColumnAngleBasis><RowAngleBasis>Mine</RowAngleBasis>",
                              .data = data}}),
                 "the rings of 'Mine' are not those of LBNL/Klems Full, Half or Quarter");
  expect_refusal(with({.bases = klems_bases("Quarter"), .data = "x" + data}), "line 8: 'x0.125' is no finite number");
  expect_refusal(with({.bases = klems_bases("Quarter"), .data = "\n\n0 nan" + data.substr(data.find(' ', 8))}),
                 "line 10: 'nan' is no finite number");
  expect_refusal(with({.bases = klems_bases("Quarter"), .data = std::string(100, '1')}),
                 "a word too long for a number");
  expect_refusal(with({.bases = klems_bases("Quarter"), .data = data, .type = "Fractional Diffuse"}),
                 "ScatteringDataType 'Fractional Diffuse'; expected values in sr^-1");
  std::string empty = with(good);
  const auto begin = empty.find("<ScatteringData>");
  empty.erase(begin, empty.find("</ScatteringData>") + std::string("</ScatteringData>").size() - begin);
  expect_refusal(empty, "line 7: reflection front of 'Visible' has no ScatteringData");
  expect_refusal(window_xml(kColumns, {good, good}), "a second reflection front of 'Visible'");
  expect_refusal(
      window_xml(kColumns,
                 {good, {.band = "Solar", .bases = klems_bases("Full"), .data = matrix_text(145, some_value)}}),
      "'Solar' is on another angle basis");
  expect_refusal(with({.bases = klems_bases("Quarter"), .data = "<b>1</b>"}), "an element within ScatteringData");
}

TEST_F(KlemsFile, ThatIsABombIsRefused) {
  expect_refusal(
      "<!DOCTYPE WindowElement [<!ENTITY a \"aaaa\"><!ENTITY b \"&a;&a;\">]><WindowElement>&b;</WindowElement>",
      "document type (DOCTYPE)");
  std::string deep = "<WindowElement>";
  for (int i = 0; i < 100000; ++i) deep += "<a>";
  expect_refusal(deep, "line 1: more than 32 elements in each other");
  expect_refusal("<WindowElement>" + std::string(5'000'000, '<'), "no well-formed XML");
  expect_refusal("<WindowElement><a b='" + std::string(8'000'000, 'x'), "a mark of more than two megabytes");
  std::string many = "<WindowElement>";
  for (int i = 0; i < 5000; ++i) many += "<WavelengthDataBlock/>";
  expect_refusal(many, "more than 1024 WavelengthDataBlocks");
}

TEST_F(KlemsFile, ThatIsCutOrHasChangedBytesGivesOneLine) {
  const std::string text =
      window_xml(angle_basis("LBNL/Klems Quarter", klems_patches(41)) + kColumns,
                 {{.bases = klems_bases("Quarter"), .data = matrix_text(41, [](auto, auto) { return 0.5; })}});
  expect_robust(text, 53, [&](const std::string& damaged) { (void)load(damaged); });
}

}  // namespace
}  // namespace lobe::test
