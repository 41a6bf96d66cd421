#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "device/opencl.hpp"
#include "lobe/device/device.hpp"

namespace lobe {

/// How many constants a lobe has: c0, c1, ... of kernels/prelude.clh.
inline constexpr std::size_t kCoefficients = 16;

/// Numbers of a curve, a piecewise Chebyshev series (kernels/lobes/pumping.clh).
inline constexpr std::size_t kCurvePanels = 28;  ///< of them kCurveNormalPanels up to 60 degrees
inline constexpr std::size_t kCurveNormalPanels = 9;
inline constexpr std::size_t kCurveTerms = 12;
inline constexpr std::size_t kCurveNumbers = kCurvePanels * kCurveTerms;  ///< of the panels
inline constexpr std::size_t kPartNumbers = 2 + kCurveTerms;              ///< of each part that follows them
/// Numbers between panels and parts, where there are any: how many parts are before each panel, and in all.
inline constexpr std::size_t kPartCounts = kCurvePanels + 1;

/// Lobes as the device evaluates them.
struct LobeKernel {
  std::string model;  ///< file and function kernels/models/<model>.clh, or the function that `source` defines
  std::vector<std::string> factors = {};  ///< files kernels/factors/<factor>.clh, functions factor_<factor>
  std::string source = {};      ///< a formula, after kernels/lobes/formula.clh; empty for models that are files
  std::string pumping = {};     ///< function pumping_<pumping> of kernels/lobes/pumping.clh; empty: none
  std::size_t curves = 0;       ///< that it takes
  std::size_t curve_parts = 0;  ///< of each curve, parts of panels with a series of their own
  bool is_anisotropic = false;  ///< sees azimuths

  [[nodiscard]] auto operator<=>(const LobeKernel&) const = default;
};

/// Lobes of one kernel, with the coefficients of each.
struct LobeBatch {
  LobeKernel kernel;
  std::vector<std::array<double, kCoefficients>> coefficients;
  std::vector<std::vector<double>> curves = {};  ///< per lobe, kernel.curves in a row; empty without curves

  /// Numbers that describe a lobe to the device.
  [[nodiscard]] std::size_t numbers_per_lobe() const;
  /// Those of a lobe, coefficients first.
  [[nodiscard]] std::vector<double> numbers(std::size_t lobe) const;
};

/// Builds the program that launches lobes of a kernel from one of the files evaluate_lobes.cl, tabulate_pairs.cl,
/// weigh_directions.cl.
/// \param header what the launcher includes; empty: nothing
/// \throws ArgumentError with the first complaint of the compiler where the kernel has a source of its own, else
///   DeviceError
[[nodiscard]] cl::Program build_lobe_program(const Device& device, const LobeKernel& kernel, std::string_view launcher,
                                             Precision precision, std::string_view header = {});

}  // namespace lobe
