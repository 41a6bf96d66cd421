#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "formats/file_bytes.hpp"
#include "lobe/formats/measured.hpp"
#include "lobe/table/brdf_function.hpp"

namespace lobe {

/// Samples of a reflectance at any pairs of directions, theta in [0, pi/2], finite.
struct ScatteredSamples {
  std::vector<Directions> pairs;
  Eigen::MatrixXd values;  ///< sr^-1, pairs x channels
  bool is_isotropic = true;
  Eigen::MatrixXd deviations = {};  ///< standard deviations, as the values; 0 x 0: none are stated
};

/// Collects samples one by one.
class SampleCollector {
 public:
  explicit SampleCollector(std::size_t channels) : channels_(channels) {}

  /// Takes the memory of as many samples at once.
  void reserve(std::size_t samples);

  /// Polar angles a little beyond the horizon are taken to it.
  /// \param values one per channel
  void add(const Directions& pair, std::span<const double> values);
  [[nodiscard]] std::size_t size() const { return pairs_.size(); }
  [[nodiscard]] ScatteredSamples take(bool is_isotropic);

 private:
  std::size_t channels_;
  std::vector<Directions> pairs_;
  std::vector<double> values_;
};

/// \throws IoError where there are more values than LocalInterpolation takes
void require_room(const FileBytes& file, std::size_t samples, std::size_t channels);

/// How well samples are found from their neighbours: deviations relative to |f| plus a tenth of its median, over all
/// channels.
struct LeaveOneOut {
  double median = 0;
  double rms = 0;
};

/// Makes a function of samples: sets `at` and its symmetries, and adds how it is done and what was found wanting to
/// `conventions` and `remarks`.
///
/// Values y = asinh(f / s) are interpolated over PairCoordinates by LocalInterpolation, so that f is exactly
/// reciprocal, isotropic ones are bilateral, and f is that of the samples where they are. Samples closer than
/// 1e-5, or than a hundredth of the distance to the sixth one around, count as one, with their mean: noise would make
/// walls between them. s, the knees and scales of the coordinates, and the exponent are
/// those of a few that find left-out samples best. Between samples f passes the neighbours' values by at most a quarter
/// of their range in y and 0.3, and is not below 0 where they are not; so are values beyond the samples bounded.
///
/// The error follows from samples that are found from others, see InterpolationError. It is not larger than what the
/// samples around allow, and their margin of 0.3 in y.
/// Source: inverse distances blend local radial basis functions as in Franke and Nielson 1980.
/// Of samples with standard deviations there are as many replicates as options ask for and memory allows, on the
/// coordinates of the samples themselves.
/// \param options samples beyond its theta_max are left out
/// Of samples at fewer than 8 different pairs of directions the mean is taken, with a remark and without errors.
/// \throws IoError where there are fewer than 8 samples, or more values than LocalInterpolation takes
LeaveOneOut interpolate(const FileBytes& file, const ScatteredSamples& samples, const ReadOptions& options,
                        BrdfFunction& brdf);

}  // namespace lobe
