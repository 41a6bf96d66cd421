// Isotropic spectral reflectances at scattered pairs of directions: measurements of the goniometer of Cornell's Program
// of Computer Graphics, in the layout of pbrt-v2 (materials/measured.cpp).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>

#include "core/text.hpp"
#include "formats/format.hpp"
#include "formats/line_reader.hpp"
#include "formats/scattered_brdf.hpp"

namespace lobe {
namespace {

constexpr std::size_t kAngles = 4;                        // theta_i, phi_i, theta_s, phi_s
constexpr double kMostWavelengths = 10000;                // also keeps sizes small
constexpr double kShortest = 100;                         // nm
constexpr double kLongest = 100000;                       // nm
constexpr double kHorizon = std::numbers::pi / 2 + 1e-5;  // angles have six digits

/// Goes to the next line that holds more than a comment; false at the end.
bool next_data(LineReader& lines, std::string_view& data) {
  while (lines.next()) {
    data = trim(lines.line().substr(0, lines.line().find('#')));
    if (!data.empty()) return true;
  }
  return false;
}

bool is_wavelength(double value, double after) {
  return value >= kShortest && value <= kLongest && value > after;
}

/// A line with a whole number, then one that begins with a wavelength.
bool recognises(const FileBytes& head) {
  LineReader lines(head);
  std::string_view data;
  double count = 0;
  double first = 0;
  return next_data(lines, data) && parse_number(data, count) && count >= 1 && count == std::floor(count) &&
         next_data(lines, data) && parse_number(take_word(data), first) && is_wavelength(first, 0);
}

std::vector<double> read_wavelengths(LineReader& lines) {
  std::string_view data;
  double count = 0;
  if (!next_data(lines, data) || !parse_number(data, count) || count != std::floor(count) || !(count >= 1) ||
      count > kMostWavelengths) {
    lines.refuse(fmt::format("no number of wavelengths; expected one from 1 to {}", kMostWavelengths));
  }
  std::vector<double> wavelengths;
  while (static_cast<double>(wavelengths.size()) < count) {
    if (!next_data(lines, data)) {
      lines.refuse(fmt::format("the file ends within the wavelengths; expected {}", count));
    }
    for (const double value : lines.numbers(data, static_cast<std::size_t>(count))) {
      if (!is_wavelength(value, wavelengths.empty() ? 0 : wavelengths.back())) {
        lines.refuse(fmt::format("wavelength {}; expected rising ones from {} to {} nm", value, kShortest, kLongest));
      }
      wavelengths.push_back(value);
    }
    if (static_cast<double>(wavelengths.size()) > count) lines.refuse(fmt::format("expected {} wavelengths", count));
  }
  return wavelengths;
}

ScatteredSamples read_samples(LineReader& lines, std::size_t channels) {
  SampleCollector samples(channels);
  samples.reserve(lines.most_rows(kAngles + channels));
  std::string_view data;
  while (next_data(lines, data)) {
    const auto row = lines.numbers(data, kAngles + channels);
    if (row.size() != kAngles + channels) {
      lines.refuse(fmt::format("{} numbers; expected {} angles and {} values", row.size(), kAngles, channels));
    }
    for (const std::size_t column : {0U, 2U}) {
      if (!(row[column] >= 0 && row[column] <= kHorizon)) {
        lines.refuse(fmt::format("polar angle {}; expected 0 to pi/2, radians", row[column]));
      }
    }
    samples.add({row[0], row[2], row[3] - row[1], 0}, std::span(row).subspan(kAngles));
  }
  return samples.take(true);
}

BrdfFunction read(const FileBytes& file, const ReadOptions& options) {
  LineReader lines(file);
  BrdfFunction brdf;
  brdf.name = file.stem();
  brdf.format = kCornellFormat.title;
  brdf.conventions = "sr^-1 without cosine; phi_s - phi_i = 180 degrees is the mirror side; isotropic";
  brdf.wavelengths = read_wavelengths(lines);
  for (const double wavelength : brdf.wavelengths) brdf.channels.push_back(shortest(wavelength) + " nm");
  interpolate(file, read_samples(lines, brdf.channels.size()), options, brdf);
  return brdf;
}

}  // namespace

const Format kCornellFormat{"cornell", "Cornell irregular isotropic .brdf (pbrt-v2)", recognises, read};

}  // namespace lobe
