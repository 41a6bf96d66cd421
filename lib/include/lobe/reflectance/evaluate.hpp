#pragma once

#include <span>
#include <vector>

#include "lobe/core/directions.hpp"
#include "lobe/core/estimate.hpp"
#include "lobe/device/device.hpp"
#include "lobe/table/brdf_function.hpp"
#include "lobe/table/reflectance.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// Options for values.
struct EvaluateOptions {
  Precision precision = Precision::double_precision;  ///< arithmetic of the models
};

/// Evaluates f(L, V) in sr^-1 at pairs of directions, pairs x channels, without delta parts. Formulas give zero at and
/// below the horizon; functions give their own values; tables are interpolated, with the error of that (on grids of
/// cells the value of the cell is taken). The azimuth phi_in matters for anisotropic reflectances only.
/// \return values; for tables and interpolating functions also their errors, else none (0 x 0)
/// \throws ArgumentError for an angle outside its range (see Directions) and inconsistent tables; NumericError if a
///   formula's value is not finite; as adjusted(); DeviceError
[[nodiscard]] BrdfValues evaluate(const Device& device, const Reflectance& reflectance,
                                  std::span<const Directions> directions, const EvaluateOptions& options = {});

/// Pairs values with their errors, [channel][pair]; values without errors get 0.
[[nodiscard]] std::vector<std::vector<Estimate>> estimates(const BrdfValues& values);

}  // namespace lobe
