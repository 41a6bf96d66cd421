// Samples of the library ALTA, as text and as binary.
// Source: ALTA (Belcour et al., belcour/alta), core/data_storage.cpp and core/params.h.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <string_view>
#include <utility>

#include "core/text.hpp"
#include "formats/byte_reader.hpp"
#include "formats/format.hpp"
#include "formats/line_reader.hpp"
#include "formats/scattered_brdf.hpp"
#include "hemisphere/unit_vector.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"

namespace lobe {
namespace {

using std::numbers::pi;
using Vector = Eigen::Vector3d;

constexpr std::size_t kMostOutputs = 1000;
constexpr std::size_t kQuoted = 40;    // characters of the file that complaints show
constexpr double kLeastCosine = 1e-3;  // that values are divided by
constexpr double kRounding = 1e-9;     // of cosines at the horizon

/// Light and viewer.
struct Pair {
  Vector light;
  Vector view;
};

/// How a row names a pair of directions.
struct Parametrisation {
  std::string_view name;
  std::size_t inputs;
  bool is_isotropic;
  Pair (*pair)(const double* in);
};

Pair rusinkiewicz(const double* in) {
  const Eigen::AngleAxisd tilt(in[0], Vector::UnitY());
  return {tilt * unit_vector(in[1], in[2]), tilt * unit_vector(in[1], in[2] + pi)};
}

constexpr std::string_view kSlice = "COS_TH";
const std::array kParametrisations{
    Parametrisation{"RUSIN_TH_TD_PD", 3, true, rusinkiewicz},
    Parametrisation{"SPHERICAL_TL_PL_TV_PV", 4, false,
                    [](const double* in) {
                      return Pair{unit_vector(in[0], in[1]), unit_vector(in[2], in[3])};
                    }},
    Parametrisation{"ISOTROPIC_TV_TL_DPHI", 3, true,
                    [](const double* in) {
                      return Pair{unit_vector(in[1], 0), unit_vector(in[0], in[2])};
                    }},
    Parametrisation{
        "ISOTROPIC_TL_TV_PROJ_DPHI", 3, true,
        [](const double* in) {
          return Pair{unit_vector(in[0], 0), unit_vector(std::hypot(in[1], in[2]), std::atan2(in[2], in[1]))};
        }},
    Parametrisation{"CARTESIAN", 6, false,
                    [](const double* in) {
                      return Pair{Vector(in[3], in[4], in[5]).normalized(), Vector(in[0], in[1], in[2]).normalized()};
                    }},
    // The half-vector of light and viewer in one direction.
    Parametrisation{kSlice, 1, true, [](const double* in) {
                      const Vector half = unit_vector(std::acos(std::clamp(in[0], -1.0, 1.0)), 0);
                      return Pair{half, half};
                    }}};

struct Header {
  const Parametrisation* parametrisation = nullptr;
  std::string output;
  std::size_t inputs = 0;
  std::size_t outputs = 0;
  std::size_t intervals = 0;  ///< columns of them
  bool is_binary = false;
  double samples = -1;  ///< announced
  struct {
    std::size_t dim = 0;
    std::size_t param_in = 0;
    std::size_t param_out = 0;
    std::size_t vs = 0;
  } lines;                 ///< where the keys stand
  std::size_t line = 0;    ///< number of the first line of the data
  std::size_t offset = 0;  ///< offset of the data

  [[nodiscard]] std::size_t columns() const { return inputs + outputs + intervals; }
};

bool is_end(std::string_view line) {
  return line.starts_with("#ALTA_END_HEADER") || line.starts_with("#ALTA END HEADER");
}

bool recognises(const FileBytes& head) {
  bool has_dimensions = false;
  bool has_parameters = false;
  LineReader lines(head);
  while (lines.next() && lines.line().starts_with('#') && !is_end(lines.line())) {
    has_dimensions = has_dimensions || lines.line().starts_with("#DIM");
    has_parameters = has_parameters || lines.line().starts_with("#PARAM_IN");
  }
  return has_dimensions && has_parameters;
}

const Parametrisation* find_parametrisation(std::string_view name, const LineReader& lines) {
  std::string known;
  for (const Parametrisation& one : kParametrisations) {
    if (one.name == name) return &one;
    known += (known.empty() ? "" : ", ") + std::string(one.name);
  }
  lines.refuse(fmt::format("PARAM_IN {} is not read; those that are: {}", name.substr(0, kQuoted), known));
}

std::size_t read_count(const LineReader& lines, std::string_view word, std::string_view what) {
  double value = 0;
  if (!parse_number(word, value) || value != std::floor(value) || !(value >= 0 && value <= kMostOutputs)) {
    lines.refuse(fmt::format("no number of {}; expected 0 to {}", what, kMostOutputs));
  }
  return static_cast<std::size_t>(value);
}

void read_key(Header& header, std::string_view key, std::string_view rest, const LineReader& lines) {
  const auto value = [&] { return take_word(rest); };
  const auto demand = [&](std::string_view expected) {
    const auto found = value();
    if (found != expected) {
      lines.refuse(fmt::format("{} {}; expected {}", key.substr(1), found.substr(0, kQuoted), expected));
    }
  };
  if (key == "#DIM") {
    header.lines.dim = lines.number();
    header.inputs = read_count(lines, value(), "inputs");
    header.outputs = read_count(lines, value(), "outputs");
  } else if (key == "#PARAM_IN") {
    header.lines.param_in = lines.number();
    header.parametrisation = find_parametrisation(value(), lines);
  } else if (key == "#PARAM_OUT") {
    header.lines.param_out = lines.number();
    header.output = value();
  } else if (key == "#VS") {
    header.lines.vs = lines.number();
    header.intervals = 0;
    for (auto word = value(); !word.empty(); word = value()) {
      if (word != "0" && word != "1" && word != "2") lines.refuse("VS is neither 0, 1 nor 2");
      header.intervals += static_cast<std::size_t>(word[0] - '0');
    }
  } else if (key == "#FORMAT") {
    demand("binary");
    header.is_binary = true;
  } else if (key == "#VERSION") {
    demand("0");
  } else if (key == "#ENDIAN") {
    demand("little");
  } else if (key == "#PRECISION") {
    demand("ieee754-double");
  } else if (key == "#SAMPLE_COUNT") {
    if (!parse_number(value(), header.samples) || !(header.samples >= 0)) lines.refuse("no number of samples");
  }
}

Header read_header(const FileBytes& file) {
  Header header;
  LineReader lines(file);
  header.line = 1;
  while (lines.next() && lines.line().starts_with('#')) {
    header.offset = lines.offset();
    header.line = lines.number() + 1;
    if (is_end(lines.line())) break;
    std::string_view rest = lines.line();
    const auto key = take_word(rest);
    read_key(header, key, rest, lines);
  }
  if (header.parametrisation == nullptr || header.lines.dim == 0) {
    file.refuse_line(header.line - 1, "the header ends without #DIM or #PARAM_IN");
  }
  if (header.outputs == 0) file.refuse_line(header.lines.dim, "DIM has no outputs");
  if (header.inputs != header.parametrisation->inputs) {
    file.refuse_line(header.lines.dim, fmt::format("DIM has {} inputs; PARAM_IN {} has {}", header.inputs,
                                                   header.parametrisation->name, header.parametrisation->inputs));
  }
  if (header.intervals > 2 * header.outputs) file.refuse_line(header.lines.vs, "VS has more intervals than outputs");
  return header;
}

/// Rows of inputs, outputs and intervals.
std::vector<double> read_text(const FileBytes& file, const Header& header) {
  LineReader lines(file);
  while (lines.number() + 1 < header.line && lines.next()) {
  }
  std::vector<double> rows;
  rows.reserve(lines.most_rows(header.columns()) * header.columns());
  while (lines.next_filled()) {
    if (lines.line().starts_with('#')) continue;
    const auto numbers = lines.numbers(header.columns());
    if (numbers.size() != header.columns()) {
      lines.refuse(fmt::format("{} numbers; expected {}", numbers.size(), header.columns()));
    }
    rows.insert(rows.end(), numbers.begin(), numbers.end());
  }
  return rows;
}

std::vector<double> read_binary(const FileBytes& file, const Header& header) {
  constexpr std::string_view kBegin = "#BEGIN_STREAM\n";
  constexpr std::string_view kEnd = "\n#END_STREAM";
  if (header.samples < 0) file.refuse_line(header.line - 1, "the header ends without #SAMPLE_COUNT");
  std::size_t offset = header.offset;
  if (file.content().substr(offset).starts_with(kBegin)) offset += kBegin.size();
  const std::size_t there = (file.size() - offset) / (sizeof(double) * header.columns());
  if (header.samples > static_cast<double>(there)) {
    file.refuse_at(file.size(), fmt::format("the file ends after {} of {} samples", there, header.samples));
  }
  const std::size_t count = static_cast<std::size_t>(header.samples) * header.columns();
  ByteReader bytes(file, offset);
  std::vector<double> rows(count);
  for (double& value : rows) {
    const std::size_t at = bytes.offset();
    value = bytes.read<double>("the samples");
    if (!std::isfinite(value)) file.refuse_at(at, "no finite number");
  }
  if (bytes.remaining() > 0 && !file.content().substr(bytes.offset()).starts_with(kEnd)) {
    file.refuse_at(bytes.offset(), "the file goes on after the last sample");
  }
  return rows;
}

/// f by the cosine of theta_h, linear in theta_h.
struct Slice {
  std::vector<double> angles;  ///< rising
  Eigen::MatrixXd values;

  [[nodiscard]] BrdfValues at(std::span<const Directions> pairs) const {
    BrdfValues found{Eigen::MatrixXd(static_cast<Eigen::Index>(pairs.size()), values.cols()), {}};
    Eigen::Index row = 0;
    for (const Directions& pair : pairs) {
      const Vector half = unit_vector(pair.theta_in, 0) + unit_vector(pair.theta_out, pair.delta_phi);
      const double angle = std::atan2(std::hypot(half.x(), half.y()), half.z());
      const auto above = std::ranges::lower_bound(angles, angle);
      const auto high = std::min<Eigen::Index>(above - angles.begin(), values.rows() - 1);
      const Eigen::Index low = std::max<Eigen::Index>(high - 1, 0);
      const double from = angles[static_cast<std::size_t>(low)];
      const double to = angles[static_cast<std::size_t>(high)];
      const double share = to > from ? std::clamp((angle - from) / (to - from), 0.0, 1.0) : 1;
      found.value.row(row++) = (1 - share) * values.row(low) + share * values.row(high);
    }
    return found;
  }
};

Slice slice_of(const FileBytes& file, const ScatteredSamples& samples) {
  if (samples.pairs.empty()) file.refuse_end("it has no samples");
  std::vector<Eigen::Index> order(samples.pairs.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<Eigen::Index>(i);
  const auto angle_of = [&](Eigen::Index i) { return samples.pairs[static_cast<std::size_t>(i)].theta_in; };
  std::ranges::stable_sort(order, {}, angle_of);
  Slice slice;
  for (const Eigen::Index i : order) slice.angles.push_back(angle_of(i));
  slice.values = samples.values(order, Eigen::seqN(0, samples.values.cols()));
  return slice;
}

bool is_unit(const Vector& vector) {
  return std::abs(vector.squaredNorm() - 1) < kRounding;
}

/// Rows as samples; those that mean nothing are left out and counted.
ScatteredSamples samples_of(const Header& header, const std::vector<double>& rows, BrdfFunction& brdf) {
  const bool has_cosine = header.output == "INV_STERADIAN_COSINE_FACTOR";
  const std::size_t count = rows.size() / header.columns();
  SampleCollector samples(header.outputs);
  std::size_t lost = 0;
  std::size_t below = 0;
  std::size_t grazing = 0;
  std::vector<double> values(header.outputs);
  for (std::size_t i = 0; i < count; ++i) {
    const double* row = &rows[i * header.columns()];
    const Pair pair = header.parametrisation->pair(row);
    const double cosine = pair.view.z();
    if (!is_unit(pair.light) || !is_unit(pair.view)) {
      ++lost;
      continue;
    }
    if (!(std::min(pair.light.z(), cosine) >= -kRounding)) {
      ++below;
      continue;
    }
    if (has_cosine && cosine < kLeastCosine) {
      ++grazing;
      continue;
    }
    for (std::size_t c = 0; c < values.size(); ++c) values[c] = row[header.inputs + c] / (has_cosine ? cosine : 1);
    const double phi_in = std::atan2(pair.light.y(), pair.light.x());
    samples.add({std::atan2(std::hypot(pair.light.x(), pair.light.y()), pair.light.z()),
                 std::atan2(std::hypot(pair.view.x(), pair.view.y()), cosine),
                 std::atan2(pair.view.y(), pair.view.x()) - phi_in, phi_in},
                values);
  }
  if (lost > 0) {
    brdf.remarks.push_back(
        fmt::format("{} of {} samples have a vector without direction, and are left out", lost, count));
  }
  if (below > 0) {
    brdf.remarks.push_back(fmt::format("{} of {} samples are below the horizon, and left out", below, count));
  }
  if (grazing > 0) {
    brdf.remarks.push_back(
        fmt::format("{} of {} samples have a viewer at the horizon, whose values hold a cosine of 0, and are left out",
                    grazing, count));
  }
  return samples.take(header.parametrisation->is_isotropic);
}

/// Kind of the values; ALTA takes values of unknown kind as they are.
std::string output_of(const Header& header) {
  const bool is_unknown = header.output.empty() || header.output == "UNKNOWN" || header.output == "UNKNOWN_OUTPUT";
  return is_unknown ? "INV_STERADIAN" : header.output;
}

std::vector<std::string> channels_of(const FileBytes& file, const Header& header) {
  const bool is_rgb = header.output == "RGB_COLOR";
  if (is_rgb || header.output == "XYZ_COLOR") {
    if (header.outputs != 3) {
      file.refuse_line(header.lines.param_out,
                       fmt::format("{} has {} outputs; expected 3", header.output, header.outputs));
    }
    return is_rgb ? std::vector<std::string>{"red", "green", "blue"} : std::vector<std::string>{"X", "Y", "Z"};
  }
  if (header.output != "INV_STERADIAN" && header.output != "INV_STERADIAN_COSINE_FACTOR") {
    file.refuse_line(
        header.lines.param_out,
        fmt::format("PARAM_OUT '{}' is not read; those that are: INV_STERADIAN, INV_STERADIAN_COSINE_FACTOR, "
                    "RGB_COLOR, XYZ_COLOR",
                    header.output.substr(0, kQuoted)));
  }
  if (header.outputs == 1) return {"value"};
  std::vector<std::string> names;
  for (std::size_t c = 1; c <= header.outputs; ++c) names.push_back("value " + std::to_string(c));
  return names;
}

BrdfFunction read(const FileBytes& file, const ReadOptions& options) {
  Header header = read_header(file);
  BrdfFunction brdf;
  if (const std::string output = output_of(header); output != header.output) {
    brdf.remarks.push_back(
        fmt::format("the header {}; values are taken for sr^-1 without a cosine",
                    header.output.empty() ? std::string("has no PARAM_OUT") : "says PARAM_OUT " + header.output));
    header.output = output;
  }
  brdf.name = file.stem();
  brdf.format = kAltaFormat.title;
  brdf.channels = channels_of(file, header);
  brdf.conventions = fmt::format("{}, {}", header.output, header.parametrisation->name);
  if (header.output == "INV_STERADIAN_COSINE_FACTOR") {
    brdf.conventions += ", divided by the cosine of the viewer";
  }
  const auto samples = samples_of(header, header.is_binary ? read_binary(file, header) : read_text(file, header), brdf);
  if (header.parametrisation->name == kSlice) {
    brdf.conventions += "; taken where light and viewer coincide, and used for all pairs by their half-vector";
    brdf.is_bilateral = true;
    brdf.at = [slice = std::make_shared<const Slice>(slice_of(file, samples))](std::span<const Directions> pairs) {
      return slice->at(pairs);
    };
    return brdf;
  }
  interpolate(file, samples, options, brdf);
  return brdf;
}

/// A grid of all polar angles of viewer and light from 0 to 85 degrees in steps of 5, and of azimuths in steps of 10.
std::vector<Directions> grid_of(bool is_bilateral) {
  std::vector<Directions> pairs;
  for (int out = 0; out <= 85; out += 5) {
    for (int in = 0; in <= 85; in += 5) {
      for (int phi = 0; phi <= (is_bilateral ? 180 : 350); phi += 10) {
        pairs.push_back({in * kDegree, out * kDegree, phi * kDegree, 0});
      }
    }
  }
  return pairs;
}

std::string write(const BrdfFunction& brdf, const WriteOptions& options) {
  if (!brdf.is_isotropic) {
    throw ArgumentError(
        fmt::format("'{}' is anisotropic; ALTA files are written of isotropic reflectances", brdf.name));
  }
  const bool is_rgb = brdf.channels == std::vector<std::string>{"red", "green", "blue"};
  std::string text = fmt::format("#ALTA_BEGIN_HEADER\n#DIM 3 {}\n#PARAM_IN ISOTROPIC_TV_TL_DPHI\n#PARAM_OUT {}\n#VS",
                                 brdf.channels.size(), is_rgb ? "RGB_COLOR" : "INV_STERADIAN");
  for (std::size_t c = 0; c < brdf.channels.size(); ++c) text += " 0";
  if (!options.command_line.empty()) text += "\n#CMD " + printable(options.command_line);
  text += "\n#ALTA_END_HEADER\n";
  const auto pairs = grid_of(brdf.is_bilateral);
  const Eigen::MatrixXd values = brdf.at(pairs).value;
  if (!values.allFinite()) throw NumericError("'" + brdf.name + "' has values that are no finite numbers");
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    text += fmt::format("{} {} {}", shortest(pairs[i].theta_out), shortest(pairs[i].theta_in),
                        shortest(pairs[i].delta_phi));
    for (const double value : values.row(static_cast<Eigen::Index>(i))) text += " " + shortest(value);
    text += '\n';
  }
  return text;
}

}  // namespace

const Format kAltaFormat{"alta", "ALTA text and binary", recognises, read, false, write};

}  // namespace lobe
