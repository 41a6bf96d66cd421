#pragma once

#include <array>
#include <span>
#include <string_view>

#include "lobe/core/directions.hpp"
#include "lobe/core/estimate.hpp"
#include "model/formula_tree.hpp"

namespace lobe {

/// Value of a formula at a pair of directions, computed on the host: what a kernel that was made of the formula is held
/// against. The error bounds what rounding may make of it, on the host and on a device with functions as accurate as
/// OpenCL asks for in double precision. It is NaN where nothing can be said: at a jump, at a comparison of numbers that
/// differ by no more than their rounding, and where an operation has no finite value.
/// \param parameters their values
[[nodiscard]] Estimate formula_value(const FormulaTree& tree, std::span<const double> parameters,
                                     const Directions& pair);

/// A function of formulas on the host, for numbers alone; its arguments in order, others are ignored.
using FormulaNumbers = std::array<double, 3>;
using HostFunctionOfNumbers = double (*)(const FormulaNumbers&);
[[nodiscard]] HostFunctionOfNumbers host_function(std::string_view name);

}  // namespace lobe
