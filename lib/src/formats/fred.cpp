// Tabulated scatter as FRED reads it: blocks of samples about specular directions.
// Sources: the help of FRED ("Tabulated BSDF", AddTabulatedScatterData), which counts angles from the normal and takes
// azimuths of scattered and specular direction that agree for the mirror side; the converter that wrote the
// measurements at hand (ua-loft/bsdf-tools, write_fred.m).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <string_view>
#include <utility>

#include "core/text.hpp"
#include "formats/format.hpp"
#include "formats/line_reader.hpp"
#include "formats/scattered_brdf.hpp"
#include "lobe/core/directions.hpp"

namespace lobe {
namespace {

using std::numbers::pi;

constexpr std::size_t kQuoted = 40;  // characters of the file that complaints show

/// Required line of the format; it defines the values and angles.
constexpr std::array<std::pair<std::string_view, std::string_view>, 3> kExpected{
    {{"angles", "deg"}, {"bsdf", "value"}, {"scale", "1"}}};

bool is_type(std::string_view line) {
  return take_word(line) == "type" && take_word(line) == "bsdf_data";
}

bool recognises(const FileBytes& head) {
  LineReader lines(head);
  return lines.next_filled() && is_type(lines.line());
}

void check_format(LineReader& lines) {
  if (!lines.next_filled() || !is_type(lines.line())) lines.refuse("expected 'type bsdf_data'");
  if (!lines.next_filled()) lines.refuse("the file ends; expected 'format angles=deg bsdf=value scale=1'");
  std::string_view rest = lines.line();
  if (take_word(rest) != "format") lines.refuse("expected 'format angles=deg bsdf=value scale=1'");
  for (auto word = take_word(rest); !word.empty(); word = take_word(rest)) {
    const bool is_known = std::ranges::any_of(
        kExpected, [&](const auto& key) { return word == fmt::format("{}={}", key.first, key.second); });
    if (!is_known) {
      lines.refuse(
          fmt::format("format '{}' is not read; expected angles=deg, bsdf=value and scale=1", word.substr(0, kQuoted)));
    }
  }
}

double polar_angle(const LineReader& lines, double degrees) {
  if (!(degrees >= 0 && degrees <= 90)) {
    lines.refuse(fmt::format("polar angle {}; expected 0 to 90 degrees", shortest(degrees)));
  }
  return degrees * kDegree;
}

/// Blocks of a line with the specular direction and lines with a scattered one and the value.
ScatteredSamples read_samples(LineReader& lines) {
  constexpr std::size_t kDirection = 2;
  constexpr std::size_t kSample = 3;
  SampleCollector samples(1);
  samples.reserve(lines.most_rows(kSample));
  Directions pair;
  double first_azimuth = 0;
  bool has_direction = false;
  bool is_isotropic = true;
  while (lines.next_filled()) {
    const auto row = lines.numbers(kSample);
    if (row.size() == kDirection) {
      pair.theta_in = polar_angle(lines, row[0]);
      pair.phi_in = row[1] * kDegree + pi;  // the light is opposite to the specular direction
      if (!has_direction) first_azimuth = pair.phi_in;
      has_direction = true;
      is_isotropic = is_isotropic && pair.phi_in == first_azimuth;
    } else if (row.size() == kSample && has_direction) {
      pair.theta_out = polar_angle(lines, row[0]);
      pair.delta_phi = row[1] * kDegree - pair.phi_in;
      samples.add(pair, std::array{row[2]});
    } else {
      lines.refuse(has_direction
                       ? fmt::format("{} numbers; expected theta, phi and a value, or the two angles of the "
                                     "next specular direction",
                                     row.size())
                       : fmt::format("{} numbers; expected the two angles of a specular direction", row.size()));
    }
  }
  return samples.take(is_isotropic);
}

BrdfFunction read(const FileBytes& file, const ReadOptions& options) {
  LineReader lines(file);
  check_format(lines);
  const ScatteredSamples samples = read_samples(lines);
  BrdfFunction brdf;
  brdf.name = file.stem();
  brdf.format = kFredFormat.title;
  brdf.channels = {"value"};
  brdf.conventions = "sr^-1 without cosine; degrees from the normal, azimuths from that of the specular direction; ";
  brdf.conventions += samples.is_isotropic ? "one azimuth of the light: isotropic" : "anisotropic";
  interpolate(file, samples, options, brdf);
  return brdf;
}

}  // namespace

const Format kFredFormat{"fred", "FRED tabulated scatter", recognises, read};

}  // namespace lobe
