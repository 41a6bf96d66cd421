// Tensor files of the RGL material database, written. A file has f cos(theta_out) as values times ndf / (4 sigma), the
// values on a grid over the unit square to which `vndf` warps the half-vector (Dupuy and Jakob 2018, section 4). Any
// positive densities are exact at the nodes; these here put nodes where the reflectance has its highlights.
#include "formats/rgl_writer.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "core/parallel.hpp"
#include "core/text.hpp"
#include "formats/channel_choice.hpp"
#include "hemisphere/unit_vector.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"

namespace lobe {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

constexpr double kLastAngle = 89 * kDegree;  // of the light: at the horizon itself reflectances need not be finite
constexpr double kAboveHorizon = 1e-6;       // of a viewer above the horizon
// Shares of the nodes: even on the square, where half-vectors near the normal have room; even in solid angle, for the
// viewer's horizon; the rest goes where light goes.
constexpr double kEvenSquare = 0.5;
constexpr double kEvenView = 0.2;
constexpr double kLeastNormals = 1e-3;                    // of the density of normals, relative to its mean
constexpr double kLeastLuminance = 0.05;                  // of the density of samples, relative to its mean
constexpr double kNominal = 550;                          // nm, of values that hold for all wavelengths
constexpr std::size_t kMostNodes = 4096;                  // along an axis
constexpr std::size_t kMostBytes = std::size_t{1} << 30;  // of a file, as readers take

/// A point of the unit square: x for the elevation, y for the azimuth.
struct UnitPoint {
  double x;
  double y;
};

double elevation_at(double x) {
  return x * x * pi / 2;
}

double azimuth_at(double y) {
  return (2 * y - 1) * pi;
}

/// Solid angle of a normal per area of the unit square.
double solid_angle_at(double x) {
  return 2 * pi * pi * x * std::sin(elevation_at(x));
}

double node_at(std::size_t index, std::size_t nodes) {
  return static_cast<double>(index) / static_cast<double>(nodes - 1);
}

/// Weight of a node in the integral over a grid that is bilinear on the unit square.
double trapezoid(std::size_t index, std::size_t nodes) {
  return (index == 0 || index + 1 == nodes ? 0.5 : 1) / static_cast<double>(nodes - 1);
}

/// Numbers on a grid over the unit square, as loaders see them: single precision, bilinear.
class SquareGrid {
 public:
  SquareGrid(std::size_t width, std::size_t height, std::vector<float> values)
      : width_(width), height_(height), values_(std::move(values)) {}

  [[nodiscard]] std::size_t width() const { return width_; }
  [[nodiscard]] std::size_t height() const { return height_; }
  [[nodiscard]] const std::vector<float>& values() const { return values_; }

  [[nodiscard]] double at(const UnitPoint& point) const {
    const auto [i, a] = cell(point.x, width_);
    const auto [j, b] = cell(point.y, height_);
    const auto value = [&](std::size_t k) { return static_cast<double>(values_[k]); };
    const std::size_t first = j * width_ + i;
    return (1 - b) * ((1 - a) * value(first) + a * value(first + 1)) +
           b * ((1 - a) * value(first + width_) + a * value(first + width_ + 1));
  }

 private:
  static std::pair<std::size_t, double> cell(double place, std::size_t nodes) {
    const double steps = place * static_cast<double>(nodes - 1);
    const std::size_t index = std::min(static_cast<std::size_t>(steps), nodes - 2);
    return {index, steps - static_cast<double>(index)};
  }

  std::size_t width_;
  std::size_t height_;
  std::vector<float> values_;
};

/// Scales numbers on a grid so that their integral over the unit square is 1.
std::vector<float> normalised(const std::vector<double>& values, std::size_t width, std::size_t height) {
  double sum = 0;
  for (std::size_t j = 0; j < height; ++j) {
    for (std::size_t i = 0; i < width; ++i) {
      sum += trapezoid(i, width) * trapezoid(j, height) * values[j * width + i];
    }
  }
  std::vector<float> scaled;
  scaled.reserve(values.size());
  for (const double value : values) scaled.push_back(static_cast<float>(value / sum));
  return scaled;
}

/// Length from the left end of a cell within which a density that is linear in it has an integral.
double share_of_cell(double left, double right, double integral) {
  const double root = std::sqrt(std::max(0.0, left * left + 2 * integral * (right - left)));
  return left + root > 0 ? std::clamp(2 * integral / (left + root), 0.0, 1.0) : 0;
}

/// The warp from uniform points to normals by a density: rows first, then along them, as loaders do.
class Warp {
 public:
  explicit Warp(const SquareGrid& density) : density_(density), across_(density.height()) {
    const std::size_t width = density.width();
    along_.resize(width * density.height());
    for (std::size_t j = 0; j < density.height(); ++j) {
      for (std::size_t i = 1; i < width; ++i) {
        const std::size_t k = j * width + i;
        along_[k] = along_[k - 1] + (value(k - 1) + value(k)) / 2;
      }
      if (j > 0) across_[j] = across_[j - 1] + (along_[j * width - 1] + along_[(j + 1) * width - 1]) / 2;
    }
  }

  [[nodiscard]] UnitPoint normal(const UnitPoint& uniform) const {
    const std::size_t width = density_.width();
    const double across = uniform.y * across_.back();
    const auto above = std::ranges::lower_bound(across_, across) - across_.begin();
    const std::size_t row = static_cast<std::size_t>(std::max<std::ptrdiff_t>(above, 1)) - 1;
    const double* const lower = &along_[row * width];
    const double* const upper = lower + width;
    const double b = share_of_cell(lower[width - 1], upper[width - 1], across - across_[row]);
    const auto sum = [&](std::size_t i) { return (1 - b) * lower[i] + b * upper[i]; };
    // A density that ends before the edge takes the last uniform point to its end.
    const double along = uniform.x * sum(width - 1) * (1 - 1e-12);
    std::size_t column = 0;
    while (column + 2 < width && sum(column + 1) < along) ++column;
    const auto density = [&](std::size_t i) {
      return (1 - b) * value(row * width + i) + b * value((row + 1) * width + i);
    };
    const double a = share_of_cell(density(column), density(column + 1), along - sum(column));
    return {(static_cast<double>(column) + a) / static_cast<double>(width - 1),
            (static_cast<double>(row) + b) / static_cast<double>(density_.height() - 1)};
  }

 private:
  [[nodiscard]] double value(std::size_t index) const { return static_cast<double>(density_.values()[index]); }

  const SquareGrid& density_;
  std::vector<double> along_;   // integrals from the left end of a row on, in cells
  std::vector<double> across_;  // integrals from the first row on, in cells
};

/// A file of tensors: a list of fields, then their numbers, each from a multiple of eight bytes on.
class TensorFileWriter {
 public:
  template <typename Number>
  void add(std::string_view name, std::uint8_t type, std::vector<std::size_t> shape,
           const std::vector<Number>& numbers) {
    static_assert(std::endian::native == std::endian::little);
    fields_.push_back({std::string(name), type, std::move(shape),
                       std::string(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(Number))});
  }

  [[nodiscard]] std::string content() && {
    std::size_t at = std::string_view("tensor_file\0\1\0", 14).size() + sizeof(std::uint32_t);
    for (const Entry& field : fields_) at += 2 + field.name.size() + 2 + 1 + 8 + 8 * field.shape.size();
    std::string content("tensor_file\0\1\0", 14);
    append(content, static_cast<std::uint32_t>(fields_.size()));
    for (const Entry& field : fields_) {
      at = aligned(at);
      append(content, static_cast<std::uint16_t>(field.name.size()));
      content += field.name;
      append(content, static_cast<std::uint16_t>(field.shape.size()));
      append(content, field.type);
      append(content, static_cast<std::uint64_t>(at));
      for (const std::size_t length : field.shape) append(content, static_cast<std::uint64_t>(length));
      at += field.bytes.size();
    }
    content.reserve(at);
    for (Entry& field : fields_) {
      content.resize(aligned(content.size()));
      content += std::exchange(field.bytes, {});
    }
    return content;
  }

 private:
  struct Entry {
    std::string name;
    std::uint8_t type;
    std::vector<std::size_t> shape;
    std::string bytes;
  };

  static std::size_t aligned(std::size_t at) { return (at + 7) / 8 * 8; }

  template <typename Number>
  static void append(std::string& content, Number number) {
    content.append(reinterpret_cast<const char*>(&number), sizeof(number));
  }

  std::vector<Entry> fields_;
};

constexpr std::uint8_t kBytes = 1;
constexpr std::uint8_t kWords = 5;
constexpr std::uint8_t kFloats = 10;

/// The channels of a file, in its order, and how bright they are together.
struct RglChannels {
  std::vector<Eigen::Index> order;  // of the function's channels; one may stand for several
  std::vector<float> wavelengths;   // empty: red, green and blue
  Eigen::VectorXd brightness;       // weights of the function's channels
};

RglChannels rgl_channels_of(const BrdfFunction& brdf, const WriteOptions& options) {
  const auto count = static_cast<Eigen::Index>(brdf.channels.size());
  RglChannels channels{
      .order = {}, .wavelengths = {}, .brightness = Eigen::VectorXd::Constant(count, 1.0 / static_cast<double>(count))};
  if (!brdf.wavelengths.empty()) {
    channels.order.resize(brdf.channels.size());
    std::iota(channels.order.begin(), channels.order.end(), Eigen::Index{0});
    const auto wavelength = [&](Eigen::Index c) {
      return static_cast<float>(brdf.wavelengths[static_cast<std::size_t>(c)]);
    };
    std::ranges::stable_sort(channels.order, {}, wavelength);
    for (const Eigen::Index c : channels.order) channels.wavelengths.push_back(wavelength(c));
    const auto twice = std::ranges::adjacent_find(channels.wavelengths);
    if (twice != channels.wavelengths.end()) {
      throw ArgumentError(
          fmt::format("'{}' has two channels of {} nm; RGL files hold one for each wavelength", brdf.name, *twice));
    }
  } else if (count == 1) {
    channels.order = {0};
    if (options.spectra) {
      channels.wavelengths = {static_cast<float>(kNominal)};
    } else {
      channels.order = {0, 0, 0};
    }
  } else if (count == 3 && !options.spectra) {
    channels.order = {0, 1, 2};
    channels.brightness = Eigen::Map<const Eigen::Vector3d>(kRec709.data());
  } else if (options.spectra) {
    throw ArgumentError(
        fmt::format("'{}' has {} channels without wavelengths; expected one channel, or wavelengths, to "
                    "write spectra",
                    brdf.name, count));
  } else {
    throw ArgumentError(
        fmt::format("'{}' has {} channels; RGL files hold red, green and blue, wavelengths, or one "
                    "channel",
                    brdf.name, count));
  }
  return channels;
}

/// A pair of directions, or none where the viewer would be below the horizon.
struct ReflectedPair {
  Directions pair;
  double cosine = 0;    // of the viewer; 0: none
  double cosine_d = 0;  // between the light and the normal
};

ReflectedPair reflected(const Vector3d& light, const Directions& angles, const UnitPoint& normal) {
  const Vector3d m = unit_vector(elevation_at(normal.x), azimuth_at(normal.y));
  const double cosine_d = m.dot(light);
  const Vector3d out = 2 * cosine_d * m - light;
  ReflectedPair found{.pair = angles, .cosine = 0, .cosine_d = cosine_d};
  if (out.z() < kAboveHorizon || cosine_d <= 0) return found;
  found.cosine = out.z();
  found.pair.theta_out = std::atan2(std::hypot(out.x(), out.y()), out.z());
  found.pair.delta_phi = std::remainder(std::atan2(out.y(), out.x()) - angles.phi_in, 2 * pi);
  return found;
}

class RglWriter {
 public:
  RglWriter(const BrdfFunction& brdf, const WriteOptions& options)
      : brdf_(brdf), options_(options), channels_(rgl_channels_of(brdf, options)) {
    require("angles of the light", options.light_angles, 2);
    if (!brdf.is_isotropic) require("azimuths of the light", options.light_azimuths, 3);
    require("nodes of values", options.nodes, 2);
    azimuths_ = brdf.is_isotropic ? 1 : options.light_azimuths + 1;
    const double slices = static_cast<double>(azimuths_) * static_cast<double>(options.light_angles);
    const double numbers = static_cast<double>(side() * side()) + static_cast<double>(options.nodes * options.nodes) *
                                                                      static_cast<double>(channels_.order.size() + 1);
    if (slices * numbers * sizeof(float) > static_cast<double>(kMostBytes)) {
      throw ArgumentError(
          fmt::format("a file of {} x {} directions of the light with {} x {} values each would have "
                      "{:.1f} GiB; expected up to 1",
                      azimuths_, options.light_angles, options.nodes, options.nodes,
                      slices * numbers * sizeof(float) / static_cast<double>(kMostBytes)));
    }
  }

  [[nodiscard]] std::string content() const {
    const SquareGrid normals = density_of_normals();
    const SquareGrid area = projected_area(normals);
    const std::size_t angles = options_.light_angles;
    const std::size_t nodes = options_.nodes;
    const std::size_t slices = azimuths_ * angles;
    Slices all;
    all.visible.resize(slices * side() * side());
    all.luminance.resize(slices * nodes * nodes);
    all.values.resize(slices * channels_.order.size() * nodes * nodes);
    const std::size_t different = brdf_.is_isotropic ? 1 : azimuths_ - 1;  // the turn ends where it begins
    for (std::size_t p = 0; p < different; ++p) {
      if (options_.progress &&
          !options_.progress("directions", static_cast<double>(p) / static_cast<double>(different))) {
        throw Cancelled("cancelled");
      }
      parallel_for(angles, [&](std::size_t t) { add_slice(normals, area, p, t, all); });
    }
    if (different < azimuths_) {
      for (auto* numbers : {&all.visible, &all.luminance, &all.values}) {
        const auto turn = static_cast<std::ptrdiff_t>(numbers->size() / azimuths_);
        std::copy_n(numbers->begin(), turn, numbers->end() - turn);
      }
    }

    TensorFileWriter file;
    file.add("version", kWords, {2}, std::vector<std::uint32_t>{1, 0});
    const std::string text = description();
    file.add("description", kBytes, {text.size()}, std::vector<char>(text.begin(), text.end()));
    std::vector<float> phi;
    for (std::size_t p = 0; p < azimuths_; ++p) phi.push_back(static_cast<float>(azimuth(p)));
    std::vector<float> theta;
    for (std::size_t t = 0; t < angles; ++t) theta.push_back(static_cast<float>(angle(t)));
    file.add("phi_i", kFloats, {azimuths_}, phi);
    file.add("theta_i", kFloats, {angles}, theta);
    file.add("sigma", kFloats, {area.height(), area.width()}, area.values());
    file.add("ndf", kFloats, {normals.height(), normals.width()}, normals.values());
    file.add("vndf", kFloats, {azimuths_, angles, side(), side()}, all.visible);
    file.add("luminance", kFloats, {azimuths_, angles, nodes, nodes}, all.luminance);
    if (!channels_.wavelengths.empty())
      file.add("wavelengths", kFloats, {channels_.wavelengths.size()}, channels_.wavelengths);
    file.add(channels_.wavelengths.empty() ? "rgb" : "spectra", kFloats,
             {azimuths_, angles, channels_.order.size(), nodes, nodes}, all.values);
    file.add("jacobian", kBytes, {1}, std::vector<char>{1});
    return std::move(file).content();
  }

 private:
  /// Fields by the light's direction.
  struct Slices {
    std::vector<float> visible;
    std::vector<float> luminance;
    std::vector<float> values;
  };

  static void require(std::string_view what, std::size_t count, std::size_t least) {
    if (count < least || count > kMostNodes) {
      throw ArgumentError(fmt::format("{} {} for an RGL file; expected {} to {}", count, what, least, kMostNodes));
    }
  }

  /// Nodes of `vndf` along each axis.
  [[nodiscard]] std::size_t side() const { return brdf_.is_isotropic ? 128 : 64; }

  [[nodiscard]] double angle(std::size_t t) const { return kLastAngle * node_at(t, options_.light_angles); }
  [[nodiscard]] double azimuth(std::size_t p) const { return azimuths_ == 1 ? 0 : azimuth_at(node_at(p, azimuths_)); }

  [[nodiscard]] std::string description() const {
    return printable(options_.command_line.empty() ? brdf_.name : brdf_.name + "; " + options_.command_line);
  }

  [[nodiscard]] Eigen::MatrixXd values_at(const std::vector<Directions>& pairs) const {
    if (pairs.empty()) return Eigen::MatrixXd(0, static_cast<Eigen::Index>(brdf_.channels.size()));
    Eigen::MatrixXd values = brdf_.at(pairs).value;
    if (!values.allFinite()) {
      throw NumericError("'" + brdf_.name + "' has values that are no finite numbers");
    }
    return values;
  }

  /// A density of normals for any reflectance: the mean of f over the pairs that have a half-vector in common, weighted
  /// by both cosines. For microfacets it is their distribution but for a slowly varying factor.
  [[nodiscard]] SquareGrid density_of_normals() const {
    constexpr std::size_t kPiece = 256;
    const std::size_t width = brdf_.is_isotropic ? 512 : 128;
    const std::size_t rows = brdf_.is_isotropic ? 1 : 65;
    std::vector<double> density(width * rows);
    parallel_for_pieces(density.size(), kPiece, [&](std::size_t begin, std::size_t end) {
      std::vector<Directions> pairs;
      std::vector<double> weights;
      std::vector<std::size_t> first;
      for (std::size_t k = begin; k < end; ++k) {
        first.push_back(pairs.size());
        const double y = rows == 1 ? 0.5 : node_at(k / width, rows);
        add_pairs_about({node_at(k % width, width), y}, pairs, weights);
      }
      first.push_back(pairs.size());
      const Eigen::VectorXd bright = values_at(pairs) * channels_.brightness;
      for (std::size_t k = begin; k < end; ++k) {
        double sum = 0;
        double weight = 0;
        for (std::size_t i = first[k - begin]; i < first[k - begin + 1]; ++i) {
          sum += weights[i] * std::max(bright[static_cast<Eigen::Index>(i)], 0.0);
          weight += weights[i];
        }
        density[k] = sum / weight;
      }
    });
    if (rows == 1) density.insert(density.end(), density.begin(), density.begin() + static_cast<std::ptrdiff_t>(width));
    const std::size_t height = density.size() / width;
    double mean = 0;  // of the projected hemisphere
    double norm = 0;
    for (std::size_t k = 0; k < density.size(); ++k) {
      const double x = node_at(k % width, width);
      const double weight =
          trapezoid(k % width, width) * trapezoid(k / width, height) * solid_angle_at(x) * std::cos(elevation_at(x));
      mean += weight * density[k];
      norm += weight;
    }
    mean /= norm;
    std::vector<float> numbers;
    for (const double value : density) {
      const double relative = mean > 0 ? (value / mean + kLeastNormals) / (1 + kLeastNormals) : 1;
      numbers.push_back(static_cast<float>(relative / norm));
    }
    return {width, height, std::move(numbers)};
  }

  /// Pairs with a half-vector, and the product of their cosines by solid angle.
  static void add_pairs_about(const UnitPoint& normal, std::vector<Directions>& pairs, std::vector<double>& weights) {
    constexpr std::size_t kSteps = 8;  // of both angles of the difference vector, a turn of which is even
    constexpr double kSteepest = 89.5 * kDegree;
    const double theta = std::min(elevation_at(normal.x), kSteepest);
    const double phi = azimuth_at(normal.y);
    const Vector3d m = unit_vector(theta, phi);
    const Vector3d along = unit_vector(theta + pi / 2, phi);
    const Vector3d across = m.cross(along);
    for (std::size_t d = 0; d < kSteps; ++d) {
      const double theta_d = (static_cast<double>(d) + 0.5) / kSteps * pi / 2;
      for (std::size_t a = 0; a < kSteps; ++a) {
        const double phi_d = static_cast<double>(a) / kSteps * pi;
        const Vector3d aside = std::sin(theta_d) * (std::cos(phi_d) * along + std::sin(phi_d) * across);
        const Vector3d in = std::cos(theta_d) * m + aside;
        const Vector3d out = std::cos(theta_d) * m - aside;
        if (in.z() < kAboveHorizon || out.z() < kAboveHorizon) continue;
        const double phi_in = std::atan2(in.y(), in.x());
        pairs.push_back({.theta_in = std::atan2(std::hypot(in.x(), in.y()), in.z()),
                         .theta_out = std::atan2(std::hypot(out.x(), out.y()), out.z()),
                         .delta_phi = std::remainder(std::atan2(out.y(), out.x()) - phi_in, 2 * pi),
                         .phi_in = phi_in});
        weights.push_back(in.z() * out.z() * std::sin(theta_d));
      }
    }
  }

  /// Area of the surface, with this density of normals, as seen from each direction.
  [[nodiscard]] SquareGrid projected_area(const SquareGrid& normals) const {
    const std::size_t width = brdf_.is_isotropic ? 128 : 64;
    const std::size_t height = brdf_.is_isotropic ? 2 : 33;
    const std::size_t rows = brdf_.is_isotropic ? 1 : height;
    std::vector<Vector3d> facets;
    std::vector<double> sizes;
    const std::size_t turns = brdf_.is_isotropic ? 129 : normals.height();
    for (std::size_t j = 0; j < turns; ++j) {
      for (std::size_t i = 0; i < normals.width(); ++i) {
        const UnitPoint point{node_at(i, normals.width()), node_at(j, turns)};
        facets.push_back(unit_vector(elevation_at(point.x), azimuth_at(point.y)));
        sizes.push_back(trapezoid(i, normals.width()) * trapezoid(j, turns) * solid_angle_at(point.x) *
                        normals.at(point));
      }
    }
    std::vector<float> area(width * height);
    parallel_for(rows * width, [&](std::size_t k) {
      const Vector3d direction =
          unit_vector(elevation_at(node_at(k % width, width)), azimuth_at(node_at(k / width, height)));
      double sum = 0;
      for (std::size_t i = 0; i < facets.size(); ++i) sum += sizes[i] * std::max(facets[i].dot(direction), 0.0);
      area[k] = static_cast<float>(sum);
    });
    if (rows == 1) std::copy_n(area.begin(), width, area.begin() + static_cast<std::ptrdiff_t>(width));
    return {width, height, std::move(area)};
  }

  /// f cos(theta_out), as bright as all channels together and not below 0, where pairs are above the horizon.
  [[nodiscard]] std::vector<double> light_of(const std::vector<ReflectedPair>& places,
                                             const Eigen::MatrixXd& values) const {
    std::vector<double> light;
    Eigen::Index next = 0;
    for (const ReflectedPair& place : places) {
      light.push_back(place.cosine > 0 ? std::max(values.row(next++).dot(channels_.brightness), 0.0) * place.cosine
                                       : 0);
    }
    return light;
  }

  /// Solid angle of the viewer per area of the square.
  static double stretch_at(const UnitPoint& point, const ReflectedPair& place) {
    return solid_angle_at(point.x) * 4 * std::max(place.cosine_d, 0.0);
  }

  static std::vector<Directions> pairs_of(const std::vector<ReflectedPair>& places) {
    std::vector<Directions> pairs;
    for (const ReflectedPair& place : places) {
      if (place.cosine > 0) pairs.push_back(place.pair);
    }
    return pairs;
  }

  /// All that the file has for a direction of the light.
  void add_slice(const SquareGrid& normals, const SquareGrid& area, std::size_t p, std::size_t t, Slices& all) const {
    // As loaders have the angles.
    const Directions angles{.theta_in = static_cast<double>(static_cast<float>(angle(t))),
                            .phi_in = static_cast<double>(static_cast<float>(azimuth(p)))};
    const Vector3d light = unit_vector(angles.theta_in, angles.phi_in);
    const std::size_t slice = p * options_.light_angles + t;
    const std::size_t nodes = options_.nodes;
    const std::size_t count = nodes * nodes;

    const SquareGrid visible = visible_normals(light, angles);
    const Warp warp(visible);
    std::vector<UnitPoint> points;
    std::vector<ReflectedPair> places;
    for (std::size_t k = 0; k < count; ++k) {
      points.push_back(warp.normal({node_at(k % nodes, nodes), node_at(k / nodes, nodes)}));
      places.push_back(reflected(light, angles, points.back()));
    }
    const Eigen::MatrixXd values = values_at(pairs_of(places));
    const std::vector<double> bright = light_of(places, values);

    const UnitPoint at{std::sqrt(angles.theta_in * 2 / pi), brdf_.is_isotropic ? 0.5 : node_at(p, azimuths_)};
    const double four_areas = 4 * area.at(at);
    std::vector<double> luminance(count);
    double mean = 0;
    Eigen::Index next = 0;
    float* const numbers = &all.values[slice * channels_.order.size() * count];
    for (std::size_t k = 0; k < count; ++k) {
      if (places[k].cosine > 0) {
        const double factor = places[k].cosine * four_areas / normals.at(points[k]);
        for (std::size_t c = 0; c < channels_.order.size(); ++c) {
          const auto number = static_cast<float>(values(next, channels_.order[c]) * factor);
          if (!std::isfinite(number)) {
            throw NumericError("'" + brdf_.name + "' has values that are too large for single precision");
          }
          numbers[c * count + k] = number;
        }
        ++next;
      }
      // Per area of the square, over what `vndf` makes of it.
      luminance[k] = bright[k] * stretch_at(points[k], places[k]) / visible.at(points[k]);
      mean += luminance[k] / static_cast<double>(count);
    }
    // A density of 0 between nodes would hide what light there is.
    for (double& value : luminance) value = mean > 0 ? std::max(value, kLeastLuminance * mean) : 1;
    std::ranges::copy(visible.values(), all.visible.begin() + static_cast<std::ptrdiff_t>(slice * side() * side()));
    std::ranges::copy(normalised(luminance, nodes, nodes),
                      all.luminance.begin() + static_cast<std::ptrdiff_t>(slice * count));
  }

  /// Density of the half-vectors that get nodes: of those of viewers above the horizon, and a rim beyond, for a density
  /// that is linear between nodes would end before the horizon.
  [[nodiscard]] SquareGrid visible_normals(const Vector3d& light, const Directions& angles) const {
    const std::size_t nodes = side();
    std::vector<ReflectedPair> places;
    for (std::size_t k = 0; k < nodes * nodes; ++k) {
      places.push_back(reflected(light, angles, {node_at(k % nodes, nodes), node_at(k / nodes, nodes)}));
    }
    const std::vector<double> bright = light_of(places, values_at(pairs_of(places)));
    const auto stretch = [&](std::size_t k) { return stretch_at({node_at(k % nodes, nodes), 0}, places[k]); };
    double albedo = 0;
    for (std::size_t k = 0; k < places.size(); ++k) {
      albedo += trapezoid(k % nodes, nodes) * trapezoid(k / nodes, nodes) * stretch(k) * bright[k];
    }
    const auto is_rim = [&](std::size_t k) {
      const std::size_t turn = nodes - 1;
      const std::size_t i = k % nodes;
      const std::size_t j = k / nodes % turn;
      for (const std::size_t row : {(j + turn - 1) % turn, j, (j + 1) % turn}) {
        for (std::size_t column = i - std::min<std::size_t>(i, 1); column <= std::min(i + 1, nodes - 1); ++column) {
          if (places[row * nodes + column].cosine > 0) return true;
        }
      }
      return false;
    };
    std::vector<double> density_at(places.size());
    for (std::size_t k = 0; k < places.size(); ++k) {
      if (places[k].cosine <= 0 && !is_rim(k)) continue;
      const double even = kEvenView / (2 * pi) * stretch(k);
      density_at[k] =
          kEvenSquare + even + (albedo > 0 ? (1 - kEvenSquare - kEvenView) * bright[k] * stretch(k) / albedo : 0);
    }
    return {nodes, nodes, normalised(density_at, nodes, nodes)};
  }

  const BrdfFunction& brdf_;
  const WriteOptions& options_;
  RglChannels channels_;
  std::size_t azimuths_ = 1;
};

}  // namespace

std::string write_rgl(const BrdfFunction& brdf, const WriteOptions& options) {
  return RglWriter(brdf, options).content();
}

}  // namespace lobe
