#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "lobe/core/progress.hpp"
#include "lobe/device/device.hpp"
#include "lobe/table/reflectance.hpp"

namespace lobe {

/// How a list of pairs of directions is read and answered.
struct PairOptions {
  /// Angles are in radians where the columns' names do not say; otherwise in degrees.
  bool radians = false;
  bool overwrite = false;                             ///< replace a file that exists
  Precision precision = Precision::double_precision;  ///< of the models
  ProgressCallback progress = {};                     ///< told of the progress; may cancel
};

/// What was read and written.
struct PairSummary {
  std::size_t pairs = 0;                ///< how many there were
  std::vector<std::string> directions;  ///< columns that say the directions: "theta_in_deg", ...
  std::vector<std::string> values;      ///< columns of values and of errors, sr^-1: "red", ..., "red_error", ...
  /// Angles were read as degrees for want of a unit, and all of them could be radians: none is above 2 pi.
  bool may_be_radians = false;
};

/// Values of a reflectance, as evaluate() has them, at the pairs of directions of a file, a row for each, in blocks and
/// on all cores: of a file of text or an array in NPY. The columns are `theta_in, theta_out, delta_phi`, with `phi_in`
/// or without; `theta_in, phi_in, theta_out, phi_out`; or `x_in, y_in, z_in, x_out, y_out, z_out`, vectors of any
/// length with z along the normal. Names of a text's columns say which, in any order, `theta_in_rad` and `theta_in_deg`
/// with the unit; columns of other names are not read. Where there are no names 3, 4 or 6 columns are the first, the
/// second and the third of these.
/// \param output .csv: the directions, then a column for each channel and, where errors are known, for each of their
///   errors; .npy: these values, pairs x columns, without the directions; .h5: datasets `directions`, `brdf` and
///   `brdf_error`
/// \throws IoError that names the file and the line or row of a pair that is none: a direction below the horizon, what
///   is no finite number, too few columns; ArgumentError for an output of another kind, and for columns in degrees
///   beside options.radians; as evaluate(); Cancelled.
PairSummary evaluate_pairs(const Device& device, const Reflectance& reflectance, const std::filesystem::path& pairs,
                           const std::filesystem::path& output, const PairOptions& options = {});

/// The same as text of comma-separated values, which is added to.
/// \throws as the other
PairSummary evaluate_pairs(const Device& device, const Reflectance& reflectance, const std::filesystem::path& pairs,
                           std::string& text, const PairOptions& options = {});

}  // namespace lobe
