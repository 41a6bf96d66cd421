// The BRDF format of the project BiRD: files written by the test, in both layouts, and files read by a general parser.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "lobe/core/error.hpp"
#include "lobe/formats/measured.hpp"
#include "lobe/formats/measurement.hpp"
#include "support/device.hpp"
#include "support/functions.hpp"
#include "support/temporary_directory.hpp"

namespace lobe::test {
namespace {

namespace fs = std::filesystem;
using std::numbers::pi;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Json = nlohmann::ordered_json;

std::vector<Directions> goniometer_pairs() {
  std::vector<Directions> pairs;
  for (int i = 0; i < 24; ++i) {
    pairs.push_back({(5 + 10 * (i % 8)) * kDegree, (10 + 25 * (i / 8)) * kDegree, (180 - 7 * i) * kDegree, 0});
  }
  return pairs;
}

/// Columns of points for light of azimuth 20 degrees.
/// \param values of each pair at 550 and 0.65 micrometres
Json columns_of(const std::vector<Directions>& pairs, double values(const Directions&)) {
  Json data;
  for (const char* name : {"theta_i", "phi_i", "theta_r", "phi_r"}) data[name]["unit"] = "°";
  data["theta_r"]["unit"] = "rad";
  data["wavelength_i"]["unit"] = "nm";
  data["BRDF"]["unit"] = "sr^-1";
  for (const double wavelength : {650, 550}) {
    for (const Directions& pair : pairs) {
      data["wavelength_i"]["values"].push_back(wavelength);
      data["theta_i"]["values"].push_back(to_degrees(pair.theta_in));
      data["phi_i"]["values"].push_back(20);
      data["theta_r"]["values"].push_back(pair.theta_out);
      data["phi_r"]["values"].push_back(to_degrees(pair.delta_phi) + 20);
      data["BRDF"]["values"].push_back(wavelength / 550 * values(pair));
    }
  }
  return data;
}

class BirdFiles : public ::testing::Test {
 protected:
  [[nodiscard]] fs::path path() const { return directory_.path() / "sample.brdf"; }
  [[nodiscard]] BrdfFunction read(const Json& data, const ReadOptions& options = {}) const {
    std::ofstream(path()) << Json{{"metadata", {{"type", "BRDF"}}}, {"data", data}}.dump(1);
    return load_measured(path(), options);
  }
  void expect_refusal(const Json& data, const std::string& complaint) const {
    try {
      (void)read(data);
      FAIL() << "not refused; expected '" << complaint << "'";
    } catch (const IoError& error) {
      EXPECT_THAT(error.what(), HasSubstr(complaint));
    }
  }

 private:
  TemporaryDirectory directory_;
};

TEST_F(BirdFiles, HoldAColumnForEachVariable) {
  const auto pairs = goniometer_pairs();
  const auto brdf = read(columns_of(pairs, glossy_at));
  EXPECT_THAT(brdf.channels, ElementsAre("550 nm", "650 nm"));
  EXPECT_EQ(brdf.wavelengths, (std::vector<double>{550, 650}));
  EXPECT_TRUE(brdf.is_isotropic);
  EXPECT_FALSE(brdf.has_deviations);
  for (const Directions& pair : pairs) {
    const auto values = brdf.at(std::vector<Directions>{pair}).value;
    EXPECT_NEAR(values(0, 0), glossy_at(pair), 1e-9) << pair.theta_in;  // asinh and back
    EXPECT_NEAR(values(0, 1), 650.0 / 550 * glossy_at(pair), 1e-9) << pair.theta_in;
  }
}

// The scatter of 100 replicates is off by 7 % (one standard deviation); here up to 5 of them.
TEST_F(BirdFiles, StateStandardUncertainties) {
  constexpr double kScatter = 0.35;
  const auto pairs = goniometer_pairs();
  const auto expect = [&](const Json& data, double (*deviation)(const Directions&)) {
    const auto brdf = read(data, {.replicates = 100});
    ASSERT_TRUE(brdf.has_deviations);
    const auto found = measurement_deviations(brdf, brdf.at(pairs).value);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      EXPECT_NEAR(found[0][i] / deviation(pairs[i]), 1, kScatter) << i;
    }
  };
  Json of_points = columns_of(pairs, glossy_at);
  of_points["uBRDF"] = {{"unit", "1/sr"}, {"comments", "expanded"}};
  for (std::size_t k = 0; k < 2; ++k) {
    for (const auto& pair : pairs) of_points["uBRDF"]["values"].push_back(0.001 + 0.01 * pair.theta_in);
  }
  expect(of_points, [](const Directions& pair) { return 0.001 + 0.01 * pair.theta_in; });
  EXPECT_THAT(read(of_points).remarks, Contains("comment of uBRDF: expanded"));
  Json of_all = columns_of(pairs, glossy_at);
  of_all["BRDF"]["uncertainty"] = {{"value", 0.5}, {"unit", "%"}};
  expect(of_all, [](const Directions& pair) { return 0.005 * glossy_at(pair); });
}

TEST_F(BirdFiles, AverageThePolarizationsOfTheLight) {
  const auto pairs = goniometer_pairs();
  Json data = columns_of(pairs, glossy_at);
  const std::size_t count = data["BRDF"]["values"].size();
  data["polarization_i"] = {{"notation", "inStokes"}};
  for (std::size_t i = 0; i < count; ++i) data["polarization_i"]["values"].push_back({1, 1, 0, 0});
  EXPECT_THAT(read(data).remarks, Contains("light of the polarization [1, 1, 0, 0]"));
  // p has three times the reflectance of s.
  for (auto& [name, column] : data.items()) {
    const auto once = column["values"];
    for (std::size_t i = 0; i < count; ++i) {
      Json next = once[i];
      if (name == "BRDF") next = 3 * next.get<double>();
      if (name == "polarization_i") next = {1, -1, 0, 0};
      column["values"].push_back(next);
    }
  }
  data["BRDF"]["uncertainty"] = {{"value", 0.002}, {"unit", "sr^-1"}};
  const std::vector<Directions> first{pairs.front()};
  const double s = glossy_at(pairs.front());
  EXPECT_NEAR(read(data).at(first).value(0, 0), 2 * s, 1e-9);
  EXPECT_NEAR(read(data, {.component = "s"}).at(first).value(0, 0), s, 1e-9);
  EXPECT_NEAR(read(data, {.component = "p"}).at(first).value(0, 0), 3 * s, 1e-9);
  EXPECT_THROW((void)read(data, {.component = "u"}), ArgumentError);
  const auto brdf = read(data, {.replicates = 100});
  // Half the root of two variances.
  EXPECT_NEAR(measurement_deviations(brdf, brdf.at(first).value)[0][0] / (0.002 / std::sqrt(2)), 1, 0.35);
  data["polarization_i"]["values"][3] = {1, 0, 0, 1};
  data["polarization_i"]["values"][count + 3] = {1, 0, 0, -1};
  EXPECT_EQ(read(data).channels.size(), 2U);  // circular ones are left out
}

TEST_F(BirdFiles, HadRowsAsDrafts) {
  const auto pairs = goniometer_pairs();
  const Json columns = columns_of(pairs, glossy_at);
  Json data;
  std::vector<std::string> names;
  for (const auto& [name, column] : columns.items()) {
    names.push_back(name);
    data["variables"].push_back(
        {{"name", name}, {"type", "number"}, {"unit", column["unit"]}, {"description", "here"}});
    if (name != "theta_r")
      data["variables"].back()["unit"] = name == "BRDF" ? "sr-1" : name == "wavelength_i" ? "nm" : "deg";
  }
  for (std::size_t i = 0; i < columns["BRDF"]["values"].size(); ++i) {
    Json row;
    for (const auto& name : names) row.push_back(columns[name]["values"][i]);
    data["values"].push_back(row);
  }
  const auto drafted = read(data);
  const auto brdf = read(columns);
  EXPECT_EQ(drafted.channels, brdf.channels);
  EXPECT_EQ(drafted.at(pairs).value, brdf.at(pairs).value);
  data["values"][5].push_back(1);
  expect_refusal(data, "a row of 7 numbers; expected 6");
}

TEST_F(BirdFiles, ThatAreDamagedAreRefused) {
  const auto changed = [](const char* name, const char* key, const Json& value) {
    Json data = columns_of(goniometer_pairs(), glossy_at);
    data[name][key] = value;
    return data;
  };
  Json data = columns_of(goniometer_pairs(), glossy_at);
  data.erase("phi_r");
  expect_refusal(data, "there is no variable 'phi_r' of numbers");
  expect_refusal(changed("theta_i", "values", {1, 2}), "2 values of theta_i; expected 48, as many as of BRDF");
  expect_refusal(changed("theta_i", "unit", "grad"), "the unit of theta_i is 'grad'; expected rad, deg or °");
  expect_refusal(changed("theta_r", "unit", "deg\n"), "the unit of theta_r is 'deg\\x0a'");
  expect_refusal(changed("BRDF", "unit", "1"), "the unit of BRDF is '1'; expected 1/sr, sr^-1 or %");
  expect_refusal(changed("BRDF", "unit", "%"), "the unit of BRDF is '%'; expected 1/sr or sr^-1");
  expect_refusal(changed("wavelength_i", "unit", "m"), "the unit of wavelength_i is 'm'; expected nm or μm");
  data = columns_of(goniometer_pairs(), glossy_at);
  data["theta_i"]["values"][7] = -5;
  expect_refusal(data, "theta_i of -5 °; expected 0 to 90 degrees");
  data = columns_of(goniometer_pairs(), glossy_at);
  data["theta_i"]["values"][7] = "x";
  expect_refusal(data, "'x' among the values of theta_i; expected numbers, or texts alone");
  data = columns_of(goniometer_pairs(), glossy_at);
  data["wavelength_r"] = data["wavelength_i"];
  data["wavelength_r"]["values"][0] = 700;
  expect_refusal(data, "it fluoresces");
  data = columns_of(goniometer_pairs(), glossy_at);
  data["adhoc_variables"]["spot"] = {{"unit", "mm"}, {"values", std::vector<double>(48, 2)}};
  EXPECT_EQ(read(data).channels.size(), 2U);
  data["adhoc_variables"]["spot"]["values"][3] = 4;
  expect_refusal(data, "the variable 'adhoc_variables/spot' varies");
  data = columns_of(goniometer_pairs(), glossy_at);
  data["uBRDF"] = {{"unit", "%"}, {"values", std::vector<double>(48, -1)}};
  expect_refusal(data, "an uncertainty of -1; expected 0 or more");
  expect_refusal({{"BRDF", {{"unit", "1/sr"}, {"values", {1}}}}}, "there is no variable 'theta_i'");
}

TEST_F(BirdFiles, AreWrittenAsTheSchemaSays) {
  BrdfFunction brdf = glossy_function({"905 nm", "550 nm"});
  brdf.wavelengths = {905, 550};
  save_measured(device(), brdf, "bird", path(), {.command_line = "lobe export\nglossy"});
  const auto json = Json::parse(std::ifstream(path()));
  for (const char* required : {"schema", "id", "type", "timestamp", "provenance", "method", "instrumentation",
                               "software", "sample", "environment"}) {
    EXPECT_TRUE(json["metadata"].contains(required)) << required;
  }
  EXPECT_EQ(json["metadata"]["type"], "BRDF");
  EXPECT_EQ(json["metadata"]["sample"]["properties_symmetry"], "isotropic");
  const auto& data = json["data"];
  const auto column = [&](const char* name) { return data[name]["values"].get<std::vector<double>>(); };
  const auto theta_i = column("theta_i");
  const auto phi_i = column("phi_i");
  const auto theta_r = column("theta_r");
  const auto phi_r = column("phi_r");
  const auto wavelength = column("wavelength_i");
  const auto values = column("BRDF");
  EXPECT_FALSE(data.contains("uBRDF"));
  for (const char* name : {"theta_i", "phi_i", "theta_r", "phi_r", "wavelength_i"}) {
    ASSERT_EQ(data[name]["values"].size(), values.size()) << name;
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    EXPECT_TRUE(theta_i[i] >= 0 && theta_i[i] < 90 && theta_r[i] >= 0 && theta_r[i] < 90) << i;
    EXPECT_TRUE(phi_i[i] == 0 && phi_r[i] >= 0 && phi_r[i] < 360) << i;
    const Directions pair{theta_i[i] * kDegree, theta_r[i] * kDegree, phi_r[i] * kDegree, 0};
    // Angles are rounded to a billionth of a degree; slopes are below 10 sr^-1.
    EXPECT_NEAR(values[i], (wavelength[i] == 550 ? 2 : 1) * glossy_at(pair), 1e-9) << i;
  }
}

TEST_F(BirdFiles, TakeTheScatterOfReplicatesForUncertainties) {
  BrdfFunction brdf = glossy_function({"value"});
  brdf.replicates = 20;
  brdf.at = [](std::span<const Directions> pairs) {
    BrdfValues found{Eigen::MatrixXd(static_cast<Eigen::Index>(pairs.size()), 21), {}};
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      auto row = found.value.row(static_cast<Eigen::Index>(i));
      row(0) = glossy_at(pairs[i]);
      for (Eigen::Index k = 1; k <= 20; ++k) row(k) = row(0) * (k % 2 == 0 ? 1.1 : 0.9);
    }
    return found;
  };
  for (int k = 1; k <= 20; ++k) brdf.channels.push_back("value, replicate " + std::to_string(k));
  save_measured(device(), brdf, "bird", path());
  const auto data = Json::parse(std::ifstream(path()))["data"];
  ASSERT_EQ(data["uBRDF"]["values"].size(), data["BRDF"]["values"].size());
  for (std::size_t i = 0; i < data["BRDF"]["values"].size(); ++i) {
    // Of ten times +0.1 and ten times -0.1.
    const double expected = 0.1 * std::sqrt(20.0 / 19) * data["BRDF"]["values"][i].get<double>();
    EXPECT_NEAR(data["uBRDF"]["values"][i].get<double>(), expected, 1e-12) << i;
  }
  EXPECT_TRUE(load_measured(path()).has_deviations);
}

TEST_F(BirdFiles, HoldAnisotropicReflectances) {
  BrdfFunction brdf = function_of([](const Directions& pair) {
    return 0.2 + 0.1 * std::cos(2 * pair.phi_in) * std::cos(2 * (pair.phi_in + pair.delta_phi)) *
                     std::sin(pair.theta_in) * std::sin(pair.theta_out);
  });
  brdf.is_isotropic = false;
  save_measured(device(), brdf, "bird", path());
  const auto data = Json::parse(std::ifstream(path()))["data"];
  double farthest = 0;
  for (std::size_t i = 0; i < data["BRDF"]["values"].size(); i += 7) {
    const auto angle = [&](const char* name) { return data[name]["values"][i].get<double>() * kDegree; };
    const Directions pair{angle("theta_i"), angle("theta_r"), angle("phi_r") - angle("phi_i"), angle("phi_i")};
    EXPECT_NEAR(data["BRDF"]["values"][i].get<double>(), brdf.at(std::vector{pair}).value(0, 0), 1e-9) << i;
    farthest = std::max(farthest, pair.phi_in);
  }
  EXPECT_GT(farthest, 300 * kDegree);
}

TEST_F(BirdFiles, RefuseWhatTheyDoNotHold) {
  EXPECT_THROW(save_measured(device(), glossy_function({"red", "green", "blue"}), "bird", path()), ArgumentError);
  EXPECT_THROW(save_measured(device(), function_of([](const Directions&) { return -1.0; }), "bird", path()),
               ArgumentError);
  EXPECT_THROW(save_measured(device(), function_of([](const Directions&) { return NAN; }), "bird", path()),
               NumericError);
  EXPECT_FALSE(fs::exists(path()));
}

}  // namespace
}  // namespace lobe::test
