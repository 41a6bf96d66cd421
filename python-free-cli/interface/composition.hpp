#pragma once

#include <span>

#include "interface/operand.hpp"
#include "interface/session.hpp"
#include "lobe/device/device.hpp"
#include "lobe/table/table.hpp"

namespace lobe::cli {

/// Composes two operands, or one with itself.
///
/// The grid is that of --grid, else that of the first table. For materials alone it is gauss:64x128, or finer where
/// they need it; with --tolerance it is refined until the relative error is below that.
/// \param times of one operand: how often it is composed with itself
/// \throws NumericError when no grid reaches the tolerance; as compose().
[[nodiscard]] BrdfTable composition(Session& session, const Device& device, std::span<const Operand> operands,
                                    unsigned times = 1);

/// Options of the commands that compose: --tolerance, --exact-grid and those of table_command_options().
[[nodiscard]] std::vector<Option> composition_options(std::vector<Option> own, bool needs_output);

}  // namespace lobe::cli
