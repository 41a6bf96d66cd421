// Rows of a goniometer as NIST publishes them, one per wavelength and pair of directions; of the Mueller matrix only
// the reflectance for unpolarised light is read. Source: Germer 2017 ("Full four-dimensional and reciprocal Mueller
// matrix BRDF of sintered PTFE"), its data files.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <tuple>

#include "core/text.hpp"
#include "formats/format.hpp"
#include "formats/line_reader.hpp"
#include "formats/scattered_brdf.hpp"
#include "lobe/core/directions.hpp"

namespace lobe {
namespace {

constexpr double kLongest = 1000;  // micrometres

/// Names of the columns read: as the files have them, and as their description does.
constexpr std::array<std::array<std::string_view, 2>, 6> kColumns{{{"lambda", "lambda"},
                                                                   {"thetai", "thetai"},
                                                                   {"phi", "phii"},
                                                                   {"thetar", "thetar"},
                                                                   {"phir", "phir"},
                                                                   {"f_r11", "fr11"}}};

struct Row {
  std::array<double, 4> angles;  ///< theta_i, phi_i, theta_r, phi_r; degrees
  double wavelength;             ///< nm
  double value;
};

bool is_header(const std::vector<std::string_view>& words) {
  return words.size() >= kColumns.size() && words[0] == "lambda" && words[1] == "thetai";
}

bool recognises(const FileBytes& head) {
  constexpr std::size_t kLongestHeader = 4096;  // characters
  LineReader lines(head);
  return lines.next_filled() && lines.line().size() <= kLongestHeader && is_header(words_of(lines.line()));
}

std::array<std::size_t, kColumns.size()> find_columns(const std::vector<std::string_view>& words,
                                                      const LineReader& lines) {
  std::array<std::size_t, kColumns.size()> places{};
  for (std::size_t i = 0; i < kColumns.size(); ++i) {
    const auto found = std::ranges::find_if(
        words, [&](std::string_view word) { return word == kColumns[i][0] || word == kColumns[i][1]; });
    if (found == words.end()) lines.refuse(fmt::format("there is no column '{}'", kColumns[i][0]));
    places[i] = static_cast<std::size_t>(found - words.begin());
  }
  return places;
}

std::vector<Row> read_rows(const FileBytes& file) {
  LineReader lines(file);
  if (!lines.next_filled()) lines.refuse("there is no header");
  const auto header = words_of(lines.line());
  const auto columns = find_columns(header, lines);
  std::vector<Row> rows;
  rows.reserve(lines.most_rows(header.size()));
  while (lines.next_filled()) {
    const auto cells = lines.numbers(header.size());
    if (cells.size() != header.size()) {
      lines.refuse(fmt::format("{} numbers; expected {}, one for each column", cells.size(), header.size()));
    }
    const auto cell = [&](std::size_t column) { return cells[columns[column]]; };
    if (!(cell(0) > 0 && cell(0) <= kLongest)) {
      lines.refuse(fmt::format("wavelength {}; expected micrometres", cell(0)));
    }
    for (const std::size_t column : {1U, 3U}) {
      if (!(std::abs(cell(column)) <= 90)) {
        lines.refuse(fmt::format("polar angle {}; expected -90 to 90 degrees", cell(column)));
      }
    }
    rows.push_back({{cell(1), cell(2), cell(3), cell(4)}, std::round(cell(0) * 1e9) / 1e6, cell(5)});
  }
  return rows;
}

/// Polar angles below 0 are on the other side of the normal.
Directions pair_of(const std::array<double, 4>& angles) {
  const double turn = (angles[0] < 0 ? 180 : 0) + (angles[2] < 0 ? 180 : 0);
  return {std::abs(angles[0]) * kDegree, std::abs(angles[2]) * kDegree, (angles[3] - angles[1] + turn) * kDegree, 0};
}

/// Those geometries that all wavelengths have; several rows of one wavelength are averaged.
ScatteredSamples common_samples(std::vector<Row> rows, BrdfFunction& brdf) {
  std::ranges::sort(rows, {}, [](const Row& row) { return std::tie(row.angles, row.wavelength); });
  SampleCollector samples(brdf.wavelengths.size());
  std::size_t geometries = 0;
  for (std::size_t begin = 0; begin < rows.size();) {
    std::vector<double> values;
    std::size_t end = begin;
    while (end < rows.size() && rows[end].angles == rows[begin].angles) {
      const std::size_t first = end;
      double sum = 0;
      for (; end < rows.size() && rows[end].angles == rows[begin].angles &&
             rows[end].wavelength == rows[first].wavelength;
           ++end) {
        sum += rows[end].value;
      }
      values.push_back(sum / static_cast<double>(end - first));
    }
    ++geometries;
    if (values.size() == brdf.wavelengths.size()) samples.add(pair_of(rows[begin].angles), values);
    begin = end;
  }
  if (samples.size() < geometries) {
    brdf.remarks.push_back(fmt::format("{} of {} pairs of directions do not have all wavelengths, and are left out",
                                       geometries - samples.size(), geometries));
  }
  return samples.take(true);
}

BrdfFunction read(const FileBytes& file, const ReadOptions& options) {
  auto rows = read_rows(file);
  BrdfFunction brdf;
  brdf.name = file.stem();
  brdf.format = kNistRowsFormat.title;
  brdf.conventions =
      "sr^-1 without cosine, unpolarised light (f_r11); phi_r - phi_i = 180 degrees is the mirror side; isotropic";
  for (const Row& row : rows) brdf.wavelengths.push_back(row.wavelength);
  std::ranges::sort(brdf.wavelengths);
  brdf.wavelengths.erase(std::unique(brdf.wavelengths.begin(), brdf.wavelengths.end()), brdf.wavelengths.end());
  for (const double wavelength : brdf.wavelengths) brdf.channels.push_back(shortest(wavelength) + " nm");
  interpolate(file, common_samples(std::move(rows), brdf), options, brdf);
  return brdf;
}

}  // namespace

const Format kNistRowsFormat{"nist-rows", "NIST goniometer rows", recognises, read};

}  // namespace lobe
