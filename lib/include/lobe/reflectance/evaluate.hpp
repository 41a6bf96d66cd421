#pragma once

#include <span>
#include <vector>

#include "lobe/core/directions.hpp"
#include "lobe/core/estimate.hpp"
#include "lobe/device/device.hpp"
#include "lobe/table/brdf_function.hpp"
#include "lobe/table/reflectance.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// How values are computed.
struct EvaluateOptions {
  Precision precision = Precision::double_precision;  ///< of the models
};

/// f(L, V) in sr^-1 at pairs of directions, pairs x channels, without delta parts: by the formulas, zero at and below
/// the horizon; as a function has it; of a table by interpolation (on grids of cells that of the cell), with its error.
/// The azimuth phi_in counts for anisotropic reflectances only.
/// \return values; of tables and of functions that interpolate also their errors, else none (0 x 0)
/// \throws ArgumentError for an angle outside its range (see Directions) and inconsistent tables; NumericError for a
///   formula's value that is no finite number; as adjusted(); DeviceError.
[[nodiscard]] BrdfValues evaluate(const Device& device, const Reflectance& reflectance,
                                  std::span<const Directions> directions, const EvaluateOptions& options = {});

/// Values with their errors, [channel][pair]; values without errors have 0.
[[nodiscard]] std::vector<std::vector<Estimate>> estimates(const BrdfValues& values);

}  // namespace lobe
