// Arrays of values and of their angles as NumPy saves them together (numpy.savez), documented in docs/file-formats.md.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <string_view>
#include <utility>

#include "core/text.hpp"
#include "formats/format.hpp"
#include "formats/npy.hpp"
#include "formats/rectilinear.hpp"
#include "formats/replicates.hpp"
#include "formats/zip_archive.hpp"
#include "lobe/core/directions.hpp"

namespace lobe {
namespace {

using std::numbers::pi;

constexpr double kRounding = 1e-6;                   // radians, of angles that are 32-bit numbers
constexpr std::size_t kMostReplicated = 50'000'000;  // values with their replicates
constexpr std::string_view kEnding = ".npy";
constexpr std::array<std::string_view, 3> kIsotropic{"theta_in", "theta_out", "delta_phi"};
constexpr std::array<std::string_view, 4> kGeneral{"theta_in", "phi_in", "theta_out", "phi_out"};

/// A zip archive whose first member is an array.
bool recognises(const FileBytes& head) {
  constexpr std::size_t kNameOffset = 30;
  constexpr std::size_t kLongestName = 256;
  const std::string_view content = head.content();
  return content.starts_with("PK\3\4") && content.size() > kNameOffset &&
         content.substr(kNameOffset, kLongestName).find(kEnding) != std::string_view::npos;
}

/// The arrays of a file by their names.
class Arrays {
 public:
  explicit Arrays(const FileBytes& file) : file_(file), archive_(file), used_(archive_.names().size(), false) {}

  [[nodiscard]] bool has(std::string_view name) const { return index_of(name).has_value(); }
  [[nodiscard]] FileBytes member(std::string_view name) {
    const std::size_t index = *index_of(name);
    used_[index] = true;
    return archive_.read(index);
  }
  /// Those that nobody asked for.
  [[nodiscard]] std::vector<std::string> unused() const {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < used_.size(); ++i) {
      if (!used_[i]) names.push_back(name_of(i));
    }
    return names;
  }
  [[nodiscard]] std::string list() const {
    constexpr std::size_t kMostNamed = 12;
    std::vector<std::string> names;
    for (std::size_t i = 0; i < std::min(kMostNamed, used_.size()); ++i) names.push_back(name_of(i).substr(0, 40));
    return fmt::format("{}", fmt::join(names, ", "));
  }
  [[noreturn]] void refuse(std::string_view complaint) const { file_.refuse_at(0, complaint); }

 private:
  [[nodiscard]] std::string name_of(std::size_t index) const {
    const std::string& name = archive_.names()[index];
    return name.ends_with(kEnding) ? name.substr(0, name.size() - kEnding.size()) : name;
  }
  [[nodiscard]] std::optional<std::size_t> index_of(std::string_view name) const {
    for (std::size_t i = 0; i < used_.size(); ++i) {
      const std::string& member = archive_.names()[i];
      if (member.size() == name.size() + kEnding.size() && member.starts_with(name) && member.ends_with(kEnding)) {
        return i;
      }
    }
    return std::nullopt;
  }

  const FileBytes& file_;
  ZipArchive archive_;
  std::vector<bool> used_;
};

/// Lists of angles, in radians.
struct Angles {
  std::span<const std::string_view> names;
  std::vector<std::vector<double>> lists;
};

/// All that is missing is told at once.
std::span<const std::string_view> names_of(const Arrays& arrays) {
  const auto has = [&](std::string_view name) {
    return arrays.has(fmt::format("{}_deg", name)) || arrays.has(fmt::format("{}_rad", name));
  };
  const bool is_general = !has(kIsotropic[2]) && (has(kGeneral[1]) || has(kGeneral[3]));
  const auto names =
      is_general ? std::span<const std::string_view>(kGeneral) : std::span<const std::string_view>(kIsotropic);
  std::vector<std::string> missing;
  for (const std::string_view name : names) {
    if (!has(name)) missing.push_back(fmt::format("{}_deg (or {}_rad)", name, name));
  }
  if (!arrays.has("values")) missing.emplace_back("values");
  if (!missing.empty()) {
    arrays.refuse(fmt::format("it lacks the arrays {}; it has {}", fmt::join(missing, ", "), arrays.list()));
  }
  return names;
}

std::vector<double> read_angles(Arrays& arrays, std::string_view name) {
  const bool is_degrees = arrays.has(fmt::format("{}_deg", name));
  if (is_degrees && arrays.has(fmt::format("{}_rad", name))) {
    arrays.refuse(fmt::format("it has {}_deg and {}_rad; expected one of them", name, name));
  }
  const FileBytes member = arrays.member(fmt::format("{}_{}", name, is_degrees ? "deg" : "rad"));
  NpyArray array = read_npy(member);
  if (array.shape.size() > 1) member.refuse_at(0, "expected a list of angles, of one dimension");
  if (array.values.empty()) member.refuse_at(0, "no angle; expected one at least");
  const std::vector<double> given = array.values;
  for (double& angle : array.values) angle *= is_degrees ? kDegree : 1;
  const bool is_polar = name.starts_with("theta");
  for (std::size_t i = 0; i < array.values.size(); ++i) {
    const double angle = array.values[i];
    if (!std::isfinite(angle) || (i > 0 && angle <= array.values[i - 1]) ||
        (is_polar && (angle < -kRounding || angle > pi / 2 + kRounding))) {
      member.refuse_at(0, fmt::format("element {} is {}{}; expected rising angles{}", i, shortest(given[i]),
                                      is_degrees ? " degrees" : "", is_polar ? " from 0 to a right one" : ""));
    }
  }
  if (!is_polar && array.values.back() - array.values.front() > 2 * pi + kRounding) {
    member.refuse_at(0, "azimuths span more than a whole turn");
  }
  return array.values;
}

Angles read_angles(Arrays& arrays) {
  Angles angles{names_of(arrays), {}};
  for (const std::string_view name : angles.names) angles.lists.push_back(read_angles(arrays, name));
  return angles;
}

/// Values by the angles, and by channel where there is one axis more.
NpyArray read_values(Arrays& arrays, std::string_view name, const Angles& angles) {
  const FileBytes member = arrays.member(name);
  NpyArray array = read_npy(member);
  std::vector<std::size_t> expected;
  for (const auto& list : angles.lists) expected.push_back(list.size());
  const bool has_channels = array.shape.size() == expected.size() + 1 && array.shape.back() > 0;
  if (!std::equal(expected.begin(), expected.end(), array.shape.begin(),
                  array.shape.end() - static_cast<std::ptrdiff_t>(has_channels ? 1 : 0))) {
    member.refuse_at(
        0, fmt::format("the shape is {}; expected {} ({}), with channels behind", fmt::join(array.shape, " x "),
                       fmt::join(expected, " x "), fmt::join(angles.names, " x ")));
  }
  const auto wrong = std::ranges::find_if_not(array.values, [](double value) { return std::isfinite(value); });
  if (wrong != array.values.end()) {
    member.refuse_at(0, fmt::format("element {} is no finite number", wrong - array.values.begin()));
  }
  return array;
}

/// Azimuths from 0 to half a turn serve both sides; a whole turn closes.
AxisEnds ends_of(std::string_view name, const std::vector<double>& nodes) {
  if (name.starts_with("theta")) return AxisEnds::open;
  const bool is_half = name == kIsotropic[2] && nodes.front() > -kRounding && nodes.back() < pi + kRounding;
  return is_half ? AxisEnds::mirrored : AxisEnds::circular;
}

/// The last one of a whole turn is the first one again.
/// \param values of all, to be the same there
void close_turn(const Arrays& arrays, GridAxis& axis, std::string_view name, std::size_t channels,
                const std::vector<double>& values) {
  if (axis.ends != AxisEnds::circular || axis.nodes.back() - axis.nodes.front() < 2 * pi - kRounding) return;
  const std::size_t length = axis.nodes.size();
  const std::size_t block = axis.stride * channels;
  for (std::size_t line = 0; line < values.size(); line += length * block) {
    if (!std::equal(values.begin() + static_cast<std::ptrdiff_t>(line),
                    values.begin() + static_cast<std::ptrdiff_t>(line + block),
                    values.begin() + static_cast<std::ptrdiff_t>(line + (length - 1) * block))) {
      arrays.refuse(fmt::format("values at the first and the last {}, a whole turn apart, are not the same", name));
    }
  }
  axis.nodes.pop_back();
}

void name_channels(Arrays& arrays, std::size_t channels, BrdfFunction& brdf) {
  if (arrays.has("wavelengths_nm")) {
    const FileBytes member = arrays.member("wavelengths_nm");
    brdf.wavelengths = read_npy(member).values;
    const bool is_valid = std::ranges::all_of(brdf.wavelengths, [](double nm) { return std::isfinite(nm) && nm > 0; });
    if (brdf.wavelengths.size() != channels || !is_valid) {
      member.refuse_at(0, fmt::format("expected {} wavelengths above 0, as many as channels", channels));
    }
    for (const double wavelength : brdf.wavelengths) brdf.channels.push_back(shortest(wavelength) + " nm");
    return;
  }
  if (arrays.has("channels")) {
    const FileBytes member = arrays.member("channels");
    brdf.channels = read_npy_texts(member);
    const bool is_plain = std::ranges::all_of(brdf.channels, [](const std::string& name) {
      return !trim(name).empty() && std::ranges::none_of(name, [](unsigned char c) { return c < ' ' || c == 0x7f; });
    });
    if (brdf.channels.size() != channels || !is_plain) {
      member.refuse_at(0, fmt::format("expected {} names, as many as channels", channels));
    }
    return;
  }
  for (std::size_t c = 1; c <= channels; ++c)
    brdf.channels.push_back(channels == 1 ? "value" : fmt::format("value {}", c));
}

/// Values with replicates, the channels of a point one after the other.
std::vector<double> replicated(const std::vector<double>& values, const std::vector<double>& deviations,
                               std::size_t channels, std::size_t replicates) {
  using Points = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const auto columns = static_cast<Eigen::Index>(channels);
  const auto rows = static_cast<Eigen::Index>(values.size()) / columns;
  const Eigen::MatrixXd all = with_replicates(Eigen::Map<const Points>(values.data(), rows, columns),
                                              Eigen::Map<const Points>(deviations.data(), rows, columns), replicates);
  std::vector<double> points(static_cast<std::size_t>(all.size()));
  Eigen::Map<Points>(points.data(), all.rows(), all.cols()) = all;
  return points;
}

BrdfFunction read(const FileBytes& file, const ReadOptions& options) {
  Arrays arrays(file);
  const Angles angles = read_angles(arrays);
  NpyArray values = read_values(arrays, "values", angles);
  const std::size_t dimensions = angles.lists.size();
  const std::size_t channels = values.shape.size() > dimensions ? values.shape.back() : 1;
  NpyArray errors;
  if (arrays.has("error")) {
    errors = read_values(arrays, "error", angles);
    if (errors.shape != values.shape) arrays.refuse("the shapes of values and error are not the same");
  }
  NpyArray deviations;
  if (arrays.has("std")) {
    deviations = read_values(arrays, "std", angles);
    if (deviations.shape != values.shape) arrays.refuse("the shapes of values and std are not the same");
    const auto wrong = std::ranges::find_if(deviations.values, [](double value) { return value < 0; });
    if (wrong != deviations.values.end()) {
      arrays.refuse(fmt::format("element {} of std is a standard deviation of {}; expected 0 or more",
                                wrong - deviations.values.begin(), shortest(*wrong)));
    }
  }
  std::vector<GridAxis> axes;
  for (std::size_t a = 0; a < dimensions; ++a) {
    axes.push_back({angles.lists[a], ends_of(angles.names[a], angles.lists[a]), 1});
  }
  for (std::size_t a = dimensions - 1; a-- > 0;) axes[a].stride = axes[a + 1].stride * angles.lists[a + 1].size();
  for (std::size_t a = 0; a < dimensions; ++a) close_turn(arrays, axes[a], angles.names[a], channels, values.values);

  BrdfFunction brdf;
  brdf.name = file.stem();
  brdf.format = kNpzFormat.title;
  brdf.conventions =
      "sr^-1 without cosine; directions away from the surface, azimuth differences of 180 degrees are the mirror side; "
      "linear between the angles, the outermost values beyond them";
  name_channels(arrays, channels, brdf);
  brdf.is_isotropic = dimensions == kIsotropic.size();
  brdf.is_bilateral = brdf.is_isotropic && axes.back().ends == AxisEnds::mirrored;
  const auto negative = std::ranges::count_if(values.values, [](double value) { return value < 0; });
  if (negative > 0) {
    brdf.remarks.push_back(fmt::format("{} of {} values are negative, and kept", negative, values.values.size()));
  }
  for (const std::string& name : arrays.unused()) {
    brdf.remarks.push_back(fmt::format("array '{}' is not used", name.substr(0, 40)));
  }
  std::size_t columns = channels;
  if (!deviations.values.empty()) {
    brdf.has_deviations = true;
    brdf.replicates = possible_replicates(options.replicates, values.values.size(), kMostReplicated);
    columns = channels * (1 + brdf.replicates);
    values.values = replicated(values.values, deviations.values, channels, brdf.replicates);
    // Errors are those of the values themselves, whatever is drawn about them.
    if (!errors.values.empty()) {
      const std::vector<double> none(errors.values.size(), 0.0);
      errors.values = replicated(errors.values, none, channels, brdf.replicates);
    }
  }
  const auto grid = std::make_shared<const RectilinearGrid>(std::move(axes), columns, std::move(values.values),
                                                            std::move(errors.values));
  brdf.at = [grid, is_isotropic = brdf.is_isotropic](std::span<const Directions> pairs) {
    BrdfValues found;
    found.value.resize(static_cast<Eigen::Index>(pairs.size()), static_cast<Eigen::Index>(grid->channels()));
    found.error.resizeLike(found.value);
    Eigen::RowVectorXd value(found.value.cols());
    Eigen::RowVectorXd error(found.value.cols());
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const auto [theta_in, theta_out, delta_phi, phi_in] = pairs[i];
      const std::array<double, 4> isotropic{theta_in, theta_out, delta_phi, 0};
      const std::array<double, 4> general{theta_in, phi_in, theta_out, phi_in + delta_phi};
      grid->at(std::span(is_isotropic ? isotropic : general).first(is_isotropic ? 3 : 4), value, error);
      found.value.row(static_cast<Eigen::Index>(i)) = value;
      found.error.row(static_cast<Eigen::Index>(i)) = error;
    }
    return found;
  };
  return brdf;
}

}  // namespace

const Format kNpzFormat{"npz", "NumPy .npz of angles and values", recognises, read};

}  // namespace lobe
