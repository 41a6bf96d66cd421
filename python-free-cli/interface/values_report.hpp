#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "interface/report.hpp"
#include "lobe/core/directions.hpp"
#include "lobe/core/estimate.hpp"

namespace lobe::cli {

/// Converts directions to radians.
[[nodiscard]] std::vector<Directions> to_radians(std::span<const Directions> degrees);

/// Reflectances in sr^-1 at pairs of directions as a table of text, a row per pair.
/// \param values of pair and channel
/// \param names of the channels; none: they are numbered
[[nodiscard]] std::string values_text(std::span<const Directions> degrees, const Eigen::MatrixXd& values,
                                      const std::vector<std::string>& names, bool color);
/// \param values [channel][pair]
/// \param deviations of the values, as these are ordered, by standard deviations of samples; empty: none are known
[[nodiscard]] std::string values_text(std::span<const Directions> degrees,
                                      const std::vector<std::vector<Estimate>>& values,
                                      const std::vector<std::string>& names, bool color,
                                      const std::vector<std::vector<double>>& deviations = {});

/// [{"theta_in_deg", "theta_out_deg", "delta_phi_deg", "brdf": [...]}], with a value for each channel.
[[nodiscard]] Json values_json(std::span<const Directions> degrees, const Eigen::MatrixXd& values);
/// Values as JSON with "brdf_error": [...] and, if there are deviations, "brdf_measurement": [...].
[[nodiscard]] Json values_json(std::span<const Directions> degrees, const std::vector<std::vector<Estimate>>& values,
                               const std::vector<std::vector<double>>& deviations = {});

}  // namespace lobe::cli
