#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <memory>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "lobe/directions.hpp"
#include "lobe/table.hpp"

namespace lobe {

/// What a file says of the reflectance that it holds.
struct MeasuredInfo {
  std::string name;                   ///< stem of the file
  std::string format;                 ///< "NBRDF neural encoding", ...
  std::string conventions;            ///< of the format: units, directions, colour scale, and how it is read
  std::vector<std::string> channels;  ///< "red", "532 nm", ...
};

/// An isotropic reflectance that is no model: values in sr^-1, without a cosine, at any pair of directions.
class MeasuredBrdf {
 public:
  explicit MeasuredBrdf(MeasuredInfo info) : info_(std::move(info)) {}
  MeasuredBrdf(const MeasuredBrdf&) = delete;
  MeasuredBrdf& operator=(const MeasuredBrdf&) = delete;
  virtual ~MeasuredBrdf() = default;

  [[nodiscard]] const MeasuredInfo& info() const { return info_; }
  /// Pairs x channels; theta in [0, pi/2). May be called from several threads.
  [[nodiscard]] virtual Eigen::MatrixXd evaluate(std::span<const Directions> pairs) const = 0;

 private:
  MeasuredInfo info_;
};

struct MeasuredOptions {
  /// Channels of spectra that are functions of the wavelength, nm; empty: those of the file.
  std::vector<double> wavelengths = {};
  /// Angle from the normal, radians, up to which the file counts, of both directions; beyond, values are those there.
  /// Goniometers end at 75 to 85 degrees, and expansions fitted to them may be anything at the horizon.
  double theta_max = std::numbers::pi / 2;
};

/// Reads a reflectance; the format is recognised by content (docs/file-formats.md).
/// \throws IoError "cannot read FILE: ..." for files of no known format and damaged ones; ArgumentError for wavelengths
///   that the file does not have, for none where it needs them, and for a theta_max outside (0, pi/2].
[[nodiscard]] std::unique_ptr<MeasuredBrdf> load_measured(const std::filesystem::path& path,
                                                          const MeasuredOptions& options = {});

/// Tabulates a measured reflectance. On product grids the table is isotropic and takes the mean of both signs of
/// delta_phi; half their difference counts as error of its values, beside rounding. What the measurement itself is
/// worth nobody knows. Not made symmetric in L and V: measured data is not reciprocal, see symmetrise().
/// resolution_error compares the integrals of f^2 with those of the refined grid. \throws NumericError where the grid
/// does not resolve it, unless options.allow_unresolved; Cancelled.
[[nodiscard]] BrdfTable tabulate(const MeasuredBrdf& brdf, const HemisphereGrid& grid,
                                 const TabulateOptions& options = {});

}  // namespace lobe
