#include "formats/scattered_brdf.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <utility>

#include "formats/interpolation_error.hpp"
#include "formats/local_interpolation.hpp"
#include "formats/pair_coordinates.hpp"
#include "formats/replicates.hpp"

namespace lobe {
namespace {

constexpr std::size_t kFewest = 8;     // points
constexpr double kTogether = 1e-5;     // distance of samples that count as one: of the digits of files, or
constexpr double kBeside = 0.01;       // of that of the samples around them, which noise would make walls of
constexpr std::size_t kTried = 300;    // points that choices are compared by
constexpr std::size_t kJudged = 4000;  // points that errors are taken from

double median_of(std::vector<double> values) {
  return quantile_of(std::move(values), 0.5);
}

/// Up to `most` numbers below `count`, evenly.
std::vector<std::size_t> some_of(std::size_t count, std::size_t most) {
  std::vector<std::size_t> chosen(std::min(count, most));
  for (std::size_t i = 0; i < chosen.size(); ++i) chosen[i] = i * count / chosen.size();
  return chosen;
}

/// Samples of which no two are at one point.
struct Points {
  std::vector<Directions> pairs;
  Eigen::MatrixXd values;
  Eigen::MatrixXd spread;  ///< half the range of those that count as one
  Eigen::MatrixXd replicates;
  std::size_t merged = 0;
  std::vector<double> disagreements;  ///< of those that count as one, relative
};

/// Those up to an angle; the others are counted.
ScatteredSamples within(const ScatteredSamples& samples, double theta_max, BrdfFunction& brdf) {
  std::vector<Eigen::Index> kept;
  ScatteredSamples result{{}, {}, samples.is_isotropic};
  for (std::size_t i = 0; i < samples.pairs.size(); ++i) {
    const Directions& pair = samples.pairs[i];
    if (std::max(pair.theta_in, pair.theta_out) > theta_max + kTogether) continue;
    kept.push_back(static_cast<Eigen::Index>(i));
    result.pairs.push_back(pair);
  }
  const auto columns = Eigen::seqN(0, samples.values.cols());
  result.values = samples.values(kept, columns);
  if (samples.deviations.size() > 0) result.deviations = samples.deviations(kept, columns);
  if (kept.size() < samples.pairs.size()) {
    brdf.remarks.push_back(fmt::format("{} of {} samples are beyond the largest angle that counts, and are left out",
                                       samples.pairs.size() - kept.size(), samples.pairs.size()));
  }
  return result;
}

/// \param replicates of the samples, side by side
Points merged(const ScatteredSamples& samples, const Eigen::MatrixXd& replicates) {
  constexpr std::size_t kAround = 6;
  const PointIndex index(PairCoordinates{.is_isotropic = samples.is_isotropic}.of(samples.pairs));
  std::vector<std::vector<std::size_t>> groups;
  std::vector<bool> is_taken(index.size(), false);
  for (std::size_t i = 0; i < index.size(); ++i) {
    if (is_taken[i]) continue;
    auto& group = groups.emplace_back();
    const double* point = index.points().col(static_cast<Eigen::Index>(i)).data();
    const double around = index.nearest(point, kAround + 1).back().distance;
    for (const auto& one : index.within(point, std::max(kTogether, kBeside * around))) {
      if (!is_taken[one.index]) group.push_back(one.index);
      is_taken[one.index] = true;
    }
  }
  Points points;
  const auto count = static_cast<Eigen::Index>(groups.size());
  points.values = Eigen::MatrixXd::Zero(count, samples.values.cols());
  points.spread = Eigen::MatrixXd::Zero(count, samples.values.cols());
  points.replicates = Eigen::MatrixXd::Zero(count, replicates.cols());
  for (Eigen::Index g = 0; g < count; ++g) {
    const auto& group = groups[static_cast<std::size_t>(g)];
    points.pairs.push_back(samples.pairs[group.front()]);
    Eigen::MatrixXd members(static_cast<Eigen::Index>(group.size()), samples.values.cols());
    for (Eigen::Index i = 0; i < members.rows(); ++i) {
      members.row(i) = samples.values.row(static_cast<Eigen::Index>(group[static_cast<std::size_t>(i)]));
    }
    points.values.row(g) = members.colwise().mean();
    for (std::size_t i = 0; replicates.cols() > 0 && i < group.size(); ++i) {
      points.replicates.row(g) +=
          replicates.row(static_cast<Eigen::Index>(group[i])) / static_cast<double>(group.size());
    }
    points.spread.row(g) = (members.colwise().maxCoeff() - members.colwise().minCoeff()) / 2;
    if (group.size() == 1) continue;
    points.merged += group.size() - 1;
    for (Eigen::Index c = 0; c < members.cols(); ++c) {
      const double mean = std::abs(points.values(g, c));
      if (mean > 0) points.disagreements.push_back(2 * points.spread(g, c) / mean);
    }
  }
  return points;
}

/// Of |f| where it is not 0, over all channels: what is dark is measured no better where another channel is bright.
double median_size(const Eigen::MatrixXd& values) {
  std::vector<double> sizes;
  for (const double value : values.reshaped()) {
    if (value != 0) sizes.push_back(std::abs(value));
  }
  const double largest = values.cwiseAbs().maxCoeff();
  return sizes.empty() ? 1 : std::max({median_of(std::move(sizes)), 1e-30 * largest, 1e-290});
}

/// y = asinh(f / scale): logarithmic for peaks, linear about 0.
struct Compression {
  double scale;

  [[nodiscard]] Eigen::MatrixXd of(const Eigen::MatrixXd& values) const {
    return (values.array() / scale).unaryExpr([](double x) { return std::asinh(x); });
  }
  [[nodiscard]] Eigen::MatrixXd back(const Eigen::MatrixXd& values) const { return scale * values.array().sinh(); }
};

/// Parameters chosen by left-out samples.
struct Choice {
  PairCoordinates coordinates;
  LocalScheme scheme;
  double medians = 1;  ///< s of the compression, in medians of |f|
};

/// Deviation of a value found from the one that is, relative to the latter where it is not small.
double relative_deviation(double found, double value, double median) {
  return std::abs(found - value) / (std::abs(value) + 0.1 * median);
}

class Chooser {
 public:
  Chooser(const Points& points, double median)
      : points_(points),
        arbitrary_(arbitrary_pairs(points.pairs)),
        tried_(some_of(points.pairs.size(), kTried)),
        median_(median) {}

  /// Starts anywhere and takes what is best of each setting in turn.
  [[nodiscard]] Choice best(bool is_isotropic) const {
    Choice choice;
    choice.coordinates.is_isotropic = is_isotropic;
    if (!is_isotropic) choice.scheme.neighbours = 60;
    const auto half_knees = knees(choice.coordinates, 0);
    const auto difference_knees = knees(choice.coordinates, choice.coordinates.dimensions() / 2);
    double least = deviation(choice);
    for (int round = 0; round < 2; ++round) {
      try_all(choice, least, std::array{0.01, 0.1, 1.0, 10.0}, [](Choice& c) -> double& { return c.medians; });
      try_all(choice, least, half_knees, [](Choice& c) -> double& { return c.coordinates.half_knee; });
      try_all(choice, least, difference_knees, [](Choice& c) -> double& { return c.coordinates.difference_knee; });
      try_all(choice, least, std::array{0.5, 1.0, 2.0, 4.0, 8.0},
              [](Choice& c) -> double& { return c.coordinates.half_scale; });
      if (is_isotropic) {
        try_all(choice, least, std::array{0.125, 0.25, 0.5, 1.0},
                [](Choice& c) -> double& { return c.coordinates.azimuth_scale; });
      }
      try_all(choice, least, std::array{1.0, 1.5, 1.75}, [](Choice& c) -> double& { return c.scheme.exponent; });
      try_all(choice, least, std::array{0.1, 1.0, 10.0}, [](Choice& c) -> double& { return c.scheme.trend; });
    }
    return choice;
  }

 private:
  /// Where samples lie: stretching what none of them sees would make peaks of nothing.
  /// \param first coordinate of the sine in question; anisotropic ones have it in two
  [[nodiscard]] std::vector<double> knees(const PairCoordinates& coordinates, Eigen::Index first) const {
    constexpr double kWithin = 0.01;  // share of the samples
    const Eigen::MatrixXd at = PairCoordinates{.is_isotropic = coordinates.is_isotropic}.of(points_.pairs);
    std::vector<double> sines;
    for (Eigen::Index i = 0; i < at.cols(); ++i) {
      sines.push_back(std::sinh(std::asinh(1.0) * at.col(i).segment(first, coordinates.is_isotropic ? 1 : 2).norm()));
    }
    const double least = quantile_of(std::move(sines), kWithin);
    std::vector<double> knees;
    for (const double knee : {0.01, 0.05, 0.2, 1.0}) {
      if (knee >= std::min(least, 1.0)) knees.push_back(knee);
    }
    return knees;
  }

  template <typename Setting>
  void try_all(Choice& choice, double& least, std::span<const double> values, Setting setting) const {
    const double before = setting(choice);
    for (const double value : values) {
      if (value == before) continue;
      Choice other = choice;
      setting(other) = value;
      const double found = deviation(other);
      if (!(found < least)) continue;
      least = found;
      choice = other;
    }
  }

  /// Mean over left-out samples, alone and with their surroundings; none counts more than 1.
  [[nodiscard]] double deviation(const Choice& choice) const {
    const PointIndex index(choice.coordinates.of(points_.pairs));
    const Compression compression{choice.medians * median_};
    const Eigen::MatrixXd values = compression.of(points_.values);
    double sum = 0;
    const std::vector<double> alone(tried_.size(), 0.0);
    for (const auto& radii : {alone, gaps_between(index, choice.coordinates, arbitrary_, tried_)}) {
      const Eigen::MatrixXd found = compression.back(left_out(index, values, choice.scheme, tried_, radii));
      for (Eigen::Index c = 0; c < found.cols(); ++c) {
        for (Eigen::Index i = 0; i < found.rows(); ++i) {
          const double value = points_.values(static_cast<Eigen::Index>(tried_[static_cast<std::size_t>(i)]), c);
          const double one = relative_deviation(found(i, c), value, median_);
          sum += std::min(one, 1.0);
        }
      }
    }
    return sum / (2.0 * static_cast<double>(tried_.size()) * static_cast<double>(points_.values.cols()));
  }

  const Points& points_;
  std::vector<Directions> arbitrary_;
  std::vector<std::size_t> tried_;
  double median_;
};

class ScatteredBrdf {
 public:
  ScatteredBrdf(PairCoordinates coordinates, Compression compression, LocalInterpolation interpolation,
                InterpolationError errors)
      : coordinates_(coordinates),
        compression_(std::move(compression)),
        interpolation_(std::move(interpolation)),
        errors_(std::move(errors)) {}

  [[nodiscard]] BrdfValues at(std::span<const Directions> pairs) const {
    const auto count = static_cast<Eigen::Index>(pairs.size());
    const Eigen::MatrixXd points = coordinates_.of(pairs);
    const Eigen::Index channels = interpolation_.channels();
    // Those of replicates are of no interest: 0.
    BrdfValues found{Eigen::MatrixXd(count, channels), Eigen::MatrixXd::Zero(count, channels)};
    for (Eigen::Index i = 0; i < count; ++i) {
      const double* point = points.col(i).data();
      const auto blend = interpolation_.blend(point);
      const Eigen::ArrayXd y = interpolation_.value(point, blend).transpose();
      // Others are as large as those near may be; so is the margin of the latter.
      const Eigen::ArrayXd judged = errors_.at(point, blend.front().distance).transpose().array();
      const Eigen::ArrayXd own = y.head(judged.size());
      const Eigen::ArrayXd most =
          (interpolation_.largest(blend).transpose().array().head(judged.size()) - own.abs()).max(0.0) +
          LocalScheme::kMostBeyond;
      const Eigen::ArrayXd error = judged.min(most);
      found.value.row(i) = (compression_.scale * y.sinh()).transpose();
      // The wider side of f(y +- error).
      found.error.row(i).head(judged.size()) =
          (compression_.scale * ((own.abs() + error).sinh() - own.abs().sinh() + kRounding * own.abs().cosh()))
              .transpose();
    }
    return found;
  }

 private:
  static constexpr double kRounding = 1e-13;  // of y, from sums of coefficients that cancel

  PairCoordinates coordinates_;
  Compression compression_;
  LocalInterpolation interpolation_;
  InterpolationError errors_;
};

LeaveOneOut quality_of(const Eigen::MatrixXd& found, const Eigen::MatrixXd& values, double median) {
  std::vector<double> deviations;
  double squares = 0;
  for (Eigen::Index i = 0; i < found.size(); ++i) {
    deviations.push_back(relative_deviation(found.reshaped()[i], values.reshaped()[i], median));
    squares += deviations.back() * deviations.back();
  }
  const double rms = std::sqrt(squares / static_cast<double>(deviations.size()));
  return {median_of(std::move(deviations)), rms};
}

std::string percent(double share) {
  return share < 0.1 ? fmt::format("{:.2g} %", 100 * share) : fmt::format("{:.0f} %", 100 * share);
}

void add_remarks(BrdfFunction& brdf, const ScatteredSamples& samples, const Points& points,
                 const LeaveOneOut& quality) {
  const auto negative = (samples.values.array() < 0).count();
  if (negative > 0) {
    brdf.remarks.push_back(fmt::format("{} of {} values are negative, and kept", negative, samples.values.size()));
  }
  if (points.merged > 0) {
    brdf.remarks.push_back(
        fmt::format("{} of {} samples are at the place of another one, by reciprocity or symmetry too; their mean is "
                    "taken, and they "
                    "differ by {} in the median",
                    points.merged, samples.pairs.size(), percent(median_of(points.disagreements))));
  }
  brdf.remarks.push_back(
      fmt::format("interpolated through {} points; one that is left out is found to {} in the median, {} rms",
                  points.pairs.size(), percent(quality.median), percent(quality.rms)));
}

/// Makes the reflectance of samples at only a few pairs of directions.
LeaveOneOut take_mean(const Points& points, BrdfFunction& brdf) {
  brdf.conventions += "; the mean of its samples for all directions";
  brdf.remarks.push_back(fmt::format(
      "samples at {} different pairs of directions, too few to interpolate: their mean is taken, and its error "
      "is unknown",
      points.pairs.size()));
  Eigen::RowVectorXd mean(points.values.cols() + points.replicates.cols());
  mean.head(points.values.cols()) = points.values.colwise().mean();
  if (brdf.replicates > 0) mean.tail(points.replicates.cols()) = points.replicates.colwise().mean();
  brdf.at = [mean](std::span<const Directions> pairs) {
    const auto count = static_cast<Eigen::Index>(pairs.size());
    const double unknown = std::numeric_limits<double>::quiet_NaN();
    return BrdfValues{mean.replicate(count, 1), Eigen::MatrixXd::Constant(count, mean.size(), unknown)};
  };
  return {};
}

}  // namespace

void SampleCollector::add(const Directions& pair, std::span<const double> values) {
  Directions& added = pairs_.emplace_back(pair);
  added.theta_in = std::clamp(pair.theta_in, 0.0, std::numbers::pi / 2);
  added.theta_out = std::clamp(pair.theta_out, 0.0, std::numbers::pi / 2);
  values_.insert(values_.end(), values.begin(), values.end());
}

void SampleCollector::reserve(std::size_t samples) {
  pairs_.reserve(samples);
  values_.reserve(samples * channels_);
}

ScatteredSamples SampleCollector::take(bool is_isotropic) {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Eigen::Map<const Rows> rows(values_.data(), static_cast<Eigen::Index>(pairs_.size()),
                                    static_cast<Eigen::Index>(channels_));
  return {std::move(pairs_), rows, is_isotropic};
}

void require_room(const FileBytes& file, std::size_t samples, std::size_t channels) {
  if (samples * channels <= LocalInterpolation::kMostValues) return;
  file.refuse_end(fmt::format("{} samples of {} channels; expected at most {} values in all to interpolate", samples,
                              channels, LocalInterpolation::kMostValues));
}

LeaveOneOut interpolate(const FileBytes& file, const ScatteredSamples& all, const ReadOptions& options,
                        BrdfFunction& brdf) {
  const ScatteredSamples samples = within(all, options.theta_max, brdf);
  if (samples.pairs.size() < kFewest) {
    file.refuse_end(fmt::format("{} samples; expected at least {}", samples.pairs.size(), kFewest));
  }
  require_room(file, samples.pairs.size(), static_cast<std::size_t>(samples.values.cols()));
  brdf.has_deviations = samples.deviations.size() > 0;
  brdf.samples =
      std::make_shared<const MeasuredSamples>(MeasuredSamples{samples.pairs, samples.values, samples.deviations});
  if (brdf.has_deviations) {
    brdf.replicates = possible_replicates(options.replicates, static_cast<std::size_t>(samples.values.size()),
                                          LocalInterpolation::kMostValues);
  }
  const Eigen::MatrixXd all_values =
      brdf.replicates > 0 ? with_replicates(samples.values, samples.deviations, brdf.replicates) : samples.values;
  // A block of no columns would begin behind the values.
  const Eigen::MatrixXd replicates =
      brdf.replicates > 0 ? Eigen::MatrixXd(all_values.rightCols(all_values.cols() - samples.values.cols()))
                          : Eigen::MatrixXd(all_values.rows(), 0);
  const Points points = merged(samples, replicates);
  brdf.is_isotropic = samples.is_isotropic;
  brdf.is_bilateral = samples.is_isotropic;
  if (points.pairs.size() < kFewest) return take_mean(points, brdf);
  const double median = median_size(points.values);
  const Choice choice = Chooser(points, median).best(samples.is_isotropic);
  const PointIndex index(choice.coordinates.of(points.pairs));
  const Compression compression{choice.medians * median};
  const Eigen::MatrixXd values = compression.of(points.values);

  const auto judged = some_of(points.pairs.size(), kJudged);
  const auto gaps = gaps_between(index, choice.coordinates, arbitrary_pairs(points.pairs), judged);
  const Eigen::MatrixXd alone = left_out(index, values, choice.scheme, judged, std::vector(judged.size(), 0.0));
  const Eigen::MatrixXd surrounded = left_out(index, values, choice.scheme, judged, gaps);
  const std::vector<Eigen::Index> rows(judged.begin(), judged.end());
  const auto channels = Eigen::seqN(0, values.cols());
  const Eigen::MatrixXd there = values(rows, channels);
  // Samples at one place may be off by as much as they differ.
  const Eigen::MatrixXd noise =
      (compression.of(points.values.cwiseAbs() + points.spread) - values.cwiseAbs())(rows, channels);
  const auto deviations = [&](const Eigen::MatrixXd& found) -> Eigen::MatrixXd {
    return ((found - there).cwiseAbs2() + noise.cwiseAbs2()).cwiseSqrt();
  };
  const LeaveOneOut quality = quality_of(compression.back(alone), points.values(rows, channels), median);
  Eigen::MatrixXd everything(values.rows(), values.cols() + points.replicates.cols());
  everything.leftCols(values.cols()) = values;
  if (brdf.replicates > 0) everything.rightCols(points.replicates.cols()) = compression.of(points.replicates);
  const ScatteredBrdf scattered(
      choice.coordinates, compression, LocalInterpolation(index, everything, choice.scheme),
      InterpolationError({.points = index.points()(Eigen::seqN(0, index.points().rows()), rows),
                          .alone = deviations(alone),
                          .surrounded = deviations(surrounded),
                          .gaps = gaps}));
  brdf.conventions += fmt::format(
      "; interpolated over theta_h (knee {}, scale {}), theta_d (knee {}){}, asinh(f / {} medians), radial functions "
      "r^{}; beyond the samples bounded by the nearest ones",
      choice.coordinates.half_knee, choice.coordinates.half_scale, choice.coordinates.difference_knee,
      samples.is_isotropic ? fmt::format(" and phi_d (scale {})", choice.coordinates.azimuth_scale)
                           : " and their azimuths",
      choice.medians, choice.scheme.exponent);
  add_remarks(brdf, samples, points, quality);
  brdf.at = [shared = std::make_shared<const ScatteredBrdf>(scattered)](std::span<const Directions> pairs) {
    return shared->at(pairs);
  };
  return quality;
}

}  // namespace lobe
