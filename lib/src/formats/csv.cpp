// Plain tables of lobe itself: a row per pair of directions, documented in docs/file-formats.md.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

#include "core/spectral_range.hpp"
#include "core/text.hpp"
#include "formats/format.hpp"
#include "formats/line_reader.hpp"
#include "formats/replicates.hpp"
#include "formats/scattered_brdf.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"
#include "lobe/formats/measurement.hpp"

namespace lobe {
namespace {

constexpr std::array<std::string_view, 3> kIsotropic{"theta_in_deg", "theta_out_deg", "delta_phi_deg"};
constexpr std::array<std::string_view, 4> kGeneral{"theta_in_deg", "phi_in_deg", "theta_out_deg", "phi_out_deg"};
constexpr std::string_view kDeviation = "_std";
constexpr std::size_t kMostColumns = 4096;
constexpr std::size_t kMostReplicated = 50'000'000;  // values of grids with their replicates
constexpr std::size_t kFewest = 8;                   // rows that may be scattered samples
constexpr std::size_t kQuoted = 40;                  // characters of the file that complaints show

bool is_azimuth(std::string_view column) {
  return column.find("phi") != std::string_view::npos;
}

// --- Reading.

struct Header {
  std::span<const std::string_view> angles;
  std::vector<std::string> channels;
  std::vector<double> wavelengths;
  /// Content of each column: an index of angles, or their count and an index of channels, or the count of both and that
  /// of the channel whose standard deviation it is.
  std::vector<std::size_t> fields;
  bool has_deviations = false;

  [[nodiscard]] std::size_t columns() const { return fields.size(); }
  /// Numbers of a row beside its angles.
  [[nodiscard]] std::size_t numbers() const { return (has_deviations ? 2 : 1) * channels.size(); }
};

/// Goes to the next line that is neither blank nor a comment; false at the end.
bool next_row(LineReader& lines) {
  while (lines.next_filled()) {
    if (!lines.line().starts_with('#')) return true;
  }
  return false;
}

/// Whether a column was meant to hold an angle, under whatever name; channels may be called graphite.
bool is_like_an_angle(std::string_view column) {
  const std::string name = "_" + lowercase(column);
  const auto has = [&](std::string_view word) { return name.find(word) != std::string::npos; };
  return has("_theta") || name == "_phi" || has("_phi_") || has("_dphi") || has("_delta_phi") || has("_azimuth") ||
         has("_zenith");
}

/// A line of names, one of them that of an angle: files with other names than ours are to be told so.
bool recognises(const FileBytes& head) {
  LineReader lines(head);
  if (!next_row(lines) || lines.line().find_first_of("=<{") != std::string_view::npos) return false;
  std::string_view rest = lines.line();
  const bool is_list = rest.find_first_of(",;\t") != std::string_view::npos;
  for (auto word = take_word(rest); is_list && !word.empty(); word = take_word(rest)) {
    if (is_like_an_angle(word) && lowercase(word).find("theta") != std::string::npos) return true;
  }
  return false;
}

std::string joined(std::span<const std::string_view> words) {
  return fmt::format("{}", fmt::join(words, ","));
}

/// The angles that the columns are of: with delta_phi_deg isotropic.
std::span<const std::string_view> angles_of(const LineReader& lines, std::span<const std::string_view> names) {
  const auto has = [&](std::string_view name) { return std::ranges::find(names, name) != names.end(); };
  const std::span<const std::string_view> angles = has(kIsotropic[2]) || !(has(kGeneral[1]) || has(kGeneral[3]))
                                                       ? std::span<const std::string_view>(kIsotropic)
                                                       : std::span<const std::string_view>(kGeneral);
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (std::ranges::find(angles, names[i]) == angles.end() && is_like_an_angle(names[i])) {
      lines.refuse(fmt::format("column {} is '{}'; expected {} or {}, degrees, and channels", i + 1,
                               names[i].substr(0, kQuoted), joined(kIsotropic), joined(kGeneral)));
    }
    if (std::ranges::find(angles, names[i]) != angles.end() && std::ranges::count(names, names[i]) > 1) {
      lines.refuse(fmt::format("two columns are '{}'", names[i]));
    }
  }
  for (const std::string_view angle : angles) {
    if (!has(angle)) lines.refuse(fmt::format("there is no column '{}'; expected {}", angle, joined(angles)));
  }
  return angles;
}

/// The channel whose standard deviations a column holds; empty for other columns.
std::string_view deviates(std::string_view name, std::span<const std::string_view> names) {
  if (!name.ends_with(kDeviation)) return {};
  const std::string_view channel = name.substr(0, name.size() - kDeviation.size());
  return std::ranges::find(names, channel) == names.end() ? std::string_view() : channel;
}

/// Places the columns of standard deviations, once all channels are known.
void place_deviations(const LineReader& lines, std::span<const std::string_view> names, Header& header) {
  std::vector<bool> has_deviation(header.channels.size(), false);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string_view channel = deviates(names[i], names);
    if (channel.empty()) continue;
    const auto at = static_cast<std::size_t>(std::ranges::find(header.channels, channel) - header.channels.begin());
    header.fields[i] = header.angles.size() + header.channels.size() + at;
    has_deviation[at] = true;
    header.has_deviations = true;
  }
  if (!header.has_deviations) return;
  for (std::size_t c = 0; c < has_deviation.size(); ++c) {
    if (has_deviation[c]) continue;
    lines.refuse(fmt::format("channel '{}' has no column '{}{}'; expected standard deviations for all channels or none",
                             header.channels[c], header.channels[c], kDeviation));
  }
}

Header header_of(const LineReader& lines) {
  if (static_cast<std::size_t>(std::ranges::count(lines.line(), ',')) > kMostColumns) {
    lines.refuse(fmt::format("too many columns; expected up to {}", kMostColumns));
  }
  const std::size_t other = lines.line().find_first_of(";\t");
  if (other != std::string_view::npos && lines.line().find(',') == std::string_view::npos) {
    lines.refuse(fmt::format("columns are apart by {}; expected commas", lines.line()[other] == ';' ? "';'" : "tabs"));
  }
  std::vector<std::string_view> names = split(lines.line(), ',');
  for (std::string_view& name : names) name = trim(name);
  Header header;
  header.angles = angles_of(lines, names);
  for (const std::string_view name : names) {
    if (const auto angle = std::ranges::find(header.angles, name); angle != header.angles.end()) {
      header.fields.push_back(static_cast<std::size_t>(angle - header.angles.begin()));
      continue;
    }
    if (!deviates(name, names).empty()) {
      header.fields.push_back(0);  // which is placed below
      continue;
    }
    const bool is_plain = std::ranges::none_of(name, [](unsigned char c) { return c < ' ' || c == 0x7f || c == '"'; });
    if (name.empty() || !is_plain) lines.refuse("a channel without a name, or with quotes or control characters in it");
    header.fields.push_back(header.angles.size() + header.channels.size());
    header.channels.emplace_back(name);
    if (const double wavelength = wavelength_of(name); wavelength > 0) header.wavelengths.push_back(wavelength);
  }
  if (header.channels.empty()) lines.refuse(fmt::format("no column of values beside {}", joined(header.angles)));
  if (header.wavelengths.size() != header.channels.size()) header.wavelengths.clear();
  place_deviations(lines, names, header);
  return header;
}

struct Rows {
  std::vector<std::vector<double>> angles;  // radians: one list for each column
  std::vector<double> values;               // rows x numbers: channels, and their standard deviations

  [[nodiscard]] std::size_t count() const { return angles.front().size(); }
};

/// In [0, 2 pi).
double within_circle(double phi) {
  const double turned = std::fmod(phi, 360);
  const double positive = turned < 0 ? turned + 360 : turned;
  return positive < 360 ? positive * kDegree : 0;
}

Rows read_rows(LineReader& lines, const Header& header) {
  const std::size_t most = lines.most_rows(header.columns());
  Rows rows;
  rows.angles.resize(header.angles.size());
  for (auto& list : rows.angles) list.reserve(most);
  rows.values.reserve(most * header.numbers());
  while (next_row(lines)) {
    rows.values.resize(rows.values.size() + header.numbers());
    double* const values = rows.values.data() + rows.values.size() - header.numbers();
    std::string_view rest = lines.line();
    for (std::size_t column = 0; column < header.columns(); ++column) {
      const std::size_t comma = rest.find(',');
      const std::string_view word = trim(rest.substr(0, comma));
      double number = 0;
      if (!parse_number(word, number)) {
        lines.refuse(fmt::format("'{}' in column {} is no finite number", word.substr(0, kQuoted), column + 1));
      }
      const bool is_last = column + 1 == header.columns();
      if ((comma == std::string_view::npos) != is_last)
        lines.refuse(fmt::format("expected {} numbers", header.columns()));
      rest.remove_prefix(is_last ? rest.size() : comma + 1);
      const std::size_t field = header.fields[column];
      if (field >= header.angles.size()) {
        if (field >= header.angles.size() + header.channels.size() && number < 0) {
          lines.refuse(fmt::format("a standard deviation of {}; expected 0 or more", shortest(number)));
        }
        values[field - header.angles.size()] = number;
      } else if (is_azimuth(header.angles[field])) {
        rows.angles[field].push_back(within_circle(number));
      } else if (number >= 0 && number <= 90) {
        rows.angles[field].push_back(number * kDegree);
      } else {
        lines.refuse(fmt::format("{} of {}; expected 0 to 90", header.angles[field], shortest(number)));
      }
    }
  }
  if (rows.values.empty()) lines.refuse("no rows of numbers");
  return rows;
}

// --- Tables on the product of lists of angles.

struct Axis {
  std::vector<double> nodes;  // rising
  bool is_circle = false;
};

/// Between which nodes an angle lies, and how far from the first to the second, 0 to 1.
struct Place {
  std::size_t before = 0;
  std::size_t after = 0;
  double share = 0;
};

Place place_on(const Axis& axis, double angle) {
  const auto& nodes = axis.nodes;
  if (axis.is_circle) {
    angle = std::fmod(angle, 2 * std::numbers::pi);
    if (angle < 0) angle += 2 * std::numbers::pi;
  }
  const auto above = static_cast<std::size_t>(std::ranges::upper_bound(nodes, angle) - nodes.begin());
  const std::size_t last = nodes.size() - 1;
  if (above > 0 && above <= last) {
    return {above - 1, above, (angle - nodes[above - 1]) / (nodes[above] - nodes[above - 1])};
  }
  if (!axis.is_circle || last == 0) return above == 0 ? Place{0, 0, 0} : Place{last, last, 0};
  const double gap = nodes.front() + 2 * std::numbers::pi - nodes.back();
  const double from_last = above == 0 ? angle + 2 * std::numbers::pi - nodes.back() : angle - nodes.back();
  return {last, 0, from_last / gap};
}

struct Grid {
  std::vector<Axis> axes;         // as the columns
  std::vector<std::size_t> rows;  // which row of values a point has; the last axis is the quickest
  std::vector<double> values;     // rows x channels
  std::size_t channels = 1;
  bool folds = false;  // delta_phi and -delta_phi are the same

  /// By channel.
  [[nodiscard]] std::span<const double> at(std::size_t row) const {
    return std::span(values).subspan(row * channels, channels);
  }
};

/// Which point of the grid a row is.
std::size_t point_of(const Grid& grid, const Rows& rows, std::size_t row) {
  std::size_t point = 0;
  for (std::size_t a = 0; a < grid.axes.size(); ++a) {
    const auto& nodes = grid.axes[a].nodes;
    const auto at = std::ranges::lower_bound(nodes, rows.angles[a][row]) - nodes.begin();
    point = point * nodes.size() + static_cast<std::size_t>(at);
  }
  return point;
}

/// The line of a row.
std::size_t line_of(const FileBytes& file, std::size_t row) {
  LineReader lines(file);
  for (std::size_t i = 0; next_row(lines) && i <= row; ++i) {
  }
  return lines.number();
}

/// Whether all points without a row have one angle in common: the file was cut short. Places that a goniometer cannot
/// reach lie elsewhere.
bool lacks_one_slice(const Grid& grid, std::size_t none) {
  std::size_t stride = grid.rows.size();
  for (const Axis& axis : grid.axes) {
    stride /= axis.nodes.size();
    std::vector<bool> is_lacking(axis.nodes.size());
    for (std::size_t point = 0; point < grid.rows.size(); ++point) {
      if (grid.rows[point] == none) is_lacking[point / stride % axis.nodes.size()] = true;
    }
    if (axis.nodes.size() > 1 && std::ranges::count(is_lacking, true) == 1) return true;
  }
  return false;
}

/// Where the rows, in any order, have all combinations of their angles: the grid, which takes their values; else
/// nothing, and what it would be is told. Rows that are the same count once.
std::optional<Grid> grid_of(const FileBytes& file, const Header& header, Rows& rows, std::string& sizes) {
  Grid grid;
  grid.channels = header.numbers();
  double points = 1;  // may be more than numbers of bytes go
  for (std::size_t a = 0; a < rows.angles.size(); ++a) {
    auto nodes = rows.angles[a];
    std::ranges::sort(nodes);
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    nodes.shrink_to_fit();
    points *= static_cast<double>(nodes.size());
    sizes += fmt::format("{}{} {}", a == 0 ? "" : " x ", nodes.size(), header.angles[a]);
    grid.axes.push_back({std::move(nodes), is_azimuth(header.angles[a])});
  }
  if (points > 2 * static_cast<double>(rows.count())) return {};
  Axis& last = grid.axes.back();
  if (header.angles.size() == kIsotropic.size() && last.nodes.back() < 180.001 * kDegree) {
    grid.folds = true;
    last.is_circle = false;
  }

  const std::size_t none = rows.count();
  grid.rows.assign(static_cast<std::size_t>(points), none);
  for (std::size_t row = 0; row < rows.count(); ++row) {
    std::size_t& first = grid.rows[point_of(grid, rows, row)];
    if (first == none) first = row;
  }
  if (const auto missing = std::ranges::count(grid.rows, none); missing > 0) {
    if (rows.count() < kFewest || !lacks_one_slice(grid, none)) return {};
    file.refuse_at(file.size(), fmt::format("the file ends {} rows before its grid of {} is complete", missing, sizes));
  }
  grid.values = std::move(rows.values);
  for (std::size_t row = 0; row < rows.count(); ++row) {
    const std::size_t first = grid.rows[point_of(grid, rows, row)];
    if (std::ranges::equal(grid.at(first), grid.at(row))) continue;
    file.refuse_line(line_of(file, row),
                     fmt::format("the directions of line {} with other values", line_of(file, first)));
  }
  return grid;
}

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Rows of so many numbers as a matrix.
Eigen::MatrixXd numbers_of(const std::vector<double>& values, std::size_t numbers) {
  const auto columns = static_cast<Eigen::Index>(numbers);
  return Eigen::Map<const RowMajor>(values.data(), static_cast<Eigen::Index>(values.size()) / columns, columns);
}

/// General columns with one azimuth of the light: isotropic.
ScatteredSamples samples_of(const Header& header, const Rows& rows) {
  SampleCollector samples(header.channels.size());
  samples.reserve(rows.count());
  const bool has_two_azimuths = header.angles.size() == kGeneral.size();
  const auto& azimuths = rows.angles[1];
  const bool is_isotropic =
      !has_two_azimuths || std::ranges::all_of(azimuths, [&](double phi) { return phi == azimuths.front(); });
  for (std::size_t row = 0; row < rows.count(); ++row) {
    const auto angle = [&](std::size_t column) { return rows.angles[column][row]; };
    const Directions pair = has_two_azimuths ? Directions{angle(0), angle(2), angle(3) - angle(1), angle(1)}
                                             : Directions{angle(0), angle(1), angle(2), 0};
    samples.add(pair, std::span(rows.values).subspan(row * header.numbers(), header.channels.size()));
  }
  ScatteredSamples all = samples.take(is_isotropic);
  if (header.has_deviations) all.deviations = numbers_of(rows.values, header.numbers()).rightCols(all.values.cols());
  return all;
}

/// The values of a grid without the standard deviations beside them, and with the replicates that are asked for.
void take_deviations(Grid& grid, const Header& header, const ReadOptions& options, BrdfFunction& brdf) {
  const Eigen::MatrixXd numbers = numbers_of(grid.values, header.numbers());
  const auto channels = static_cast<Eigen::Index>(header.channels.size());
  brdf.has_deviations = true;
  brdf.replicates =
      possible_replicates(options.replicates, static_cast<std::size_t>(numbers.size()) / 2, kMostReplicated);
  const Eigen::MatrixXd all = with_replicates(numbers.leftCols(channels), numbers.rightCols(channels), brdf.replicates);
  grid.channels = static_cast<std::size_t>(all.cols());
  grid.values.resize(static_cast<std::size_t>(all.size()));
  Eigen::Map<RowMajor>(grid.values.data(), all.rows(), all.cols()) = all;
}

/// How many of the values of so many channels are negative, and how many there are.
std::pair<std::size_t, std::size_t> negative_values(const Grid& grid, std::size_t channels) {
  std::size_t negative = 0;
  const std::size_t rows = grid.values.size() / grid.channels;
  for (std::size_t row = 0; row < rows; ++row) {
    const auto values = grid.at(row).first(channels);
    negative += static_cast<std::size_t>(std::ranges::count_if(values, [](double value) { return value < 0; }));
  }
  return {negative, rows * channels};
}

/// Linear in each angle, constant beyond the outermost theta.
BrdfValues evaluate(const Grid& grid, std::span<const Directions> pairs) {
  BrdfValues values;
  values.value.setZero(static_cast<Eigen::Index>(pairs.size()), static_cast<Eigen::Index>(grid.channels));
  const std::size_t dimensions = grid.axes.size();
  std::array<Place, kGeneral.size()> places{};
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const auto [theta_in, theta_out, delta_phi, phi_in] = pairs[p];
    const double turned = grid.folds ? std::abs(std::remainder(delta_phi, 2 * std::numbers::pi)) : delta_phi;
    const std::array<double, 4> isotropic{theta_in, theta_out, turned, 0};
    const std::array<double, 4> general{theta_in, phi_in, theta_out, phi_in + delta_phi};
    const auto& angles = dimensions == kIsotropic.size() ? isotropic : general;
    for (std::size_t a = 0; a < dimensions; ++a) places[a] = place_on(grid.axes[a], angles[a]);
    for (unsigned corner = 0; corner < 1U << dimensions; ++corner) {
      double weight = 1;
      std::size_t point = 0;
      for (std::size_t a = 0; a < dimensions; ++a) {
        const bool is_after = (corner >> a & 1U) != 0;
        weight *= is_after ? places[a].share : 1 - places[a].share;
        point = point * grid.axes[a].nodes.size() + (is_after ? places[a].after : places[a].before);
      }
      if (weight == 0) continue;
      const auto found = grid.at(grid.rows[point]);
      for (std::size_t c = 0; c < grid.channels; ++c) {
        values.value(static_cast<Eigen::Index>(p), static_cast<Eigen::Index>(c)) += weight * found[c];
      }
    }
  }
  return values;
}

BrdfFunction read(const FileBytes& file, const ReadOptions& options) {
  LineReader lines(file);
  if (!next_row(lines)) file.refuse_at(file.size(), "the file ends before the names of columns");
  const Header header = header_of(lines);
  Rows rows = read_rows(lines, header);
  BrdfFunction brdf;
  brdf.name = file.stem();
  brdf.format = kCsvFormat.title;
  brdf.conventions =
      "sr^-1 without cosine; degrees; directions away from the surface, azimuth differences of 180 degrees are the "
      "mirror side";
  brdf.channels = header.channels;
  brdf.wavelengths = header.wavelengths;
  std::string sizes;
  auto complete = grid_of(file, header, rows, sizes);
  if (!complete) {
    if (rows.count() < kFewest) {
      lines.refuse(fmt::format("{} rows make no complete grid of {}", rows.count(), sizes));
    }
    brdf.remarks.push_back(
        fmt::format("{} rows make no complete grid of {}: they are scattered samples", rows.count(), sizes));
    require_room(file, rows.count(), header.channels.size());
    const ScatteredSamples samples = samples_of(header, rows);
    rows = {};
    interpolate(file, samples, options, brdf);
    return brdf;
  }
  if (header.has_deviations) take_deviations(*complete, header, options, brdf);
  const auto grid = std::make_shared<const Grid>(*std::move(complete));
  brdf.conventions += "; linear between the angles, the outermost values beyond them";
  brdf.is_isotropic = header.angles.size() == kIsotropic.size();
  brdf.is_bilateral = grid->folds;
  const auto [negative, count] = negative_values(*grid, header.channels.size());
  if (negative > 0) brdf.remarks.push_back(fmt::format("{} of {} values are negative, and kept", negative, count));
  brdf.at = [grid](std::span<const Directions> pairs) { return evaluate(*grid, pairs); };
  return brdf;
}

// --- Writing.

/// Degrees: 0, step, 2 step, ... below an end.
std::vector<double> steps(double step, double end) {
  std::vector<double> angles;
  for (int i = 0; i * step < end; ++i) angles.push_back(i * step);
  return angles;
}

/// To the horizon, where functions may be anything, but not quite.
std::vector<double> polar_steps(double step) {
  auto angles = steps(step, 90);
  angles.push_back(89);
  return angles;
}

struct Row {
  std::array<double, 4> degrees;  // of the columns
  Directions pair;
};

std::vector<Row> isotropic_rows(bool is_bilateral) {
  auto azimuths = steps(5, is_bilateral ? 181 : 360);
  std::vector<Row> rows;
  for (const double in : polar_steps(5)) {
    for (const double out : polar_steps(5)) {
      for (const double phi : azimuths) {
        rows.push_back({{in, out, phi}, {in * kDegree, out * kDegree, phi * kDegree, 0}});
      }
    }
  }
  return rows;
}

std::vector<Row> general_rows() {
  const auto azimuths = steps(15, 360);
  std::vector<Row> rows;
  for (const double in : polar_steps(10)) {
    for (const double phi_in : azimuths) {
      for (const double out : polar_steps(10)) {
        for (const double phi_out : azimuths) {
          rows.push_back({{in, phi_in, out, phi_out},
                          {in * kDegree, out * kDegree, (phi_out - phi_in) * kDegree, phi_in * kDegree}});
        }
      }
    }
  }
  return rows;
}

std::string comment(std::string_view what, std::string_view text) {
  return text.empty() ? "" : fmt::format("# {}: {}\n", what, printable(text));
}

std::string write(const BrdfFunction& brdf, const WriteOptions& options) {
  std::string content =
      "# reflectance in sr^-1, without a cosine; azimuth differences of 180 degrees are the mirror side\n";
  content += comment("name", brdf.name) + comment("from", brdf.format) + comment("conventions", brdf.conventions);
  for (const auto& remark : brdf.remarks) content += comment("remark", remark);
  content += comment("written by", options.command_line);

  const std::span<const std::string_view> angles =
      brdf.is_isotropic ? std::span<const std::string_view>(kIsotropic) : std::span<const std::string_view>(kGeneral);
  for (const auto column : angles) content += fmt::format("{}{}", column == angles.front() ? "" : ",", column);
  const std::span<const std::string> channels = std::span(brdf.channels).first(own_channels(brdf));
  for (const auto& name : channels) {
    const bool is_plain = std::ranges::none_of(name, [](unsigned char c) { return c < ' ' || c == ',' || c == '"'; });
    if (trim(name).empty() || trim(name) != name || !is_plain) {
      throw ArgumentError(
          fmt::format("channel '{}' cannot be written as CSV; expected a name without commas and quotes", name));
    }
    content += "," + name;
  }
  for (const auto& name : channels) {
    if (brdf.replicates > 0) content += "," + name + std::string(kDeviation);
  }
  content += '\n';

  const auto rows = brdf.is_isotropic ? isotropic_rows(brdf.is_bilateral) : general_rows();
  std::vector<Directions> pairs;
  for (const Row& row : rows) pairs.push_back(row.pair);
  const Eigen::MatrixXd values = brdf.at(pairs).value;
  const auto deviations = measurement_deviations(brdf, values);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t a = 0; a < angles.size(); ++a) content += (a == 0 ? "" : ",") + shortest(rows[i].degrees[a]);
    for (std::size_t c = 0; c < channels.size(); ++c) {
      const double value = values(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(c));
      if (!std::isfinite(value)) {
        throw NumericError(
            fmt::format("'{}' is {} at theta_in {}, theta_out {} degrees; only finite numbers are written", brdf.name,
                        value, rows[i].pair.theta_in / kDegree, rows[i].pair.theta_out / kDegree));
      }
      content += "," + shortest(value);
    }
    for (const auto& of_channel : deviations) content += "," + shortest(of_channel[i]);
    content += '\n';
  }
  return content;
}

}  // namespace

const Format kCsvFormat{.name = "csv",
                        .title = "CSV of directions and values",
                        .recognises = recognises,
                        .read = read,
                        .write = write,
                        .holds_deviations = true};

}  // namespace lobe
