// BRDF lookup tables of ASAM OpenMATERIAL 3D (.xompt), a row for each wavelength and pair of directions.
// Source: ASAM OpenMATERIAL 3D 1.1.0, section 8, schemas/material_brdf_schema.json, and its examples. The azimuth is
// that of the viewer from the light's, both as seen from the surface's point, for angles are from the normal.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <tuple>

#include "core/text.hpp"
#include "core/uuid.hpp"
#include "formats/format.hpp"
#include "formats/json_walk.hpp"
#include "formats/spectral_rows.hpp"
#include "formats/specular_frame.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"

namespace lobe {
namespace {

constexpr double kHorizon = std::numbers::pi / 2 + 1e-5;  // angles may have six digits
constexpr std::string_view kSchema =
    "https://raw.githubusercontent.com/asam-ev/OpenMATERIAL-3D/refs/tags/v1.1.0/schemas/material_brdf_schema.json";
constexpr double kLargestAzimuth = 6.283185;  // of the schema
constexpr std::array<std::string_view, 5> kColumns{"wavelength", "incident zenith angle", "exit zenith angle",
                                                   "exit azimuth angle", "BRDF value"};

bool recognises(const FileBytes& head) {
  const std::string_view text = head.content();
  const std::size_t first = text.find_first_not_of(" \t\r\n\xef\xbb\xbf");
  if (first == std::string_view::npos || text[first] != '{') return false;
  return text.find("\"lookupTable\"") != std::string_view::npos ||
         text.find("openMaterial3dVersion") != std::string_view::npos;
}

/// The rows of a file, one by one.
class Rows {
 public:
  explicit Rows(const FileBytes& file) : file_(file), walk_(file) {
    walk_.run([&](JsonPath path, const JsonScalar& value) { take(path, value); }, [&](JsonPath path) { end(path); });
    if (!has_table_) file_.refuse_end("there is no array 'lookupTable' of 'brdf'; expected one");
  }

  [[nodiscard]] std::vector<SpectralRow> take_rows() { return std::move(rows_); }
  [[nodiscard]] std::size_t missing() const { return missing_; }

 private:
  void take(JsonPath path, const JsonScalar& value) {
    if (!path.empty() && path.front() == "reflectionCoefficient") {
      walk_.refuse("it holds coefficients of reflection; expected 'brdf'");
    }
    if (!is_at(path, {"brdf", "lookupTable", "[]", "[]"})) return;
    if (filled_ == kColumns.size()) walk_.refuse(fmt::format("a row of more than {} numbers", kColumns.size()));
    const bool may_lack = filled_ == 0 || filled_ + 1 == kColumns.size();
    if (value.kind != JsonScalar::Kind::number && !(may_lack && value.kind == JsonScalar::Kind::null)) {
      walk_.refuse(fmt::format("{} of a row is no number", kColumns[filled_]));
    }
    has_[filled_] = value.kind == JsonScalar::Kind::number;
    row_[filled_++] = value.number;
  }

  void end(JsonPath path) {
    if (is_at(path, {"brdf", "lookupTable"})) has_table_ = true;
    if (!is_at(path, {"brdf", "lookupTable", "[]"})) return;
    if (filled_ != kColumns.size()) {
      walk_.refuse(fmt::format("a row of {} numbers; expected {}", filled_, kColumns.size()));
    }
    filled_ = 0;
    for (const std::size_t column : {std::size_t{1}, std::size_t{2}}) {
      if (row_[column] >= 0 && row_[column] <= kHorizon) continue;
      walk_.refuse(fmt::format("{} {}; expected 0 to pi/2, radians", kColumns[column], shortest(row_[column])));
    }
    if (has_[0] && !(row_[0] > 0 && row_[0] < 1)) {
      walk_.refuse(fmt::format("wavelength {}; expected one above 0, metres", shortest(row_[0])));
    }
    if (!has_[4]) {
      ++missing_;
      return;
    }
    // Nanometres to a millionth: 550 of 5.5e-07.
    const double wavelength = has_[0] ? std::round(row_[0] * 1e15) / 1e6 : 0;
    rows_.push_back({wavelength, {row_[1], row_[2], row_[3], 0}, row_[4], 0});
  }

  const FileBytes& file_;
  JsonWalk walk_;
  std::array<double, kColumns.size()> row_{};
  std::array<bool, kColumns.size()> has_{};
  std::size_t filled_ = 0;
  std::size_t missing_ = 0;
  bool has_table_ = false;
  std::vector<SpectralRow> rows_;
};

BrdfFunction read(const FileBytes& file, const ReadOptions& options) {
  Rows rows(file);
  BrdfFunction brdf;
  brdf.name = file.stem();
  brdf.format = kOpenMaterialFormat.title;
  brdf.conventions =
      "sr^-1 without cosine, radians; both angles from the normal, the viewer's azimuth from that of the light, so "
      "that "
      "180 degrees is the mirror side; isotropic";
  if (rows.missing() > 0) brdf.remarks.push_back(fmt::format("{} rows have no value", rows.missing()));
  interpolate(file, gathered(file, rows.take_rows(), true, false, brdf), options, brdf);
  return brdf;
}

/// Metres of a channel; "null" where it is no wavelength.
std::string metres(const BrdfFunction& brdf, std::size_t channel) {
  return brdf.wavelengths.empty() ? "null" : fmt::format("{:.9g}", brdf.wavelengths[channel] * 1e-9);
}

/// The array "lookupTable": rows sorted by their columns, the first of them first.
std::string table_text(const BrdfFunction& brdf) {
  SpecularGrid grid(brdf);
  grid.take_both_sides();
  std::vector<Directions> pairs = specular_pairs(grid);
  for (Directions& pair : pairs) {
    if (pair.delta_phi > kLargestAzimuth) pair.delta_phi = 0;
  }
  std::ranges::sort(pairs, {}, [](const Directions& p) { return std::tuple(p.theta_in, p.theta_out, p.delta_phi); });
  const Eigen::MatrixXd values = spectral_values(brdf, pairs, "OpenMATERIAL").value;
  std::string text;
  for (const std::size_t channel : by_wavelength(brdf)) {
    const std::string wavelength = metres(brdf, channel);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      text += fmt::format("{}[{},{},{},{},{}]", text.empty() ? "" : ",\n", wavelength, shortest(pairs[i].theta_in),
                          shortest(pairs[i].theta_out), shortest(pairs[i].delta_phi),
                          shortest(values(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(channel))));
    }
  }
  return text;
}

std::string write(const BrdfFunction& brdf, const WriteOptions& options) {
  if (!brdf.is_isotropic) {
    throw ArgumentError(fmt::format("'{}' is anisotropic; OpenMATERIAL files hold isotropic reflectances", brdf.name));
  }
  const std::string table = table_text(brdf);
  std::string wavelengths;
  if (!brdf.wavelengths.empty()) {
    for (const std::size_t channel : by_wavelength(brdf)) {
      wavelengths += (wavelengths.empty() ? "" : ",") + metres(brdf, channel);
    }
  }
  std::string description =
      "BRDF in 1/sr without cosine; azimuths are the viewer's from that of the light, pi is the mirror side.";
  if (!options.command_line.empty()) description += " Written by: " + printable(options.command_line);
  return fmt::format(
      R"({{"$schema": "{}",
"metadata": {{"name": {}, "description": {}, "uuid": "{}", "materialVersion": "1.0.0",
"openMaterial3dVersion": "1.1.0", "copyrights": ["NOASSERTION"], "license": "NOASSERTION", "authors": ["lobe"],
"sources": "{}"}},
"brdf": {{"wavelengths": [{}],
"lookupTable": [
{}
]}}}}
)",
      kSchema, json_text(brdf.name), json_text(description), uuid_of(brdf.name + table),
      brdf.format.empty() ? "simulation" : "measurement", wavelengths, table);
}

}  // namespace

const Format kOpenMaterialFormat{"openmaterial", "ASAM OpenMATERIAL 3D .xompt (BRDF)", recognises, read, false, write};

}  // namespace lobe
