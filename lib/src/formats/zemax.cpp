// Tables of scatter about the specular direction, as Zemax OpticStudio reads them.
// Geometry: the help of OpticStudio, and the converter that wrote the measurements at hand (ua-loft/bsdf-tools,
// fred_frame_to_zemax.m).
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <string_view>
#include <utility>

#include "core/text.hpp"
#include "energy/albedo.hpp"
#include "formats/format.hpp"
#include "formats/line_reader.hpp"
#include "formats/rectilinear.hpp"
#include "formats/scattered_brdf.hpp"
#include "formats/specular_frame.hpp"
#include "hemisphere/unit_vector.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"

namespace lobe {
namespace {

using std::numbers::pi;

/// Lines that are neither blank nor comments.
class ZemaxLines {
 public:
  explicit ZemaxLines(const FileBytes& file) : lines_(file) {}

  [[nodiscard]] bool next() {
    while (lines_.next_filled()) {
      if (!trim(lines_.line()).starts_with('#')) return true;
    }
    return false;
  }
  void expect(std::string_view what) {
    if (!next()) lines_.refuse(fmt::format("the file ends; expected {}", what));
  }
  [[nodiscard]] std::string_view line() const { return lines_.line(); }
  [[nodiscard]] std::vector<double> numbers(std::size_t most) const { return lines_.numbers(most); }
  [[nodiscard]] std::size_t most_rows(std::size_t numbers) const { return lines_.most_rows(numbers); }
  [[noreturn]] void refuse(std::string_view complaint) const { lines_.refuse(complaint); }

 private:
  LineReader lines_;
};

struct Header {
  std::string symmetry;
  std::string content;
  std::vector<double> rotations;  ///< degrees, as all
  std::vector<double> incidences;
  std::vector<double> azimuths;
  std::vector<double> radials;

  [[nodiscard]] bool is_anisotropic() const { return rotations.size() > 1; }
  /// For turned samples, the other side of each plane of incidence is the one in the file.
  [[nodiscard]] bool mirrors() const { return is_anisotropic() && symmetry == "PlaneSymmetrical"; }
  [[nodiscard]] std::size_t blocks() const { return rotations.size() * incidences.size(); }
};

bool recognises(const FileBytes& head) {
  constexpr int kLines = 20;  // that hold more than a comment
  ZemaxLines lines(head);
  for (int i = 0; i < kLines && lines.next(); ++i) {
    std::string_view rest = lines.line();
    const std::string_view word = take_word(rest);
    if (word == "SampleRotation" || word == "ScatterType") return true;
    if (word != "Source" && word != "Symmetry" && word != "SpectralContent") return false;
  }
  return false;
}

/// A list of as many rising angles as announced, on as many lines as it takes.
std::vector<double> read_angles(ZemaxLines& lines, std::string_view name, std::string_view announced, double least,
                                double most) {
  constexpr double kMostAngles = 10000;
  double count = 0;
  if (!parse_number(announced, count) || !(count >= 1 && count <= kMostAngles) || count != std::floor(count)) {
    lines.refuse(fmt::format("no number of angles after {}; expected 1 to {}", name, kMostAngles));
  }
  std::vector<double> angles;
  while (static_cast<double>(angles.size()) < count) {
    lines.expect(fmt::format("{} angles of {}", count, name));
    for (const double angle : lines.numbers(static_cast<std::size_t>(count))) {
      if (!(angle >= least && angle <= most) || (!angles.empty() && angle <= angles.back())) {
        lines.refuse(
            fmt::format("angle {} of {}; expected rising ones from {} to {} degrees", angle, name, least, most));
      }
      angles.push_back(angle);
    }
    if (static_cast<double>(angles.size()) > count) lines.refuse(fmt::format("expected {} angles of {}", count, name));
  }
  return angles;
}

Header read_header(ZemaxLines& lines) {
  Header header;
  while (header.radials.empty()) {
    lines.expect("SampleRotation, AngleOfIncidence, ScatterAzimuth and ScatterRadial");
    std::string_view rest = lines.line();
    const std::string_view key = take_word(rest);
    const std::string_view value = take_word(rest);
    if (key == "Symmetry") {
      header.symmetry = value;
    } else if (key == "SpectralContent") {
      header.content = value;
    } else if (key == "ScatterType") {
      if (value == "BTDF") lines.refuse("it is a transmission; expected ScatterType BRDF");
      if (value != "BRDF") lines.refuse(fmt::format("ScatterType '{}'; expected BRDF", value.substr(0, 40)));
    } else if (key == "SampleRotation") {
      header.rotations = read_angles(lines, key, value, 0, 360);
    } else if (key == "AngleOfIncidence") {
      header.incidences = read_angles(lines, key, value, 0, 90);
    } else if (key == "ScatterAzimuth") {
      header.azimuths = read_angles(lines, key, value, 0, 360);
    } else if (key == "ScatterRadial") {
      header.radials = read_angles(lines, key, value, 0, 180);
    } else if (key != "Source") {
      lines.refuse(fmt::format("unknown key '{}'", key.substr(0, 40)));
    }
  }
  if (header.rotations.empty() || header.incidences.empty() || header.azimuths.empty()) {
    lines.refuse("SampleRotation, AngleOfIncidence or ScatterAzimuth is missing before ScatterRadial");
  }
  if (header.mirrors() && header.azimuths.back() > 180) {
    lines.refuse(fmt::format("ScatterAzimuth {} with PlaneSymmetrical; expected 0 to 180", header.azimuths.back()));
  }
  if (header.content != "Monochrome" && header.content != "XYZ") {
    lines.refuse(fmt::format("SpectralContent '{}'; expected Monochrome or XYZ", header.content.substr(0, 40)));
  }
  return header;
}

/// The values of a section, by rotation, incidence, azimuth and radial angle.
std::vector<double> read_section(ZemaxLines& lines, const Header& header, std::string_view name) {
  lines.expect(name);
  if (trim(lines.line()) != name) lines.refuse(fmt::format("expected '{}'", name));
  lines.expect("DataBegin");
  if (trim(lines.line()) != "DataBegin") lines.refuse("expected 'DataBegin'");
  std::vector<double> values;
  const std::size_t rows = std::min(header.blocks() * header.azimuths.size(), lines.most_rows(header.radials.size()));
  values.reserve(rows * header.radials.size());
  for (std::size_t block = 0; block < header.blocks(); ++block) {
    lines.expect("TIS");
    if (!trim(lines.line()).starts_with("TIS")) lines.refuse("expected 'TIS' before a block of values");
    for (std::size_t row = 0; row < header.azimuths.size(); ++row) {
      lines.expect("a row of values");
      const auto numbers = lines.numbers(header.radials.size());
      if (numbers.size() != header.radials.size()) {
        lines.refuse(fmt::format("{} values; expected {}", numbers.size(), header.radials.size()));
      }
      values.insert(values.end(), numbers.begin(), numbers.end());
    }
  }
  lines.expect("DataEnd");
  if (trim(lines.line()) != "DataEnd") lines.refuse("expected 'DataEnd'");
  return values;
}

ScatteredSamples samples_of(const Header& header, const std::vector<std::vector<double>>& sections,
                            BrdfFunction& brdf) {
  constexpr double kHorizon = 1e-6;  // cosine
  SampleCollector samples(sections.size());
  std::size_t zeros = 0;
  std::size_t below = 0;
  std::size_t at = 0;
  std::vector<double> values(sections.size());
  for (const double rotation : header.rotations) {
    for (const double incidence : header.incidences) {
      for (const double azimuth : header.azimuths) {
        for (const double radial : header.radials) {
          for (std::size_t c = 0; c < sections.size(); ++c) values[c] = sections[c][at];
          ++at;
          if (radial == 0 && azimuth != header.azimuths.front()) continue;
          const Eigen::Vector3d v = scattered_direction(incidence * kDegree, azimuth * kDegree, radial * kDegree);
          const bool is_zero = std::ranges::all_of(values, [](double value) { return value == 0; });
          if (v.z() < -kHorizon) {
            if (!is_zero) ++below;
          } else if (is_zero) {
            ++zeros;
          } else {
            // The light stands opposite to the specular direction, whose azimuth is that of the turned sample.
            Directions pair{incidence * kDegree, std::acos(std::clamp(v.z(), 0.0, 1.0)), std::atan2(v.y(), v.x()) - pi,
                            pi - rotation * kDegree};
            samples.add(pair, values);
            const bool is_in_plane = radial == 0 || azimuth == 0 || azimuth == 180;
            if (!header.mirrors() || is_in_plane) continue;
            pair.delta_phi = -pair.delta_phi;
            samples.add(pair, values);
          }
        }
      }
    }
  }
  if (zeros > 0) {
    brdf.remarks.push_back(
        fmt::format("{} values above the horizon are 0, which marks what was not measured, and are left out", zeros));
  }
  if (below > 0) {
    brdf.remarks.push_back(fmt::format("{} values below the horizon are not 0, and are left out", below));
  }
  return samples.take(!header.is_anisotropic());
}

/// An axis of azimuths that go round; nothing where they leave a gap.
std::optional<GridAxis> round_axis(const std::vector<double>& degrees, std::size_t stride) {
  GridAxis axis{{}, AxisEnds::circular, stride};
  double widest = 0;
  for (const double angle : degrees) {
    if (angle == 360 && degrees.front() == 0) continue;
    if (!axis.nodes.empty()) widest = std::max(widest, angle * kDegree - axis.nodes.back());
    axis.nodes.push_back(angle * kDegree);
  }
  constexpr double kRounding = 1e-6;
  if (axis.nodes.front() + 2 * pi - axis.nodes.back() > widest + kRounding) return {};
  return axis;
}

std::vector<double> radians_of(std::vector<double> degrees) {
  for (double& angle : degrees) angle *= kDegree;
  return degrees;
}

/// The values of a turned sample by rotation, incidence, azimuth and radial angle, where all above the horizon have
/// been measured; those below are the outermost ones above.
std::shared_ptr<const RectilinearGrid> grid_of(const Header& header, const std::vector<std::vector<double>>& sections) {
  constexpr double kHorizon = 1e-6;  // cosine
  const std::size_t row = header.radials.size();
  const std::size_t block = header.azimuths.size() * row;
  auto rotations = round_axis(header.rotations, header.incidences.size() * block);
  auto azimuths = header.mirrors() ? GridAxis{radians_of(header.azimuths), AxisEnds::mirrored, row}
                                   : round_axis(header.azimuths, row);
  if (!header.is_anisotropic() || !rotations || !azimuths) return nullptr;
  std::vector<double> values(sections.front().size() * sections.size());
  for (std::size_t at = 0; at < sections.front().size(); ++at) {
    const double incidence = header.incidences[at / block % header.incidences.size()] * kDegree;
    const double azimuth = header.azimuths[at / row % header.azimuths.size()] * kDegree;
    const double radial = header.radials[at % row] * kDegree;
    const bool is_above = scattered_direction(incidence, azimuth, radial).z() >= -kHorizon;
    bool is_zero = true;
    for (std::size_t c = 0; c < sections.size(); ++c) {
      is_zero = is_zero && sections[c][at] == 0;
      if (!is_above && at % row == 0) return nullptr;
      values[at * sections.size() + c] = is_above ? sections[c][at] : values[(at - 1) * sections.size() + c];
    }
    if (is_above && is_zero) return nullptr;
  }
  const GridAxis incidences{radians_of(header.incidences), AxisEnds::open, block};
  const GridAxis radials{radians_of(header.radials), AxisEnds::open, 1};
  return std::make_shared<const RectilinearGrid>(
      std::vector{*std::move(rotations), incidences, *std::move(azimuths), radials}, sections.size(), std::move(values),
      std::vector<double>{});
}

BrdfValues evaluate(const RectilinearGrid& grid, std::span<const Directions> pairs) {
  const auto channels = static_cast<Eigen::Index>(grid.channels());
  BrdfValues found{Eigen::MatrixXd(static_cast<Eigen::Index>(pairs.size()), channels),
                   Eigen::MatrixXd(static_cast<Eigen::Index>(pairs.size()), channels)};
  Eigen::RowVectorXd value(channels);
  Eigen::RowVectorXd error(channels);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto [theta_in, theta_out, delta_phi, phi_in] = pairs[i];
    // About a specular direction of azimuth 0.
    const Eigen::Vector3d v = unit_vector(theta_out, delta_phi + pi);
    const Eigen::Vector3d specular = unit_vector(theta_in, 0);
    const Eigen::Vector3d upward(-std::cos(theta_in), 0, std::sin(theta_in));
    const double radial = std::atan2(v.cross(specular).norm(), v.dot(specular));
    const double azimuth = std::atan2(v.dot(specular.cross(upward)), v.dot(upward));
    grid.at(std::array{pi - phi_in, theta_in, azimuth, radial}, value, error);
    found.value.row(static_cast<Eigen::Index>(i)) = value;
    found.error.row(static_cast<Eigen::Index>(i)) = error;
  }
  return found;
}

BrdfFunction read(const FileBytes& file, const ReadOptions& options) {
  ZemaxLines lines(file);
  const Header header = read_header(lines);
  std::vector<std::vector<double>> sections;
  BrdfFunction brdf;
  if (header.content == "Monochrome") {
    brdf.channels = {"value"};
    sections.push_back(read_section(lines, header, "Monochrome"));
  } else {
    brdf.channels = {"X", "Y", "Z"};
    for (const char* name : {"TristimulusX", "TristimulusY", "TristimulusZ"}) {
      sections.push_back(read_section(lines, header, name));
    }
  }
  brdf.name = file.stem();
  brdf.format = kZemaxFormat.title;
  brdf.conventions =
      "sr^-1 without cosine; radial angles from the specular direction, azimuths about it from the direction towards "
      "the "
      "normal; ";
  brdf.conventions +=
      header.is_anisotropic() ? "the sample turned by its rotation" : "isotropic, the same on both sides";
  if (header.mirrors()) brdf.conventions += ", the same on both sides of each plane of incidence";
  if (auto grid = grid_of(header, sections)) {
    brdf.conventions += "; linear between the angles, the outermost values beyond them";
    brdf.is_isotropic = false;
    brdf.at = [grid = std::move(grid)](std::span<const Directions> pairs) { return evaluate(*grid, pairs); };
    return brdf;
  }
  interpolate(file, samples_of(header, sections, brdf), options, brdf);
  return brdf;
}

std::string list_text(std::string_view name, const std::vector<double>& angles) {
  std::string text = fmt::format("{}  {}\n", name, angles.size());
  for (std::size_t k = 0; k < angles.size(); ++k) text += (k == 0 ? "" : " ") + shortest(angles[k]);
  return text + "\n";
}

/// The values of a channel for light: a row of radial angles for each azimuth.
std::string block_text(const BrdfFunction& brdf, std::size_t channel, const Direction& light,
                       const SpecularGrid& grid) {
  constexpr double kNearHorizon = 1e-3;  // cosine: functions may be anything there
  constexpr double kHorizon = 1e-9;      // cosine
  constexpr double kNotNothing = 1e-12;  // in place of 0, which marks what was not measured
  std::vector<Directions> pairs;
  std::vector<bool> is_above;
  for (const double azimuth : grid.azimuths) {
    for (const double radial : grid.radials) {
      const Eigen::Vector3d v = scattered_direction(light.theta, azimuth * kDegree, radial * kDegree);
      is_above.push_back(v.z() > -kHorizon);
      pairs.push_back(
          {light.theta, std::acos(std::clamp(v.z(), kNearHorizon, 1.0)), std::atan2(v.y(), v.x()) - pi, light.phi});
    }
  }
  const Eigen::VectorXd values = brdf.at(pairs).value.col(static_cast<Eigen::Index>(channel));
  if (!values.allFinite()) throw NumericError("'" + brdf.name + "' has values that are no finite numbers");
  std::string text;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const double value = values(static_cast<Eigen::Index>(k));
    text += is_above[k] ? shortest(value == 0 ? kNotNothing : value) : std::string("0");
    text += (k + 1) % grid.radials.size() == 0 ? '\n' : ' ';
  }
  return text;
}

std::string write(const BrdfFunction& brdf, const WriteOptions& options) {
  if (brdf.is_isotropic && !brdf.is_bilateral) {
    throw ArgumentError(
        fmt::format("'{}' is isotropic, but not the same on both sides of the plane of incidence; Zemax files are "
                    "written of reflectances that are, and of anisotropic ones",
                    brdf.name));
  }
  const bool is_xyz = brdf.channels == std::vector<std::string>{"X", "Y", "Z"};
  if (brdf.channels.size() != 1 && !is_xyz) {
    throw ArgumentError(
        fmt::format("'{}' has {} channels; Zemax files hold one, or X, Y and Z", brdf.name, brdf.channels.size()));
  }
  const SpecularGrid grid(brdf);
  std::string text = "# BRDF in sr^-1 without cosine; angles about the specular direction, degrees\n";
  if (!options.command_line.empty()) text += "# written by: " + printable(options.command_line) + "\n";
  text += fmt::format("Source  Measured\nSymmetry  {}\nSpectralContent  {}\nScatterType  BRDF\n",
                      brdf.is_isotropic ? "PlaneSymmetrical" : "ASymmetrical4D", is_xyz ? "XYZ" : "Monochrome");
  text += list_text("SampleRotation", grid.rotations) + list_text("AngleOfIncidence", grid.incidences) +
          list_text("ScatterAzimuth", grid.azimuths) + list_text("ScatterRadial", grid.radials);

  // The light stands opposite to the specular direction, whose azimuth is that of the turned sample.
  std::vector<Direction> lights;
  for (const double rotation : grid.rotations) {
    for (const double incidence : grid.incidences) lights.push_back({incidence * kDegree, pi - rotation * kDegree});
  }
  const auto albedos = albedo(brdf, std::span<const Direction>(lights));
  for (std::size_t c = 0; c < brdf.channels.size(); ++c) {
    text += std::string(is_xyz ? "Tristimulus" + brdf.channels[c] : "Monochrome") + "\nDataBegin\n";
    for (std::size_t i = 0; i < lights.size(); ++i) {
      text += fmt::format("TIS {:.6g}\n", albedos[c][i].value);
      text += block_text(brdf, c, lights[i], grid);
    }
    text += "DataEnd\n";
  }
  return text;
}

}  // namespace

const Format kZemaxFormat{"zemax", "Zemax .bsdf", recognises, read, false, write};

}  // namespace lobe
