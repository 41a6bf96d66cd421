// Tables of bidirectional reflectance factors, one row per pair of directions, as the Black Lab of the University of
// Arizona writes them (ua-loft/bsdf-tools). A factor is the reflectance over that of a perfect diffuser, 1/pi
// (Nicodemus et al. 1977).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <string_view>

#include "core/text.hpp"
#include "formats/format.hpp"
#include "formats/line_reader.hpp"
#include "formats/scattered_brdf.hpp"
#include "lobe/core/directions.hpp"

namespace lobe {
namespace {

using std::numbers::pi;

constexpr std::array<std::string_view, 4> kAngles{"src_z", "src_a", "view_z", "view_a"};
constexpr std::size_t kMostLines = 64;       // before the names of the columns
constexpr std::size_t kMostColumns = 10000;  // also keeps sizes small

/// Goes to the line with the names of the columns, below some that say what was measured; false where there is none.
bool find_names(LineReader& lines) {
  for (std::size_t i = 0; i < kMostLines && lines.next_filled(); ++i) {
    std::string_view rest = lines.line();
    if (take_word(rest) == kAngles[0] && take_word(rest) == kAngles[1]) return true;
  }
  return false;
}

bool recognises(const FileBytes& head) {
  if (head.content().find('\0') != std::string_view::npos) return false;  // no text
  LineReader lines(head);
  return find_names(lines);
}

/// Names of bands are wavelengths: 385.65nm.
void read_names(const LineReader& lines, BrdfFunction& brdf) {
  if (lines.line().size() > 16 * kMostColumns) lines.refuse(fmt::format("more than {} columns", kMostColumns));
  const auto names = words_of(lines.line());
  if (!std::ranges::equal(kAngles, std::span(names).first(std::min(kAngles.size(), names.size())))) {
    lines.refuse("other columns than src_z, src_a, view_z, view_a and bands");
  }
  for (const std::string_view name : std::span(names).subspan(kAngles.size())) {
    double wavelength = 0;
    if (name.ends_with("nm") && parse_number(name.substr(0, name.size() - 2), wavelength) && wavelength > 0) {
      brdf.wavelengths.push_back(wavelength);
      brdf.channels.push_back(shortest(wavelength) + " nm");
    } else {
      brdf.channels.emplace_back(name);
    }
  }
  if (brdf.channels.empty()) lines.refuse("there is no column of a band");
  if (brdf.wavelengths.size() < brdf.channels.size()) brdf.wavelengths.clear();
}

ScatteredSamples read_samples(LineReader& lines, std::size_t channels) {
  SampleCollector samples(channels);
  samples.reserve(lines.most_rows(kAngles.size() + channels));
  double first_azimuth = 0;
  bool is_isotropic = true;
  while (lines.next_filled()) {
    auto row = lines.numbers(kAngles.size() + channels);
    if (row.size() != kAngles.size() + channels) {
      lines.refuse(fmt::format("{} numbers; expected {} angles and {} factors", row.size(), kAngles.size(), channels));
    }
    for (const std::size_t column : {0U, 2U}) {
      if (!(row[column] >= 0 && row[column] <= 90)) {
        lines.refuse(fmt::format("{} of {}; expected 0 to 90 degrees", kAngles[column], shortest(row[column])));
      }
    }
    if (samples.size() == 0) first_azimuth = row[1];
    is_isotropic = is_isotropic && row[1] == first_azimuth;
    const auto values = std::span(row).subspan(kAngles.size());
    for (double& value : values) value /= pi;
    samples.add({row[0] * kDegree, row[2] * kDegree, (row[3] - row[1]) * kDegree, row[1] * kDegree}, values);
  }
  return samples.take(is_isotropic);
}

BrdfFunction read(const FileBytes& file, const ReadOptions& options) {
  LineReader lines(file);
  if (!find_names(lines)) file.refuse_end("there is no line of columns src_z, src_a, view_z, view_a");
  BrdfFunction brdf;
  brdf.name = file.stem();
  brdf.format = kBrfFormat.title;
  read_names(lines, brdf);
  const ScatteredSamples samples = read_samples(lines, brdf.channels.size());
  brdf.conventions =
      "bidirectional reflectance factors, divided by pi; degrees, view_a - src_a = 180 degrees is the mirror side; ";
  brdf.conventions += samples.is_isotropic ? "one azimuth of the light: isotropic" : "anisotropic";
  interpolate(file, samples, options, brdf);
  return brdf;
}

}  // namespace

const Format kBrfFormat{"brf", "BRF tables", recognises, read};

}  // namespace lobe
