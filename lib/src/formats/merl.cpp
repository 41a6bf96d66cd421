// Isotropic measurements over half-vector and difference angles.
// Source: Matusik, Pfister, Brand and McMillan 2003 ("A data-driven reflectance model"); angles of Rusinkiewicz 1998.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "core/parallel.hpp"
#include "formats/byte_reader.hpp"
#include "formats/format.hpp"
#include "formats/neighbours.hpp"
#include "lobe/core/error.hpp"

namespace lobe {
namespace {

using std::numbers::pi;

constexpr std::size_t kHeader = 3 * sizeof(std::int32_t);
constexpr std::size_t kChannels = 3;
constexpr std::array<double, kChannels> kScale{1.0 / 1500, 1.15 / 1500, 1.66 / 1500};
constexpr double kMissing = -1;
constexpr std::size_t kMostSteps = 1U << 15U;  // of one angle, which keeps their product within 64 bits

/// theta_h in steps that grow with it, theta_d and phi_d in equal ones; values belong to the middles of cells.
struct CellGrid {
  std::size_t theta_h = 90;
  std::size_t theta_d = 90;
  std::size_t phi_d = 180;

  [[nodiscard]] std::size_t size() const { return theta_h * theta_d * phi_d; }
  [[nodiscard]] std::size_t index(std::size_t h, std::size_t d, std::size_t p) const {
    return (h * theta_d + d) * phi_d + p;
  }
  /// Half a turn, after which L and V have changed places, or a whole one.
  [[nodiscard]] double period() const { return phi_d == 2 * theta_d ? pi : 2 * pi; }
  [[nodiscard]] std::size_t cells_of_half_turn() const { return phi_d == 2 * theta_d ? phi_d : phi_d / 2; }

  [[nodiscard]] double theta_h_of(std::size_t h) const {
    const double root = (static_cast<double>(h) + 0.5) / static_cast<double>(theta_h);
    return root * root * pi / 2;
  }
  [[nodiscard]] double theta_d_of(std::size_t d) const {
    return (static_cast<double>(d) + 0.5) / static_cast<double>(theta_d) * pi / 2;
  }
  [[nodiscard]] double phi_d_of(std::size_t p) const {
    return (static_cast<double>(p) + 0.5) / static_cast<double>(phi_d) * period();
  }

  bool operator==(const CellGrid&) const = default;
};

constexpr CellGrid kUsual{90, 90, 180};

struct HalfDifference {
  double theta_h;
  double theta_d;
  double phi_d;
};

/// Where L, V or H leave an azimuth open, it is the one that makes phi_d = 0.
HalfDifference half_difference(const Directions& pair) {
  constexpr double kOpen = 1e-12;  // sines of angles from the pole, of which rounding would make an azimuth
  const double sin_in = std::sin(pair.theta_in);
  const double cos_in = std::cos(pair.theta_in);
  const double x_out = std::sin(pair.theta_out) * std::cos(pair.delta_phi);
  const double y = std::sin(pair.theta_out) * std::sin(pair.delta_phi);
  const double cos_out = std::cos(pair.theta_out);
  const double sum_x = sin_in + x_out;
  const double sum_z = cos_in + cos_out;
  const double radius = std::hypot(sum_x, y);
  const double sum = std::hypot(radius, sum_z);
  // L - V has no part along H, and its direction outlives L close to V.
  const double x = sin_in - x_out;
  const double z = cos_in - cos_out;
  const double difference = std::sqrt(x * x + y * y + z * z);
  const bool is_up = radius < kOpen * sum;
  const double cos_phi = is_up ? 1 : sum_x / radius;
  const double sin_phi = is_up ? 0 : y / radius;
  const double along = (x * cos_phi - y * sin_phi) * sum_z - z * radius;
  const double across = (-x * sin_phi - y * cos_phi) * sum;
  return {std::atan2(radius, sum_z), std::atan2(difference, sum),
          difference < kOpen * sum ? 0 : std::atan2(across, along)};
}

/// L and V of a cell's middle, H at azimuth 0.
Directions directions_of(const HalfDifference& angles) {
  const double x = std::sin(angles.theta_d) * std::cos(angles.phi_d);
  const double y = std::sin(angles.theta_d) * std::sin(angles.phi_d);
  const double z = std::cos(angles.theta_d);
  const double cosine = std::cos(angles.theta_h);
  const double sine = std::sin(angles.theta_h);
  const double x_in = cosine * x + sine * z;
  const double x_out = -cosine * x + sine * z;
  return {std::atan2(std::hypot(x_in, y), cosine * z - sine * x),
          std::atan2(std::hypot(x_out, y), cosine * z + sine * x),
          std::remainder(std::atan2(-y, x_out) - std::atan2(y, x_in), 2 * pi), 0};
}

/// By theta_h and theta_d: the cells of a half-turn whose middle is above the horizon, for L and for V, are those from
/// the given one on to the one as far from the end.
std::vector<std::size_t> first_cells_above_horizon(const CellGrid& grid) {
  const std::size_t half = grid.cells_of_half_turn();
  std::vector<std::size_t> first(grid.theta_h * grid.theta_d);
  for (std::size_t h = 0; h < grid.theta_h; ++h) {
    for (std::size_t d = 0; d < grid.theta_d; ++d) {
      // Above the horizon: |cos phi_d| tan theta_h tan theta_d < 1.
      const double bound = 1 / (std::tan(grid.theta_h_of(h)) * std::tan(grid.theta_d_of(d)));
      const double place = bound >= 1 ? 0 : std::ceil(std::acos(bound) / pi * static_cast<double>(half) - 0.5);
      first[h * grid.theta_d + d] = std::min(static_cast<std::size_t>(std::max(place, 0.0)), (half + 1) / 2);
    }
  }
  return first;
}

/// Content of a file, read in place.
class MerlFile {
 public:
  MerlFile(FileBytes file, const CellGrid& grid)
      : file_(std::move(file)), grid_(grid), first_(first_cells_above_horizon(grid)) {
    check();
    find_last_resorts();
  }

  [[nodiscard]] std::vector<std::string> remarks() const {
    std::vector<std::string> found;
    if (missing_ > 0) {
      found.push_back(fmt::format(
          "{} of {} values above the horizon are missing (negative), and their neighbours count", missing_, above_));
    }
    if (unused_ > 0) found.push_back(fmt::format("{} values of cells below the horizon are not used", unused_));
    return found;
  }

  [[nodiscard]] BrdfValues at(std::span<const Directions> pairs) const {
    BrdfValues values;
    values.value.resize(static_cast<Eigen::Index>(pairs.size()), kChannels);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const auto value = at(half_difference(pairs[i]));
      for (std::size_t c = 0; c < kChannels; ++c) {
        values.value(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(c)) = value[c];
      }
    }
    return values;
  }

 private:
  struct Corner {
    std::size_t index;
    double weight;
  };

  [[nodiscard]] double raw(std::size_t channel, std::size_t index) const {
    return number_at<double>(file_.content(), offset(channel, index));
  }
  [[nodiscard]] std::size_t offset(std::size_t channel, std::size_t index) const {
    return kHeader + (channel * grid_.size() + index) * sizeof(double);
  }
  [[nodiscard]] bool is_above_horizon(std::size_t h, std::size_t d, std::size_t p) const {
    const std::size_t half = grid_.cells_of_half_turn();
    const std::size_t first = first_[h * grid_.theta_d + d];
    const std::size_t within = p < half ? p : p - half;
    return within >= first && within + first < half;
  }
  [[nodiscard]] bool is_known(std::size_t channel, std::size_t h, std::size_t d, std::size_t p) const {
    return is_above_horizon(h, d, p) && raw(channel, grid_.index(h, d, p)) >= 0;
  }

  /// Refuses values that are no finite numbers, and counts those that are missing.
  void check() {
    for (std::size_t c = 0; c < kChannels; ++c) {
      for (std::size_t row = 0; row < first_.size(); ++row) check_row(c, row);
    }
  }

  void check_row(std::size_t channel, std::size_t row) {
    const std::size_t half = grid_.cells_of_half_turn();
    const std::size_t first = first_[row];
    std::size_t negative = 0;
    std::size_t negative_above = 0;
    for (std::size_t begin = 0; begin < grid_.phi_d; begin += half) {
      for (std::size_t k = 0; k < half; ++k) {
        const double value = raw(channel, row * grid_.phi_d + begin + k);
        if (!(std::abs(value) <= std::numeric_limits<double>::max())) {
          file_.refuse_at(offset(channel, row * grid_.phi_d + begin + k), "a value is no finite number");
        }
        negative += static_cast<std::size_t>(value < 0);
        negative_above += static_cast<std::size_t>(value < 0 && k >= first && k + first < half);
      }
    }
    const std::size_t above = (half - std::min(2 * first, half)) * (grid_.phi_d / half);
    above_ += above;
    missing_ += negative_above;
    unused_ += (grid_.phi_d - above) - (negative - negative_above);
  }

  /// By channel and phi_d: a known value that is near theta_h = theta_d = 0, where every search ends.
  void find_last_resorts() {
    for (std::size_t c = 0; c < kChannels; ++c) {
      double known = -1;
      std::vector<double> found;
      for (std::size_t p = 0; p < grid_.phi_d; ++p) {
        found.push_back(first_known(c, p));
        if (known < 0) known = found.back();
      }
      if (known < 0) file_.refuse_at(offset(c, 0), "all values of a channel are missing; expected some above 0");
      for (double& value : found) {
        if (value < 0) value = known;
        known = value;
      }
      last_resort_[c] = std::move(found);
    }
  }

  [[nodiscard]] double first_known(std::size_t channel, std::size_t p) const {
    for (std::size_t h = 0; h < grid_.theta_h; ++h) {
      for (std::size_t d = 0; d < grid_.theta_d; ++d) {
        if (is_known(channel, h, d, p)) return raw(channel, grid_.index(h, d, p));
      }
    }
    return kMissing;
  }

  /// The first known value towards smaller theta_d, then towards smaller theta_h.
  [[nodiscard]] double nearest_known(std::size_t channel, std::size_t h, std::size_t d, std::size_t p) const {
    for (std::size_t k = d + 1; k-- > 0;) {
      if (is_known(channel, h, k, p)) return raw(channel, grid_.index(h, k, p));
    }
    for (std::size_t k = h; k-- > 0;) {
      if (is_known(channel, k, 0, p)) return raw(channel, grid_.index(k, 0, p));
    }
    return last_resort_[channel][p];
  }

  [[nodiscard]] std::array<double, kChannels> at(const HalfDifference& angles) const {
    const auto steps_h = static_cast<double>(grid_.theta_h);
    const auto steps_d = static_cast<double>(grid_.theta_d);
    const auto steps_p = static_cast<double>(grid_.phi_d);
    const Neighbours h = clamped_neighbours(steps_h * std::sqrt(angles.theta_h * 2 / pi) - 0.5, grid_.theta_h);
    const Neighbours d = clamped_neighbours(steps_d * (angles.theta_d * 2 / pi) - 0.5, grid_.theta_d);
    const Neighbours p = periodic_neighbours(steps_p * (angles.phi_d / grid_.period()) - 0.5, grid_.phi_d);

    std::array<Corner, 8> corners{};
    std::size_t count = 0;
    const auto add = [&](std::size_t at_h, std::size_t at_d, std::size_t at_p, double weight) {
      if (weight > 0 && is_above_horizon(at_h, at_d, at_p)) corners[count++] = {grid_.index(at_h, at_d, at_p), weight};
    };
    for (const auto& [at_h, share_h] : {std::pair(h.below, 1 - h.share), std::pair(h.above, h.share)}) {
      for (const auto& [at_d, share_d] : {std::pair(d.below, 1 - d.share), std::pair(d.above, d.share)}) {
        add(at_h, at_d, p.below, share_h * share_d * (1 - p.share));
        add(at_h, at_d, p.above, share_h * share_d * p.share);
      }
    }

    std::array<double, kChannels> values{};
    for (std::size_t c = 0; c < kChannels; ++c) {
      double sum = 0;
      double total = 0;
      for (const Corner& corner : std::span(corners).first(count)) {
        const double value = raw(c, corner.index);
        if (value < 0) continue;
        sum += corner.weight * value;
        total += corner.weight;
      }
      const double mean = total > 0 ? sum / total : nearest_known(c, nearest(h), nearest(d), nearest(p));
      values[c] = mean * kScale[c];
    }
    return values;
  }

  [[nodiscard]] static std::size_t nearest(const Neighbours& two) { return two.share < 0.5 ? two.below : two.above; }

  FileBytes file_;
  CellGrid grid_;
  std::vector<std::size_t> first_;
  std::array<std::vector<double>, kChannels> last_resort_;
  std::size_t above_ = 0;
  std::size_t missing_ = 0;
  std::size_t unused_ = 0;
};

std::array<std::uint32_t, 3> counts_of(std::string_view content) {
  return {number_at<std::uint32_t>(content, 0), number_at<std::uint32_t>(content, 4),
          number_at<std::uint32_t>(content, 8)};
}

bool is_big_endian(std::array<std::uint32_t, 3> counts) {
  return counts[0] == 90U << 24U && counts[1] == 90U << 24U;
}

/// \param counts each up to kMostSteps
std::uintmax_t size_of(const std::array<std::uint32_t, 3>& counts) {
  return kHeader + std::uintmax_t{counts[0]} * counts[1] * counts[2] * kChannels * sizeof(double);
}

bool are_in_range(const std::array<std::uint32_t, 3>& counts) {
  return std::ranges::all_of(counts, [](std::uint32_t count) { return count >= 1 && count <= kMostSteps; });
}

bool recognises(const FileBytes& head) {
  if (head.size() < kHeader) return false;
  const auto counts = counts_of(head.content());
  const bool is_usual = counts[0] == kUsual.theta_h && counts[1] == kUsual.theta_d;
  return is_usual || is_big_endian(counts) || (are_in_range(counts) && head.file_size() == size_of(counts));
}

CellGrid read_grid(const FileBytes& file) {
  if (file.size() < kHeader) file.refuse_at(file.size(), "the file ends within the numbers of cells");
  const auto counts = counts_of(file.content());
  if (is_big_endian(counts)) file.refuse_at(0, "the numbers are big-endian; expected little-endian ones");
  if (!are_in_range(counts)) {
    file.refuse_at(
        0, fmt::format("{} x {} x {} cells; expected 90 x 90 x 180 or 90 x 90 x 360", counts[0], counts[1], counts[2]));
  }
  const std::uintmax_t size = size_of(counts);
  if (file.size() != size) {
    file.refuse_at(std::min<std::uintmax_t>(file.size(), size),
                   fmt::format("the file has {} bytes; expected {} for {} x {} x {} cells", file.size(), size,
                               counts[0], counts[1], counts[2]));
  }
  if (counts[2] != 2 * counts[1] && counts[2] != 4 * counts[1]) {
    file.refuse_at(8, fmt::format("{} cells of phi_d; expected twice or four times the {} of theta_d, for half a turn "
                                  "or a whole one",
                                  counts[2], counts[1]));
  }
  return {counts[0], counts[1], counts[2]};
}

BrdfFunction read(const FileBytes& file, const ReadOptions&) {
  const auto content = std::make_shared<const MerlFile>(file, read_grid(file));
  BrdfFunction brdf;
  brdf.name = file.stem();
  brdf.format = kMerlFormat.title;
  brdf.conventions =
      "sr^-1 without cosine, raw values by 1/1500, 1.15/1500 and 1.66/1500; half-vector and difference angles "
      "(Rusinkiewicz 1998), linear between the middles of cells in sqrt(theta_h), theta_d and phi_d, constant beyond "
      "the outermost; cells that are negative or below the horizon do not count; where no neighbour does, the next "
      "towards smaller theta_d, then theta_h";
  brdf.channels = {"red", "green", "blue"};
  brdf.remarks = content->remarks();
  brdf.at = [content](std::span<const Directions> pairs) { return content->at(pairs); };
  return brdf;
}

/// A third of the file: all values of a channel.
void append(std::string& content, const std::vector<double>& raw) {
  content.append(reinterpret_cast<const char*>(raw.data()), raw.size() * sizeof(double));
}

std::string write(const BrdfFunction& brdf, const WriteOptions&) {
  static_assert(std::endian::native == std::endian::little);
  constexpr CellGrid kGrid = kUsual;
  if (brdf.channels.size() != 1 && brdf.channels.size() != kChannels) {
    throw ArgumentError(fmt::format("'{}' has {} channels; MERL files hold red, green and blue, or one channel as all",
                                    brdf.name, brdf.channels.size()));
  }
  if (!brdf.is_isotropic) {
    throw ArgumentError("'" + brdf.name + "' is anisotropic; MERL files hold isotropic reflectances");
  }
  const auto first = first_cells_above_horizon(kGrid);
  std::array<std::vector<double>, kChannels> raw;
  for (auto& channel : raw) channel.assign(kGrid.size(), kMissing);
  parallel_for(kGrid.theta_h, [&](std::size_t h) {
    std::vector<Directions> pairs;
    std::vector<std::size_t> cells;
    for (std::size_t d = 0; d < kGrid.theta_d; ++d) {
      const std::size_t begin = first[h * kGrid.theta_d + d];
      for (std::size_t p = begin; p + begin < kGrid.phi_d; ++p) {
        pairs.push_back(directions_of({kGrid.theta_h_of(h), kGrid.theta_d_of(d), kGrid.phi_d_of(p)}));
        cells.push_back(kGrid.index(h, d, p));
      }
    }
    if (pairs.empty()) return;
    const Eigen::MatrixXd values = brdf.at(pairs).value;
    for (std::size_t c = 0; c < kChannels; ++c) {
      const Eigen::Index channel = values.cols() == 1 ? 0 : static_cast<Eigen::Index>(c);
      for (std::size_t i = 0; i < cells.size(); ++i) {
        // Where any number reads back as the value, the quotient does: no neighbour did better for any of 1.8e8.
        const double found = values(static_cast<Eigen::Index>(i), channel) / kScale[c];
        if (!std::isfinite(found)) throw NumericError("'" + brdf.name + "' has values that are no finite numbers");
        if (found < 0) {
          throw NumericError("'" + brdf.name + "' has negative values, by which MERL files mark missing ones");
        }
        raw[c][cells[i]] = found;
      }
    }
  });
  std::string content;
  content.reserve(kHeader + kChannels * kGrid.size() * sizeof(double));
  for (const std::size_t count : {kGrid.theta_h, kGrid.theta_d, kGrid.phi_d}) {
    const auto number = static_cast<std::int32_t>(count);
    content.append(reinterpret_cast<const char*>(&number), sizeof(number));
  }
  for (const auto& channel : raw) append(content, channel);
  return content;
}

}  // namespace

const Format kMerlFormat{"merl", "MERL .binary (Matusik et al. 2003)", recognises, read, false, write};

}  // namespace lobe
