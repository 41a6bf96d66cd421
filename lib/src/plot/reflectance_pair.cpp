#include "plot/reflectance_pair.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <utility>

#include "lobe/core/directions.hpp"
#include "lobe/energy/albedo.hpp"
#include "lobe/reflectance/evaluate.hpp"
#include "plot/panels.hpp"
#include "plot/picture_files.hpp"

namespace lobe {
namespace {

/// Values, each the mean of the channels.
std::vector<double> values_at(const Device& device, const Reflectance& reflectance,
                              std::span<const Directions> directions) {
  const Eigen::VectorXd means = evaluate(device, reflectance, directions).value.rowwise().mean();
  return {means.begin(), means.end()};
}

/// Albedos by angle of incidence, radians, each the mean of the channels.
std::vector<double> albedos_at(const Device& device, const Reflectance& reflectance, std::span<const double> angles) {
  constexpr double kTolerance = 1e-4;  // less than a line is wide
  const auto channels = albedo(device, reflectance, angles, {.tolerance = kTolerance});
  std::vector<double> means(angles.size());
  for (const auto& channel : channels) {
    for (std::size_t i = 0; i < means.size(); ++i) {
      means[i] += channel[i].value / static_cast<double>(channels.size());
    }
  }
  return means;
}

using std::back_inserter;
using std::numbers::pi;

constexpr std::array<double, 3> kShownAngles = {0, 45, 75};
constexpr std::array<std::string_view, 3> kPairColours = {"#0072b2", "#d55e00",
                                                          "#555555"};  // target, approximation, rest

/// f along the plane of incidence; theta in degrees, negative on the retro side, where the light comes from.
struct Slice {
  std::vector<double> theta;
  std::vector<double> target;
  std::vector<double> approximation;
};

struct AlbedoCurves {
  std::vector<double> theta;  ///< degrees
  std::vector<double> target;
  std::vector<double> approximation;
};

/// Every quarter degree, and finely around the directions where lobes are.
std::vector<double> slice_angles(double theta_in) {
  std::vector<double> angles;
  for (int i = -359; i <= 359; ++i) angles.push_back(0.25 * i);
  for (const double centre : {-theta_in, theta_in}) {
    for (int i = -300; i <= 300; ++i) angles.push_back(centre + 0.01 * i);
  }
  std::erase_if(angles, [](double angle) { return std::abs(angle) >= 90; });
  std::ranges::sort(angles);
  angles.erase(std::unique(angles.begin(), angles.end()), angles.end());
  return angles;
}

Slice make_slice(const ReflectancePair& pair, double theta_in) {
  Slice slice{slice_angles(theta_in), {}, {}};
  std::vector<Directions> directions;
  for (const double theta : slice.theta) {
    directions.push_back({theta_in * kDegree, std::abs(theta) * kDegree, theta < 0 ? 0 : pi});
  }
  slice.target = values_at(pair.device, pair.target, directions);
  slice.approximation = values_at(pair.device, pair.approximation, directions);
  return slice;
}

struct Range {
  double low = 0;
  double high = 0;

  void include(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  /// A little more than what was included, as gnuplot text.
  [[nodiscard]] std::string text() const {
    const double room = high > low ? 0.06 * (high - low) : 1;
    return fmt::format("[{:.6g}:{:.6g}]", low < 0 ? low - room : low, high + room);
  }
};

std::string note_of(const ReflectancePair& pair) {
  const std::string note = pair.has_channels ? "; mean of channels" : "";
  return pair.is_isotropic ? note : note + "; azimuth 0°";
}

constexpr std::string_view kAxes =
    "set tics nomirror out textcolor rgb '#000000'\nset border 3 linecolor rgb '#888888'\n"
    "set grid xtics ytics linetype 1 linewidth 0.8 linecolor rgb '#dcdcdc'\n";

std::string curve(std::size_t block, std::size_t column, std::size_t look, std::string_view title) {
  return fmt::format("data_file index {} using 1:{} with lines linewidth 2 {}linecolor rgb '{}' {}", block, column,
                     look == 1 ? "dashtype 2 " : "", kPairColours[look],
                     title.empty() ? "notitle" : "title " + gnuplot::string_literal(title));
}

gnuplot::Picture slices_picture(const std::string& stem, const ReflectancePair& pair, PictureFormat format) {
  std::vector<Slice> slices;
  std::string data = "# theta_out/deg, f and its approximation in sr^-1, difference; a block per theta_in\n";
  std::vector<Range> rests(kShownAngles.size());
  std::vector<Range> values(kShownAngles.size());
  for (std::size_t k = 0; k < kShownAngles.size(); ++k) {
    const Slice slice = make_slice(pair, kShownAngles[k]);
    for (std::size_t i = 0; i < slice.theta.size(); ++i) {
      const double difference = slice.target[i] - slice.approximation[i];
      fmt::format_to(back_inserter(data), "{:.4f} {:.8g} {:.8g} {:.8g}\n", slice.theta[i], slice.target[i],
                     slice.approximation[i], difference);
      if (std::abs(slice.theta[i]) * kDegree > kGrazing) continue;
      values[k].include(slice.target[i]);
      values[k].include(slice.approximation[i]);
      rests[k].include(difference);
    }
    data += "\n\n";
  }

  const PanelLayout layout(2 * kShownAngles.size(), 330, 230, {.left = 76, .right = 20, .top = 34, .bottom = 62}, 0);
  std::string script =
      gnuplot::preamble(stem, pair.kind + ", plane of incidence", layout.width(), layout.height(), format);
  script += "set multiplot\n" +
            layout.heading(pair.target.name(),
                           pair.result +
                               "; plane of incidence, θ_out < 0: the side of the light; above f, below what is left" +
                               note_of(pair));
  script += kAxes;
  script += "set xrange [-90:90]\nset xtics 30\nset key top left reverse Left samplen 2 font ',10'\n";
  for (std::size_t row = 0; row < 2; ++row) {
    for (std::size_t k = 0; k < kShownAngles.size(); ++k) {
      script +=
          layout.frame(row * kShownAngles.size() + k, row == 0 ? fmt::format("θ_in = {:g}°", kShownAngles[k]) : "");
      script += "set yrange " + (row == 0 ? values : rests)[k].text() + "\n";
      script += k > 0      ? "unset ylabel\n"
                : row == 0 ? "set ylabel 'f / sr⁻¹' font ',11'\n"
                           : "set ylabel 'residual / sr⁻¹' font ',11'\n";
      script += row == 0 ? "unset xlabel\n" : "set xlabel 'θ_out / °' font ',11'\n";
      const bool has_key = k == 0;
      script += row == 0 ? "plot " + curve(k, 2, 0, has_key ? "target" : "") + ", " +
                               curve(k, 3, 1, has_key ? pair.name : "") + "\n"
                         : "plot " + curve(k, 4, 2, "") + "\n";
      if (row == 0 && k == 0) script += PanelLayout::end_heading();
    }
  }
  return {script + "unset multiplot\n", std::move(data)};
}

gnuplot::Picture pair_albedo_picture(const std::string& stem, const ReflectancePair& pair, PictureFormat format) {
  AlbedoCurves curves;
  for (double theta = 0; theta <= 88; theta += 2) curves.theta.push_back(theta);
  curves.theta.push_back(89);
  std::vector<double> radians = curves.theta;
  for (double& angle : radians) angle *= kDegree;
  curves.target = albedos_at(pair.device, pair.target, radians);
  curves.approximation = albedos_at(pair.device, pair.approximation, radians);
  Range range{0, 1};
  std::string data = "# theta/deg, albedo of the target and of its approximation, difference\n";
  for (std::size_t i = 0; i < curves.theta.size(); ++i) {
    const double difference = curves.target[i] - curves.approximation[i];
    for (const double value : {curves.target[i], curves.approximation[i], difference}) range.include(value);
    fmt::format_to(back_inserter(data), "{:.4f} {:.8g} {:.8g} {:.8g}\n", curves.theta[i], curves.target[i],
                   curves.approximation[i], difference);
  }
  const PanelLayout layout(1, 760, 420, {.left = 80, .right = 30, .top = 20, .bottom = 64}, 0);
  std::string script = gnuplot::preamble(stem, pair.kind + ", albedo", layout.width(), layout.height(), format);
  script += layout.heading(pair.target.name(), pair.result + note_of(pair));
  script += layout.frame(0, "");
  script += kAxes;
  script += "set xrange [0:90]\nset xtics 15\nset yrange " + range.text() +
            "\nset xlabel 'θ / °' font ',11'\nset ylabel 'albedo' font ',11'\n"
            "set key at graph 1,graph 1.01 right bottom horizontal samplen 3 font ',11'\n";
  script += "plot " + curve(0, 2, 0, "target") + ", " + curve(0, 3, 1, pair.name) + ", " +
            curve(0, 4, 2, "difference") + "\n";
  return {std::move(script), std::move(data)};
}

}  // namespace

PictureFiles write_pair_pictures(const ReflectancePair& pair, const std::filesystem::path& directory,
                                 const std::string& stem, const TablePictureOptions& options) {
  using Draw = gnuplot::Picture (*)(const std::string&, const ReflectancePair&, PictureFormat);
  std::vector<NamedPicture> pictures;
  const auto add = [&](const char* kind, Draw draw) {
    const std::string name = stem + "." + kind;
    pictures.push_back({name, draw(name, pair, options.format)});
  };
  add("slices", slices_picture);
  add("albedo", pair_albedo_picture);
  return write_pictures(pictures, directory, options);
}

}  // namespace lobe
