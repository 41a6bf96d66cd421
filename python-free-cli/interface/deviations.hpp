#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "interface/operand.hpp"
#include "interface/session.hpp"
#include "lobe/core/estimate.hpp"
#include "lobe/table/brdf_function.hpp"

namespace lobe::cli {

// Code shared by all commands that print, beside a numerical error, the effect of a file's standard deviations on
// a number (docs/error-estimates.md, "Measurement uncertainty").

/// A number with its numerical error and the standard deviation that those of samples cause; none where no file states
/// any.
struct Figure {
  Estimate estimate;
  std::optional<double> measurement = {};
};

/// "0.1275 ± 7e-05", and with a deviation "0.1275 ± 7e-05 (numerical) ± 0.0021 (measurement)".
[[nodiscard]] std::string format_figure(const Figure& figure);
/// {"value", "error"} and, with a deviation, "measurement".
[[nodiscard]] Json to_json(const Figure& figure);

/// Figures of estimates.
/// \param deviations one for each; empty: none are known
[[nodiscard]] std::vector<Figure> figures(std::span<const Estimate> estimates, std::span<const double> deviations);

/// Whether one of the operands is a file that states standard deviations.
[[nodiscard]] bool state_deviations(std::span<const Operand> operands);

/// The operands as functions with replicates, aligned; none where no file states standard deviations, and, with a
/// warning, where they cannot be followed: too many samples, or delta parts beside them. One text given twice is one
/// measurement.
[[nodiscard]] std::vector<BrdfFunction> replicated(Session& session, std::span<const Operand> operands);

/// Own channels of what replicated() returns.
[[nodiscard]] std::size_t own_channels(std::span<const BrdfFunction> functions);

}  // namespace lobe::cli
