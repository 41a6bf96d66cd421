#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "lobe/core/progress.hpp"
#include "lobe/device/device.hpp"
#include "lobe/table/brdf_function.hpp"
#include "lobe/table/reflectance.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// Options for reading a list of pairs of directions and writing the values.
struct PairOptions {
  /// Whether angles are in radians if the columns' names do not say; otherwise they are in degrees.
  bool radians = false;
  bool overwrite = false;                             ///< replace a file that exists
  Precision precision = Precision::double_precision;  ///< arithmetic of the models
  /// The reflectance with replicates of its samples (ReadOptions::replicates), whose scatter gives standard deviations
  /// beside the values; empty: none.
  std::optional<BrdfFunction> replicated = std::nullopt;
  ProgressCallback progress = {};  ///< told of the progress; may cancel
};

/// Summary of a list that was read, and of the values written.
struct PairSummary {
  std::size_t pairs = 0;                ///< number of pairs
  std::vector<std::string> directions;  ///< columns with directions: "theta_in_deg", ...
  /// Columns with values, errors and standard deviations, sr^-1: "red", ..., "red_error", ..., "red_std", ...
  std::vector<std::string> values;
  /// Whether angles without a unit were read as degrees and could all be radians: none is above 2 pi.
  bool may_be_radians = false;
};

/// Evaluates a reflectance, as evaluate() does, at the pairs of directions in a file, one row for each, in blocks and
/// on all cores. The file is text or an NPY array. The columns are `theta_in, theta_out, delta_phi`, with `phi_in` or
/// without; `theta_in, phi_in, theta_out, phi_out`; or `x_in, y_in, z_in, x_out, y_out, z_out`, vectors of any length
/// with z along the normal. In text, names of columns identify them, in any order; `theta_in_rad` and `theta_in_deg`
/// give the unit, and columns with other names are ignored. Without names, 3, 4 or 6 columns are the first, the second
/// or the third of these sets. Values of formulas are those of evaluate() but for a few units in the last place.
/// \param output .csv: the directions, then a column for each channel and, where errors are known, for each of their
///   errors and, with options.replicated, of their standard deviations; .npy: these values, pairs x columns, without
///   the directions; .h5: datasets `directions`, `brdf`, `brdf_error` and `brdf_std`
/// \throws IoError that names the file and the line or row of an invalid pair: a direction below the horizon, a number
///   that is not finite, too few columns; ArgumentError for an output of another kind, and for columns in degrees
///   together with options.radians, and for options.replicated with other channels or without replicates; as
///   evaluate(); Cancelled
PairSummary evaluate_pairs(const Device& device, const Reflectance& reflectance, const std::filesystem::path& pairs,
                           const std::filesystem::path& output, const PairOptions& options = {});

/// Evaluates a reflectance at the pairs of directions in a file and appends the result to `text` as comma-separated
/// values.
/// \throws as the overload that writes a file
PairSummary evaluate_pairs(const Device& device, const Reflectance& reflectance, const std::filesystem::path& pairs,
                           std::string& text, const PairOptions& options = {});

}  // namespace lobe
