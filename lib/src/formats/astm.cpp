// Samples as ASTM E1392 and E2387 exchange them: lines of keywords, the names of the columns, rows.
// Layout: ASTM E1392-96 and the reader of libbsdf (AstmReader.cpp), whose angles are radians.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>

#include "core/text.hpp"
#include "formats/format.hpp"
#include "formats/line_reader.hpp"
#include "formats/scattered_brdf.hpp"
#include "formats/specular_frame.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"

namespace lobe {
namespace {

constexpr std::array<std::string_view, 4> kAngles{"theta_i", "phi_i", "theta_s", "phi_s"};
constexpr double kHorizon = std::numbers::pi / 2 + 1e-5;  // angles may have six digits

/// The names after VARS; empty for other lines.
std::string_view names_of(std::string_view line) {
  std::string_view rest = line;
  return take_word(rest) == "VARS" ? rest : std::string_view{};
}

bool recognises(const FileBytes& head) {
  if (head.content().find('\0') != std::string_view::npos) return false;  // no text
  LineReader lines(head);
  while (lines.next_filled()) {
    if (names_of(lines.line()).find("theta_i") != std::string_view::npos) return true;
  }
  return false;
}

/// Where the angles and the channels stand in a row.
struct Columns {
  std::size_t count = 0;
  std::array<std::size_t, kAngles.size()> angles{};
  std::vector<std::size_t> channels;
};

Columns read_columns(const LineReader& lines, BrdfFunction& brdf) {
  constexpr std::ptrdiff_t kMostColumns = 4096;
  if (std::ranges::count(lines.line(), ',') >= kMostColumns || lines.line().size() > 64 * kMostColumns) {
    lines.refuse(fmt::format("VARS has more than {} columns", kMostColumns));
  }
  const auto names = words_of(names_of(lines.line()));
  Columns columns;
  columns.count = names.size();
  for (std::size_t i = 0; i < kAngles.size(); ++i) {
    const auto found = std::ranges::find(names, kAngles[i]);
    if (found == names.end()) lines.refuse(fmt::format("VARS has no '{}'", kAngles[i]));
    columns.angles[i] = static_cast<std::size_t>(found - names.begin());
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string_view name = names[i];
    if (std::ranges::find(kAngles, name) != kAngles.end()) continue;
    columns.channels.push_back(i);
    double wavelength = 0;
    if (name.ends_with("nm") && parse_number(name.substr(0, name.size() - 2), wavelength)) {
      brdf.wavelengths.push_back(wavelength);
      brdf.channels.push_back(shortest(wavelength) + " nm");
    } else {
      brdf.channels.emplace_back(name);
    }
  }
  if (brdf.channels.empty()) lines.refuse("VARS has no column of values");
  if (brdf.wavelengths.size() < brdf.channels.size()) brdf.wavelengths.clear();
  if (brdf.channels == std::vector<std::string>{"R", "G", "B"}) brdf.channels = {"red", "green", "blue"};
  return columns;
}

ScatteredSamples read_samples(LineReader& lines, const Columns& columns) {
  SampleCollector samples(columns.channels.size());
  samples.reserve(lines.most_rows(columns.count));
  bool is_isotropic = true;
  double first_azimuth = 0;
  std::vector<double> values(columns.channels.size());
  while (lines.next_filled()) {
    const auto row = lines.numbers(columns.count);
    if (row.size() != columns.count) {
      lines.refuse(fmt::format("{} numbers; expected {}, one for each of VARS", row.size(), columns.count));
    }
    const auto [theta_i, phi_i, theta_s, phi_s] =
        std::array{row[columns.angles[0]], row[columns.angles[1]], row[columns.angles[2]], row[columns.angles[3]]};
    for (const double theta : {theta_i, theta_s}) {
      if (!(theta >= 0 && theta <= kHorizon)) {
        lines.refuse(fmt::format("polar angle {}; expected 0 to pi/2, radians", theta));
      }
    }
    if (samples.size() == 0) first_azimuth = phi_i;
    is_isotropic = is_isotropic && phi_i == first_azimuth;
    for (std::size_t c = 0; c < values.size(); ++c) values[c] = row[columns.channels[c]];
    samples.add({theta_i, theta_s, phi_s - phi_i, phi_i}, values);
  }
  return samples.take(is_isotropic);
}

BrdfFunction read(const FileBytes& file, const ReadOptions& options) {
  BrdfFunction brdf;
  brdf.name = file.stem();
  brdf.format = kAstmFormat.title;
  LineReader lines(file);
  double announced = -1;
  while (lines.next_filled() && names_of(lines.line()).empty()) {
    std::string_view rest = lines.line();
    if (take_word(rest) == "NUM_POINTS" && !parse_number(take_word(rest), announced))
      lines.refuse("no number of points");
  }
  const Columns columns = read_columns(lines, brdf);
  const ScatteredSamples samples = read_samples(lines, columns);
  if (announced >= 0 && announced != static_cast<double>(samples.pairs.size())) {
    file.refuse_end(fmt::format("{} rows; NUM_POINTS announces {}", samples.pairs.size(), announced));
  }
  brdf.conventions = "sr^-1 without cosine, radians; phi_s - phi_i = 180 degrees is the mirror side; ";
  brdf.conventions += samples.is_isotropic ? "one azimuth of the light: isotropic" : "anisotropic";
  interpolate(file, samples, options, brdf);
  return brdf;
}

/// A channel's name among VARS.
std::string column_name(const BrdfFunction& brdf, std::size_t channel) {
  if (brdf.channels == std::vector<std::string>{"red", "green", "blue"}) return std::string(1, "RGB"[channel]);
  std::string name = brdf.channels[channel];
  std::erase(name, ' ');  // "532 nm"
  const bool is_plain = std::ranges::none_of(name, [](unsigned char c) { return c <= ' ' || c == ',' || c == '"'; });
  if (name.empty() || !is_plain || std::ranges::find(kAngles, name) != kAngles.end()) {
    throw ArgumentError(
        fmt::format("channel '{}' cannot be written as a name after VARS; expected one without commas "
                    "and quotes",
                    brdf.channels[channel]));
  }
  return name;
}

std::string write(const BrdfFunction& brdf, const WriteOptions& options) {
  const std::vector<Directions> pairs = specular_pairs(grid_of_rows(brdf));
  const Eigen::MatrixXd values = brdf.at(pairs).value;
  if (!values.allFinite()) throw NumericError("'" + brdf.name + "' has values that are no finite numbers");
  std::string text = "LAB_NAME lobe\n";
  if (!options.command_line.empty()) text += "COMMENT " + printable(options.command_line) + "\n";
  text += fmt::format("NUM_POINTS {}\nVARS {}", pairs.size(), fmt::join(kAngles, ","));
  for (std::size_t c = 0; c < brdf.channels.size(); ++c) text += "," + column_name(brdf, c);
  text += '\n';
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto [theta_i, theta_s, delta_phi, phi_i] = pairs[i];
    text += fmt::format("{},{},{},{}", shortest(theta_i), shortest(phi_i), shortest(theta_s),
                        shortest(std::fmod(phi_i + delta_phi, 2 * std::numbers::pi)));
    for (const double value : values.row(static_cast<Eigen::Index>(i))) text += "," + shortest(value);
    text += '\n';
  }
  return text;
}

}  // namespace

const Format kAstmFormat{"astm", "ASTM E1392/E2387 rows", recognises, read, false, write};

}  // namespace lobe
