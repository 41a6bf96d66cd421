#include "io/scattered_brdf.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <utility>

#include "io/local_interpolation.hpp"
#include "io/pair_coordinates.hpp"

namespace lobe {
namespace {

constexpr std::size_t kFewest = 8;     // points
constexpr double kTogether = 1e-3;     // distance of samples that count as one
constexpr std::size_t kTried = 300;    // points that choices are compared by
constexpr std::size_t kJudged = 4000;  // points that errors are taken from

double quantile_of(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::ranges::nth_element(values, place);
  return *place;
}

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
  result.values = samples.values(kept, Eigen::all);
  if (kept.size() < samples.pairs.size()) {
    brdf.remarks.push_back(fmt::format("{} of {} samples are beyond the largest angle that counts, and are left out",
                                       samples.pairs.size() - kept.size(), samples.pairs.size()));
  }
  return result;
}

Points merged(const ScatteredSamples& samples) {
  const PointIndex index(PairCoordinates{.is_isotropic = samples.is_isotropic}.of(samples.pairs));
  std::vector<std::vector<std::size_t>> groups;
  std::vector<bool> is_taken(index.size(), false);
  for (std::size_t i = 0; i < index.size(); ++i) {
    if (is_taken[i]) continue;
    auto& group = groups.emplace_back();
    for (const auto& one : index.within(index.points().col(static_cast<Eigen::Index>(i)).data(), kTogether)) {
      if (!is_taken[one.index]) group.push_back(one.index);
      is_taken[one.index] = true;
    }
  }
  Points points;
  const auto count = static_cast<Eigen::Index>(groups.size());
  points.values = Eigen::MatrixXd::Zero(count, samples.values.cols());
  points.spread = Eigen::MatrixXd::Zero(count, samples.values.cols());
  for (Eigen::Index g = 0; g < count; ++g) {
    const auto& group = groups[static_cast<std::size_t>(g)];
    points.pairs.push_back(samples.pairs[group.front()]);
    Eigen::MatrixXd members(static_cast<Eigen::Index>(group.size()), samples.values.cols());
    for (Eigen::Index i = 0; i < members.rows(); ++i) {
      members.row(i) = samples.values.row(static_cast<Eigen::Index>(group[static_cast<std::size_t>(i)]));
    }
    points.values.row(g) = members.colwise().mean();
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

/// What is chosen by left-out samples.
struct Choice {
  PairCoordinates coordinates;
  LocalScheme scheme;
  double medians = 1;  ///< s of the compression, in medians of |f|
};

/// The distance of an arbitrary pair of directions, within the angles of the samples, from the nearest point.
double typical_distance(const PointIndex& index, const PairCoordinates& coordinates,
                        const std::vector<Directions>& pairs) {
  constexpr std::size_t kPairs = 500;
  constexpr double kTypical = 0.75;  // quantile; beyond it errors grow with the distance
  double most_in = 0;
  double most_out = 0;
  for (const Directions& pair : pairs) {
    most_in = std::max(most_in, pair.theta_in);
    most_out = std::max(most_out, pair.theta_out);
  }
  // Points of the additive recurrence by powers of the generalised golden ratio (Roberts 2018).
  constexpr std::array<double, 4> kSteps{0.8566748838545029, 0.733891856627126, 0.6287067210378087, 0.5385972572236101};
  std::array<double, 4> place{0.5, 0.5, 0.5, 0.5};
  std::vector<Directions> arbitrary;
  for (std::size_t i = 0; i < kPairs; ++i) {
    for (std::size_t d = 0; d < place.size(); ++d) place[d] = std::fmod(place[d] + kSteps[d], 1.0);
    arbitrary.push_back({std::asin(place[0] * std::sin(most_in)), std::asin(place[1] * std::sin(most_out)),
                         2 * std::numbers::pi * place[2], 2 * std::numbers::pi * place[3]});
  }
  const Eigen::MatrixXd at = coordinates.of(arbitrary);
  std::vector<double> distances;
  for (Eigen::Index i = 0; i < at.cols(); ++i) distances.push_back(index.nearest(at.col(i).data(), 1)[0].distance);
  return quantile_of(std::move(distances), kTypical);
}

/// Deviation of a value found from the one that is, relative to the latter where it is not small.
double relative_deviation(double found, double value, double median) {
  return std::abs(found - value) / (std::abs(value) + 0.1 * median);
}

class Chooser {
 public:
  Chooser(const Points& points, double median)
      : points_(points), tried_(some_of(points.pairs.size(), kTried)), median_(median) {}

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
    for (const double radius : {0.0, typical_distance(index, choice.coordinates, points_.pairs)}) {
      const Eigen::MatrixXd found = compression.back(left_out(index, values, choice.scheme, tried_, radius));
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
  std::vector<std::size_t> tried_;
  double median_;
};

/// Errors of y from samples that were left out.
class ErrorModel {
 public:
  /// \param alone squared deviations of y of points that are left out, points x channels
  /// \param surrounded the same with those around them left out too
  ErrorModel(Eigen::MatrixXd points, Eigen::MatrixXd alone, Eigen::MatrixXd surrounded, double typical_distance)
      : index_(std::move(points)),
        alone_(std::move(alone)),
        surrounded_(std::move(surrounded)),
        typical_distance_(typical_distance),
        anywhere_(surrounded_.cwiseSqrt().colwise().mean()) {
    calibrate();
  }

  /// \param distance from the nearest sample
  [[nodiscard]] Eigen::RowVectorXd at(const double* point, double distance) const {
    const auto near = index_.nearest(point, kNear);
    const double far = typical_distance_ > 0 ? distance / typical_distance_ : 0;
    const double share = std::min(1.0, far * far);
    const Eigen::RowVectorXd square = (1 - share) * mean(alone_, near) + share * mean(surrounded_, near);
    const double growth = std::clamp(far, 1.0, kMostGrowth);
    // Where the nearest samples agree, others need not.
    return factor_ * (growth * square.cwiseSqrt() + (growth - 1) * anywhere_);
  }

 private:
  static constexpr std::size_t kNear = 8;
  static constexpr double kMostGrowth = 10;
  static constexpr double kCoverage = 0.97;

  [[nodiscard]] static Eigen::RowVectorXd mean(const Eigen::MatrixXd& squares,
                                               std::span<const PointIndex::Neighbour> near) {
    Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(squares.cols());
    double weights = 0;
    const double soft = 0.5 * near.back().distance;
    for (const auto& one : near) {
      const double weight = soft > 0 ? soft / (soft + one.distance) : 1;
      sum += weight * squares.row(static_cast<Eigen::Index>(one.index)).cwiseSqrt();
      weights += weight;
    }
    return (sum / weights).cwiseAbs2();
  }

  /// How many times what the neighbours say covers the deviations of nearly all points.
  void calibrate() {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < index_.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      auto near = index_.nearest(index_.points().col(row).data(), kNear + 1);
      std::erase_if(near, [&](const auto& one) { return one.index == i; });
      for (const auto* squares : {&alone_, &surrounded_}) {
        const Eigen::RowVectorXd said = mean(*squares, near);
        for (Eigen::Index c = 0; c < said.size(); ++c) {
          if (said[c] > 0) ratios.push_back(std::sqrt((*squares)(row, c) / said[c]));
        }
      }
    }
    factor_ = std::max(1.0, quantile_of(std::move(ratios), kCoverage));
  }

  PointIndex index_;
  Eigen::MatrixXd alone_;
  Eigen::MatrixXd surrounded_;
  double typical_distance_;
  Eigen::RowVectorXd anywhere_;
  double factor_ = 1;
};

class ScatteredBrdf {
 public:
  ScatteredBrdf(PairCoordinates coordinates, Compression compression, LocalInterpolation interpolation,
                ErrorModel errors)
      : coordinates_(coordinates),
        compression_(std::move(compression)),
        interpolation_(std::move(interpolation)),
        errors_(std::move(errors)) {}

  [[nodiscard]] BrdfValues at(std::span<const Directions> pairs) const {
    const auto count = static_cast<Eigen::Index>(pairs.size());
    const Eigen::MatrixXd points = coordinates_.of(pairs);
    const Eigen::Index channels = interpolation_.channels();
    BrdfValues found{Eigen::MatrixXd(count, channels), Eigen::MatrixXd(count, channels)};
    for (Eigen::Index i = 0; i < count; ++i) {
      const double* point = points.col(i).data();
      const auto blend = interpolation_.blend(point);
      const Eigen::ArrayXd y = interpolation_.value(point, blend).transpose();
      // Others are as large as those near, but for a factor e.
      const Eigen::ArrayXd most = 1 + interpolation_.largest(blend).transpose().array() - y.abs();
      const Eigen::ArrayXd error = errors_.at(point, blend.front().distance).transpose().array().min(most);
      found.value.row(i) = (compression_.scale * y.sinh()).transpose();
      // The wider side of f(y +- error).
      found.error.row(i) = (compression_.scale * ((y.abs() + error).sinh() - y.abs().sinh())).transpose();
    }
    return found;
  }

 private:
  PairCoordinates coordinates_;
  Compression compression_;
  LocalInterpolation interpolation_;
  ErrorModel errors_;
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

/// Of samples at a few pairs of directions only.
LeaveOneOut take_mean(const Points& points, BrdfFunction& brdf) {
  brdf.conventions += "; the mean of its samples for all directions";
  brdf.remarks.push_back(fmt::format(
      "samples at {} different pairs of directions, too few to interpolate: their mean is taken, and its error "
      "is unknown",
      points.pairs.size()));
  const Eigen::RowVectorXd mean = points.values.colwise().mean();
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

ScatteredSamples SampleCollector::take(bool is_isotropic) {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Eigen::Map<const Rows> rows(values_.data(), static_cast<Eigen::Index>(pairs_.size()),
                                    static_cast<Eigen::Index>(channels_));
  return {std::move(pairs_), rows, is_isotropic};
}

LeaveOneOut interpolate(const FileBytes& file, const ScatteredSamples& all, const ReadOptions& options,
                        BrdfFunction& brdf) {
  const ScatteredSamples samples = within(all, options.theta_max, brdf);
  if (samples.pairs.size() < kFewest) {
    file.refuse_end(fmt::format("{} samples; expected at least {}", samples.pairs.size(), kFewest));
  }
  const Points points = merged(samples);
  brdf.is_isotropic = samples.is_isotropic;
  brdf.is_bilateral = samples.is_isotropic;
  if (points.pairs.size() < kFewest) return take_mean(points, brdf);
  const double median = median_size(points.values);
  const Choice choice = Chooser(points, median).best(samples.is_isotropic);
  const PointIndex index(choice.coordinates.of(points.pairs));
  const Compression compression{choice.medians * median};
  const Eigen::MatrixXd values = compression.of(points.values);
  const double distance = typical_distance(index, choice.coordinates, points.pairs);

  const auto judged = some_of(points.pairs.size(), kJudged);
  const Eigen::MatrixXd alone = left_out(index, values, choice.scheme, judged, 0);
  const Eigen::MatrixXd surrounded = left_out(index, values, choice.scheme, judged, distance);
  const std::vector<Eigen::Index> rows(judged.begin(), judged.end());
  const Eigen::MatrixXd there = values(rows, Eigen::all);
  // What samples at one place differ by, they may be off by.
  const Eigen::MatrixXd noise =
      (compression.of(points.values.cwiseAbs() + points.spread) - values.cwiseAbs())(rows, Eigen::all).cwiseAbs2();
  const LeaveOneOut quality = quality_of(compression.back(alone), points.values(rows, Eigen::all), median);
  const ScatteredBrdf scattered(choice.coordinates, compression, LocalInterpolation(index, values, choice.scheme),
                                ErrorModel(index.points()(Eigen::all, rows), (alone - there).cwiseAbs2() + noise,
                                           (surrounded - there).cwiseAbs2() + noise, distance));
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
