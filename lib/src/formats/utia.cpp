// Anisotropic measurements over four angles.
// Source: Filip and Vávra 2014 ("Template-based sampling of anisotropic BRDFs").
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <memory>
#include <numbers>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/parallel.hpp"
#include "core/text.hpp"
#include "formats/byte_reader.hpp"
#include "formats/format.hpp"
#include "formats/neighbours.hpp"
#include "formats/number_census.hpp"
#include "lobe/core/error.hpp"

namespace lobe {
namespace {

using std::numbers::pi;

constexpr std::size_t kChannels = 3;

/// Angles of both L and V: theta from 0 on, phi over a whole turn.
struct AngleGrid {
  std::size_t thetas;
  std::size_t phis;
  double theta_step_deg;

  [[nodiscard]] constexpr std::size_t directions() const { return thetas * phis; }
  [[nodiscard]] constexpr std::size_t values() const { return directions() * directions(); }
  [[nodiscard]] constexpr std::size_t bytes() const { return kChannels * values() * sizeof(double); }
  [[nodiscard]] double theta_step() const { return theta_step_deg * pi / 180; }
  [[nodiscard]] double phi_step() const { return 2 * pi / static_cast<double>(phis); }
  [[nodiscard]] Direction direction(std::size_t index) const {
    const std::size_t ring = index / phis;
    return {static_cast<double>(ring) * theta_step(), static_cast<double>(index % phis) * phi_step()};
  }
  [[nodiscard]] double theta_max_deg() const { return static_cast<double>(thetas - 1) * theta_step_deg; }
};

constexpr AngleGrid kUsual{6, 48, 15};
constexpr AngleGrid kDense{44, 180, 2};

/// IEC 61966-2-1, odd in its argument.
double decoded(double value) {
  const double size = std::abs(value);
  const double linear = size <= 0.04045 ? size / 12.92 : std::pow((size + 0.055) / 1.055, 2.4);
  return std::copysign(linear, value);
}

/// The content as it lies in the file, or decoded.
class UtiaFile {
 public:
  UtiaFile(FileBytes file, const AngleGrid& grid, bool decode) : file_(std::move(file)), grid_(grid) {
    const std::size_t count = kChannels * grid_.values();
    const NumberCensus found = census<double>(file_.content(), 0, count);
    if (found.not_finite > 0) refuse_first_not_finite();
    negative_ = found.negative;
    if (!decode) return;
    decoded_.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
      decoded_.push_back(decoded(number_at<double>(file_.content(), i * sizeof(double))));
    }
  }

  [[nodiscard]] std::vector<std::string> remarks() const {
    if (negative_ == 0) return {};
    return {fmt::format("{} of {} values are negative, and kept", negative_, kChannels * grid_.values())};
  }

  [[nodiscard]] BrdfValues at(std::span<const Directions> pairs) const {
    BrdfValues values;
    values.value.resize(static_cast<Eigen::Index>(pairs.size()), kChannels);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const Directions& pair = pairs[i];
      const auto in = corners_of(pair.theta_in, pair.phi_in);
      const auto out = corners_of(pair.theta_out, pair.phi_in + pair.delta_phi);
      for (std::size_t c = 0; c < kChannels; ++c) {
        values.value(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(c)) = mean(c, in, out);
      }
    }
    return values;
  }

 private:
  struct Corner {
    std::size_t index;
    double weight;
  };

  /// The four directions about one.
  [[nodiscard]] std::array<Corner, 4> corners_of(double theta, double phi) const {
    const Neighbours t = clamped_neighbours(theta / grid_.theta_step(), grid_.thetas);
    const Neighbours p = periodic_neighbours(phi / grid_.phi_step(), grid_.phis);
    return {{{t.below * grid_.phis + p.below, (1 - t.share) * (1 - p.share)},
             {t.below * grid_.phis + p.above, (1 - t.share) * p.share},
             {t.above * grid_.phis + p.below, t.share * (1 - p.share)},
             {t.above * grid_.phis + p.above, t.share * p.share}}};
  }

  [[nodiscard]] double mean(std::size_t channel, const std::array<Corner, 4>& in,
                            const std::array<Corner, 4>& out) const {
    double sum = 0;
    for (const Corner& from : in) {
      for (const Corner& to : out) {
        sum += from.weight * to.weight * value(channel * grid_.values() + from.index * grid_.directions() + to.index);
      }
    }
    return sum;
  }

  [[noreturn]] void refuse_first_not_finite() const {
    std::size_t index = 0;
    while (std::isfinite(value(index))) ++index;
    file_.refuse_at(index * sizeof(double), "a value is no finite number");
  }

  [[nodiscard]] double value(std::size_t index) const {
    return decoded_.empty() ? number_at<double>(file_.content(), index * sizeof(double)) : decoded_[index];
  }

  FileBytes file_;
  AngleGrid grid_;
  std::size_t negative_ = 0;
  std::vector<double> decoded_;
};

bool recognises(const FileBytes& head) {
  return head.file_size() == kUsual.bytes() || head.file_size() == kDense.bytes();
}

BrdfFunction read(const FileBytes& file, const ReadOptions& options) {
  const AngleGrid grid = file.size() == kDense.bytes() ? kDense : kUsual;
  if (file.size() != grid.bytes()) {
    file.refuse_at(std::min(file.size(), grid.bytes()), fmt::format("the file has {} bytes; expected {} or {}",
                                                                    file.size(), kUsual.bytes(), kDense.bytes()));
  }
  const auto content = std::make_shared<const UtiaFile>(file, grid, options.decode_srgb);
  BrdfFunction brdf;
  brdf.name = file.stem();
  brdf.format = kUtiaFormat.title;
  brdf.conventions = fmt::format(
      "sr^-1 without cosine, {}; azimuths of light and viewer about the same axis, equal ones on the retro side; "
      "linear "
      "between angles of {} degrees from the normal and {} in azimuth, constant beyond {} degrees from the normal",
      options.decode_srgb ? "decoded from sRGB before the interpolation" : "values as the file has them",
      shortest(grid.theta_step_deg), shortest(360 / static_cast<double>(grid.phis)), shortest(grid.theta_max_deg()));
  brdf.channels = {"red", "green", "blue"};
  brdf.remarks = content->remarks();
  brdf.is_isotropic = false;
  brdf.at = [content](std::span<const Directions> pairs) { return content->at(pairs); };
  return brdf;
}

std::string write(const BrdfFunction& brdf, const WriteOptions&) {
  static_assert(std::endian::native == std::endian::little);
  constexpr AngleGrid kGrid = kUsual;
  if (brdf.channels.size() != 1 && brdf.channels.size() != kChannels) {
    throw ArgumentError(fmt::format("'{}' has {} channels; UTIA files hold red, green and blue, or one channel as all",
                                    brdf.name, brdf.channels.size()));
  }
  std::vector<double> content(kChannels * kGrid.values());
  parallel_for(kGrid.directions(), [&](std::size_t in) {
    const Direction from = kGrid.direction(in);
    std::vector<Directions> pairs;
    for (std::size_t out = 0; out < kGrid.directions(); ++out) {
      const Direction to = kGrid.direction(out);
      pairs.push_back({from.theta, to.theta, std::remainder(to.phi - from.phi, 2 * pi), from.phi});
    }
    const Eigen::MatrixXd values = brdf.at(pairs).value;
    if (!values.allFinite()) throw NumericError("'" + brdf.name + "' has values that are no finite numbers");
    for (std::size_t c = 0; c < kChannels; ++c) {
      const Eigen::Index channel = values.cols() == 1 ? 0 : static_cast<Eigen::Index>(c);
      std::ranges::copy(values.col(channel),
                        content.begin() + static_cast<std::ptrdiff_t>(c * kGrid.values() + in * kGrid.directions()));
    }
  });
  return {reinterpret_cast<const char*>(content.data()), kGrid.bytes()};
}

}  // namespace

const Format kUtiaFormat{"utia", "UTIA .bin (Filip and Vávra 2014)", recognises, read, false, write};

}  // namespace lobe
