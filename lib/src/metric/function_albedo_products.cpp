// Products of functions whose light comes from everywhere: of their albedos, each an adaptive quadrature.
#include <algorithm>
#include <cmath>
#include <mutex>
#include <numbers>
#include <utility>

#include "core/parallel.hpp"
#include "core/stopwatch.hpp"
#include "energy/elevation_integral.hpp"
#include "energy/joint_albedo.hpp"
#include "lobe/core/error.hpp"
#include "metric/domain.hpp"
#include "metric/function_products.hpp"
#include "metric/function_values.hpp"

namespace lobe {
namespace {

using Eigen::Index;
using Eigen::RowVectorXd;
using std::numbers::pi;

/// Share of the tolerance that each quadrature aims at: smooth functions reach it at once, and coefficients of
/// approximations magnify errors of products.
constexpr double kShare = 0.25;

/// Beyond these the errors of differences are those of both functions, added up.
constexpr std::size_t kMostDifferences = 4096;

/// Functions i < j, or i <= j.
struct Pair {
  Index i, j;
};

std::vector<Pair> all_pairs(std::size_t functions) {
  std::vector<Pair> pairs;
  const auto n = static_cast<Index>(functions);
  for (Index i = 0; i < n; ++i) {
    for (Index j = i + 1; j < n; ++j) pairs.push_back({i, j});
  }
  return pairs;
}

class AlbedoProducts {
 public:
  AlbedoProducts(std::span<const BrdfFunction> functions, std::size_t channels, const Lighting& lighting,
                 const FunctionMetricOptions& options)
      : functions_(functions),
        channels_(channels),
        lighting_(lighting),
        options_(options),
        lowest_(std::asin(cos_of_domain(options.theta_max, lighting))),
        pairs_(all_pairs(functions.size())),
        with_differences_(pairs_.size() * channels <= kMostDifferences),
        joint_(functions, channels,
               {.stays = JointAlbedo::Stays::viewer,
                .lobe_width = options.lobe_width,
                .lowest = lowest_,
                .with_differences = with_differences_}) {
    const bool is_isotropic = std::ranges::all_of(functions, &BrdfFunction::is_isotropic);
    turns_ = is_isotropic ? 1 : kFunctionAzimuths;
  }

  [[nodiscard]] std::vector<FunctionProducts> products(WorkDone& work) {
    Stopwatch watch;
    const bool is_daylight = lighting_ == Lighting::daylight();
    const ElevationSums means =
        integrate_elevations([&](std::span<const ElevationPlace> places) { return terms_at(places); },
                             {.relative = kShare * options_.tolerance,
                              .most_panels = is_fine() ? std::size_t{60} : std::size_t{16},
                              .lowest = lowest_,
                              .steering = static_cast<Index>(functions_.size() * channels_)});
    work.seconds_values += watch.lap();
    return is_daylight ? daylight(means) : mean_albedo(means);
  }

 private:
  /// Whether more is wanted than measured reflectances are worth.
  [[nodiscard]] bool is_fine() const { return options_.tolerance < 1e-3; }

  [[nodiscard]] JointSums albedos(const Direction& viewer) const {
    constexpr std::size_t kMostPoints = 12'000;
    constexpr std::size_t kMostFinePoints = 60'000;
    return joint_.at(viewer, kShare * options_.tolerance / 2, is_fine() ? kMostFinePoints : kMostPoints);
  }

  [[nodiscard]] std::vector<ElevationTerms> terms_at(std::span<const ElevationPlace> places) {
    std::vector<ElevationTerms> terms(places.size() * turns_);
    const auto one = [&](std::size_t k) {
      report();
      const auto [elevation, turn] = places[k / turns_];
      const double azimuth = 2 * pi * (static_cast<double>(k % turns_) + turn) / static_cast<double>(turns_);
      const JointSums sums = albedos({pi / 2 - elevation, azimuth});
      terms[k] = lighting_ == Lighting::daylight() ? squares(sums) : totals(sums);
    };
    if (std::ranges::all_of(functions_, &BrdfFunction::is_concurrent)) {
      parallel_for(terms.size(), one);
    } else {
      for (std::size_t k = 0; k < terms.size(); ++k) one(k);
    }
    if (turns_ == 1) return terms;
    std::vector<ElevationTerms> means;
    const double share = 1 / static_cast<double>(turns_);
    for (std::size_t k = 0; k < terms.size(); ++k) {
      const ElevationTerms& term = terms[k];
      const double odd_share = k % 2 == 1 ? share : -share;
      if (k % turns_ == 0) {
        means.push_back({share * term.value, share * share * term.square, odd_share * term.value, share * term.own});
        continue;
      }
      ElevationTerms& mean = means.back();
      mean.value += share * term.value;
      mean.square += share * share * term.square;
      mean.odd += odd_share * term.value;
      mean.own += share * term.own;
    }
    return means;
  }

  void report() {
    const std::scoped_lock lock(reporting_);
    if (options_.progress && !options_.progress(lighting_.name(), 0)) throw Cancelled("cancelled");
  }

  /// f.f of all functions and channels, f.g of all pairs and channels, |f - g|^2 of them; own errors squared.
  [[nodiscard]] ElevationTerms squares(const JointSums& sums) const {
    const auto channels = static_cast<Index>(channels_);
    const auto albedo = [&](Index f, Index c) -> Estimate {
      return {sums.value(f * channels + c), sums.quadrature(f * channels + c)};
    };
    const Index columns = sums.value.size();
    const auto pairs = static_cast<Index>(pairs_.size()) * channels;
    ElevationTerms terms{RowVectorXd(columns + 2 * pairs), RowVectorXd(columns + 2 * pairs), {}, sums.own.cwiseAbs2()};
    const auto set = [&terms](Index at, const Estimate& term) {
      terms.value(at) = term.value;
      terms.square(at) = term.error * term.error;
    };
    for (Index f = 0; f < static_cast<Index>(functions_.size()); ++f) {
      for (Index c = 0; c < channels; ++c) set(f * channels + c, albedo(f, c) * albedo(f, c));
    }
    for (Index p = 0; p < static_cast<Index>(pairs_.size()); ++p) {
      const auto [i, j] = pairs_[static_cast<std::size_t>(p)];
      for (Index c = 0; c < channels; ++c) {
        const Estimate a = albedo(i, c);
        const Estimate b = albedo(j, c);
        const Index at = p * channels + c;
        Estimate difference{a.value - b.value, a.error + b.error};
        if (with_differences_) difference = {sums.difference(at), sums.difference_quadrature(at)};
        set(columns + at, a * b);
        set(columns + pairs + at, difference * difference);
      }
    }
    return terms;
  }

  /// f of all functions and channels, f - g of all pairs and channels.
  [[nodiscard]] ElevationTerms totals(const JointSums& sums) const {
    const auto channels = static_cast<Index>(channels_);
    const Index columns = sums.value.size();
    const auto pairs = static_cast<Index>(pairs_.size()) * channels;
    ElevationTerms terms{RowVectorXd(columns + pairs), RowVectorXd(columns + pairs), {}, sums.own};
    terms.value.head(columns) = sums.value;
    terms.square.head(columns) = sums.quadrature.cwiseAbs2();
    if (with_differences_) {
      terms.value.tail(pairs) = sums.difference;
      terms.square.tail(pairs) = sums.difference_quadrature.cwiseAbs2();
      return terms;
    }
    for (Index p = 0; p < static_cast<Index>(pairs_.size()); ++p) {
      const auto [i, j] = pairs_[static_cast<std::size_t>(p)];
      for (Index c = 0; c < channels; ++c) {
        const Index at = columns + p * channels + c;
        const double error = sums.quadrature(i * channels + c) + sums.quadrature(j * channels + c);
        terms.value(at) = sums.value(i * channels + c) - sums.value(j * channels + c);
        terms.square(at) = error * error;
      }
    }
    return terms;
  }

  /// Sets products i, j of a channel. \param distance the squared one
  static void set(ChannelProducts& products, const Pair& pair, const Estimate& product, const Estimate& distance) {
    for (const auto& [i, j] : {pair, Pair{pair.j, pair.i}}) {
      products.gram(i, j) = product.value;
      products.gram_error(i, j) = product.error;
      products.squared_distance(i, j) = distance.value;
      products.squared_distance_error(i, j) = distance.error;
    }
  }

  [[nodiscard]] std::vector<FunctionProducts> daylight(const ElevationSums& means) const {
    const auto channels = static_cast<Index>(channels_);
    const Index columns = static_cast<Index>(functions_.size()) * channels;
    const auto pairs = static_cast<Index>(pairs_.size()) * channels;
    const auto mean = [&](Index at) -> Estimate { return {pi * means.value(at), pi * means.error(at)}; };
    std::vector<FunctionProducts> all(channels_, FunctionProducts(functions_.size()));
    for (Index c = 0; c < channels; ++c) {
      FunctionProducts& sums = all[static_cast<std::size_t>(c)];
      for (Index f = 0; f < static_cast<Index>(functions_.size()); ++f) {
        set(sums.products, {f, f}, mean(f * channels + c), {0, 0});
        sums.square_error(f) = pi * means.own(f * channels + c);
      }
      for (Index p = 0; p < static_cast<Index>(pairs_.size()); ++p) {
        const Index at = columns + p * channels + c;
        set(sums.products, pairs_[static_cast<std::size_t>(p)], mean(at), mean(at + pairs));
      }
    }
    return all;
  }

  [[nodiscard]] std::vector<FunctionProducts> mean_albedo(const ElevationSums& means) const {
    const auto channels = static_cast<Index>(channels_);
    const Index columns = static_cast<Index>(functions_.size()) * channels;
    const auto mean = [&](Index at) -> Estimate { return {pi * means.value(at), pi * means.error(at)}; };
    std::vector<FunctionProducts> all(channels_, FunctionProducts(functions_.size()));
    for (Index c = 0; c < channels; ++c) {
      FunctionProducts& sums = all[static_cast<std::size_t>(c)];
      for (Index f = 0; f < static_cast<Index>(functions_.size()); ++f) {
        const Estimate total = mean(f * channels + c);
        set(sums.products, {f, f}, total * total, {0, 0});
        const double own = pi * means.own(f * channels + c);
        sums.square_error(f) = own * own;
      }
      for (Index p = 0; p < static_cast<Index>(pairs_.size()); ++p) {
        const Pair& pair = pairs_[static_cast<std::size_t>(p)];
        const Estimate difference = mean(columns + p * channels + c);
        set(sums.products, pair, mean(pair.i * channels + c) * mean(pair.j * channels + c), difference * difference);
      }
    }
    return all;
  }

  std::span<const BrdfFunction> functions_;
  std::size_t channels_;
  const Lighting& lighting_;
  const FunctionMetricOptions& options_;
  double lowest_;
  std::vector<Pair> pairs_;
  bool with_differences_;
  JointAlbedo joint_;
  std::size_t turns_ = 1;
  std::mutex reporting_;
};

}  // namespace

std::vector<FunctionProducts> integrate_albedo_products(std::span<const BrdfFunction> functions, std::size_t channels,
                                                        const Lighting& lighting, const FunctionMetricOptions& options,
                                                        WorkDone& work) {
  return AlbedoProducts(functions, channels, lighting, options).products(work);
}

}  // namespace lobe
