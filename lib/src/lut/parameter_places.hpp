#pragma once

#include <cstddef>
#include <string_view>

#include "lobe/table/reflectance.hpp"

namespace lobe {

/// Values that a parameter may take.
struct ParameterRange {
  double minimum;
  double maximum;  ///< both may be infinite
};

/// Range of a parameter of a formula, by its name ("alpha") or that of its model or factor and its own ("ggx.alpha").
/// \throws ArgumentError for a file or a table, where no term has such a parameter, or terms of different models or factors have
[[nodiscard]] ParameterRange parameter_range(const Reflectance& reflectance, std::string_view name);

/// The formula with another value for a parameter, wherever it stands.
/// \throws ArgumentError as parameter_range(), and for a value that the model does not take
[[nodiscard]] Reflectance with_parameter(const Reflectance& reflectance, std::string_view name, double value);

}  // namespace lobe
