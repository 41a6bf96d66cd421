#include "formats/scatfun_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "core/parallel.hpp"
#include "hemisphere/gauss.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/error.hpp"

namespace lobe {
namespace {

static_assert(std::endian::native == std::endian::little);

using std::numbers::pi;

constexpr std::size_t kSide = 64;       // nodes of each hemisphere
constexpr std::size_t kAzimuths = 513;  // at which series are determined, of a half turn, both ends included
constexpr double kLeast = 1e-6;         // coefficients at the end of a series, of its largest, that are left out
constexpr double kNearHorizon = 1e-3;   // cosine: functions may be anything there

template <typename Number>
void append(std::string& content, Number number) {
  char bytes[sizeof(Number)];
  std::memcpy(bytes, &number, sizeof(Number));
  content.append(bytes, sizeof(Number));
}

/// Cosines of both hemispheres, rising, with 0 twice: dense towards 0 and 1, as Gauss rules are.
std::vector<double> cosines() {
  std::vector<double> side{0};
  for (const double node : gauss_rule(static_cast<int>(kSide - 2)).nodes) side.push_back(node);
  side.push_back(1);
  std::vector<double> all;
  for (std::size_t k = side.size(); k-- > 0;) all.push_back(-side[k]);
  all.insert(all.end(), side.begin(), side.end());
  return all;
}

/// The matrix that takes values at even steps of half a turn, both ends included, to coefficients a_k of
/// sum a_k cos(k phi).
Eigen::MatrixXd series_matrix() {
  constexpr auto kLast = static_cast<Eigen::Index>(kAzimuths - 1);
  Eigen::VectorXd cosine(2 * kLast);
  for (Eigen::Index k = 0; k < cosine.size(); ++k) {
    cosine(k) = std::cos(pi * static_cast<double>(k) / static_cast<double>(kLast));
  }
  Eigen::MatrixXd matrix(kLast, kLast + 1);
  for (Eigen::Index order = 0; order < kLast; ++order) {
    for (Eigen::Index j = 0; j <= kLast; ++j) {
      const double weight = j == 0 || j == kLast ? 0.5 : 1;
      matrix(order, j) = (order == 0 ? 1 : 2) * weight * cosine(order * j % cosine.size()) / static_cast<double>(kLast);
    }
  }
  return matrix;
}

/// Series of all channels for a pair of nodes, as long as the longest of them.
using PairSeries = std::vector<std::vector<double>>;

PairSeries shortened(PairSeries all) {
  std::size_t length = 0;
  for (const auto& a : all) {
    double largest = 0;
    for (const double one : a) largest = std::max(largest, std::abs(one));
    std::size_t own = a.size();
    while (own > 0 && std::abs(a[own - 1]) <= kLeast * largest) --own;
    length = std::max(length, own);
  }
  for (auto& a : all) a.resize(length);
  return all;
}

/// f times the light's cosine by azimuth from the mirror side, and by channel for each light: luminance, red and blue
/// of three.
Eigen::MatrixXd values_of(const BrdfFunction& brdf, std::span<const double> mu_in, double mu_out) {
  std::vector<Directions> pairs;
  for (const double mu : mu_in) {
    for (std::size_t j = 0; j < kAzimuths; ++j) {
      const double phi = pi * static_cast<double>(j) / (kAzimuths - 1);
      pairs.push_back({std::acos(std::max(mu, kNearHorizon)), std::acos(std::max(mu_out, kNearHorizon)), pi - phi, 0});
    }
  }
  Eigen::MatrixXd values = brdf.at(pairs).value;
  if (!values.allFinite()) throw NumericError("'" + brdf.name + "' has values that are no finite numbers");
  if (values.cols() == 3) {
    const Eigen::VectorXd luminance = values * Eigen::Map<const Eigen::Vector3d>(kScatfunLuminance.data());
    values.col(1) = values.col(0);
    values.col(0) = luminance;
  }
  Eigen::MatrixXd result(static_cast<Eigen::Index>(kAzimuths), static_cast<Eigen::Index>(mu_in.size()) * values.cols());
  for (std::size_t in = 0; in < mu_in.size(); ++in) {
    const auto light = static_cast<Eigen::Index>(in);
    result.middleCols(light * values.cols(), values.cols()) =
        mu_in[in] * values.middleRows(light * result.rows(), result.rows());
  }
  return result;
}

/// Integrals of the spline through some values up to each node (Catmull-Rom, one-sided at the ends).
std::vector<double> integrals_of(const std::vector<double>& nodes, const std::vector<double>& values) {
  const std::size_t last = nodes.size() - 1;
  std::vector<double> sums{0};
  for (std::size_t i = 0; i < last; ++i) {
    const double width = nodes[i + 1] - nodes[i];
    const auto slope = [&](std::size_t from, std::size_t to) {
      return width * (values[to] - values[from]) / (nodes[to] - nodes[from]);
    };
    const double before = slope(i > 0 ? i - 1 : i, i + 1);
    const double after = slope(i, i + 2 <= last ? i + 2 : i + 1);
    sums.push_back(sums.back() + (width > 0 ? width * ((values[i] + values[i + 1]) / 2 + (before - after) / 12) : 0));
  }
  return sums;
}

void check(const BrdfFunction& brdf) {
  if (!brdf.is_isotropic || !brdf.is_bilateral) {
    throw ArgumentError(
        fmt::format("'{}' is {}; SCATFUN files are written of isotropic reflectances, the same on both "
                    "sides of the plane of incidence",
                    brdf.name, brdf.is_isotropic ? "not the same on both sides" : "anisotropic"));
  }
  if (brdf.channels.size() != 1 && (brdf.channels.size() != 3 || !brdf.wavelengths.empty())) {
    throw ArgumentError(fmt::format("'{}' has {} channels; SCATFUN files hold one, or red, green and blue", brdf.name,
                                    brdf.channels.size()));
  }
}

}  // namespace

std::string write_scatfun(const BrdfFunction& brdf, const WriteOptions& options) {
  check(brdf);
  const std::vector<double> nodes = cosines();
  const std::size_t count = nodes.size();
  // Light from above travels down, mu_in < 0, and is reflected up, mu_out > 0.
  std::vector<double> mu_in;
  for (std::size_t in = 0; in < kSide; ++in) mu_in.push_back(-nodes[in]);
  const Eigen::MatrixXd matrix = series_matrix();
  std::vector<PairSeries> series(kSide * kSide);
  const auto make = [&](std::size_t out) {
    const Eigen::MatrixXd all = matrix * values_of(brdf, mu_in, nodes[kSide + out]);
    const auto channels = all.cols() / static_cast<Eigen::Index>(kSide);
    for (std::size_t in = 0; in < kSide; ++in) {
      PairSeries of_pair;
      for (Eigen::Index c = 0; c < channels; ++c) {
        const auto a = all.col(static_cast<Eigen::Index>(in) * channels + c);
        of_pair.emplace_back(a.begin(), a.end());
      }
      series[out * kSide + in] = shortened(std::move(of_pair));
    }
  };
  if (brdf.is_concurrent) {
    parallel_for(kSide, make);
  } else {
    for (std::size_t out = 0; out < kSide; ++out) make(out);
  }

  std::string places;
  std::string coefficients;
  std::string integrals;
  std::size_t longest = 0;
  for (std::size_t out = 0; out < count; ++out) {
    std::vector<double> means(count);
    for (std::size_t in = 0; in < count; ++in) {
      const bool is_reflected = in < kSide && out >= kSide;
      const PairSeries* all = is_reflected ? &series[(out - kSide) * kSide + in] : nullptr;
      const std::size_t length = all == nullptr ? 0 : all->front().size();
      append(places, static_cast<std::uint32_t>(coefficients.size() / sizeof(float)));
      append(places, static_cast<std::uint32_t>(length));
      longest = std::max(longest, length);
      if (length == 0) continue;
      means[in] = all->front().front();
      for (const auto& a : *all) {
        for (const double one : a) append(coefficients, static_cast<float>(one));
      }
    }
    for (const double sum : integrals_of(nodes, means)) append(integrals, static_cast<float>(sum));
  }

  std::string content(kScatfunMagic);
  append(content, std::uint8_t{1});
  constexpr std::uint32_t kSeries = 1;  // flags: plain series
  const std::size_t metadata = options.command_line.size();
  for (const std::size_t number : {std::size_t{kSeries}, count, coefficients.size() / sizeof(float), longest,
                                   brdf.channels.size(), std::size_t{1}, metadata, std::size_t{0}, std::size_t{0}}) {
    append(content, static_cast<std::uint32_t>(number));
  }
  append(content, 1.0F);  // relative refractive index: none
  content.resize(kScatfunHeader, '\0');
  for (const double node : nodes) append(content, static_cast<float>(node));
  return content + integrals + places + coefficients + options.command_line;
}

}  // namespace lobe
