#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "interface/deviations.hpp"
#include "interface/operand.hpp"
#include "interface/operand_json.hpp"
#include "interface/session.hpp"
#include "lobe/formats/measurement.hpp"
#include "lobe/hemisphere/grid.hpp"
#include "lobe/metric/metric.hpp"
#include "lobe/metric/unit.hpp"

namespace lobe::cli {

// Code shared by the commands that measure materials: lightings, operands brought together, doubts.

/// --lighting, --domain-theta-max, --tolerance and the options for tables.
[[nodiscard]] std::vector<Option> measuring_options(bool takes_several_lightings);

/// --domain-theta-max, and its value: radians, else the whole hemisphere.
/// \throws ArgumentError for no angle above 0, at most 90 degrees
[[nodiscard]] Option domain_option();
[[nodiscard]] double domain_of(const Arguments& arguments);
/// The angle of a domain in degrees; none for the whole hemisphere.
[[nodiscard]] std::optional<double> domain_degrees(double theta_max);

/// Those of --lighting, else point.
/// \throws ArgumentError for an unknown one, or one given twice.
[[nodiscard]] std::vector<Lighting> lightings_of(const Arguments& arguments);

/// Operands measured under lightings.
struct Measurement {
  std::vector<MetricResult> results;  ///< one per lighting
  /// Standard deviations of the products, as caused by those of the samples, one per lighting; empty where no file
  /// states any.
  std::vector<MetricDeviations> deviations;
  std::optional<HemisphereGrid> grid;  ///< that tables were compared on; none: no tables
  MetricOptions options;
  DeviceInfo device;
};

/// Notes an operand that a grid does not resolve, and a grid that does.
void note_coarse(Session& session, const Operand& operand, const HemisphereGrid& grid, const Device& device);

/// Measures operands as the options say, by the route of choose_route(). Notes products that did not reach the
/// tolerance, and warns of tables that are not resolved.
/// \param allow_infinite as in MetricOptions
/// \throws as measure() and Session::note_missed().
[[nodiscard]] Measurement measured(Session& session, std::span<const Operand> operands,
                                   std::span<const Lighting> lightings, std::vector<double> channel_weights = {},
                                   bool allow_infinite = false);

/// Notes the products whose errors exceed the tolerance, relative to the norms of both factors.
void note_errors(Session& session, const MetricResult& result, std::span<const std::string> names);

/// Notes the products that did not reach the tolerance.
/// \throws as Session::note_missed().
void note_unresolved(Session& session, const MetricResult& result, std::span<const std::string> names);

/// Under an indefinite W squares of norms and distances may be negative.
/// \param what "norm of 'A'"
/// \throws NumericError with the square where the root is NaN
void require_root(const Estimate& root, std::string_view what, const Estimate& square, const Lighting& lighting);

/// "up to 80 degrees" where products have a domain short of the horizon, else empty.
[[nodiscard]] std::string domain_text(const Measurement& measurement);
/// The domain's angle and "grid" where there are such, "precision" and "device".
[[nodiscard]] Json circumstances_json(const Measurement& measurement);

/// A quantity of all channels together; of several channels, below it one line for each; and the domain, if any.
/// \param channels empty for a single channel
/// \param operands what it is a quantity of
[[nodiscard]] std::string channels_text(const Figure& combined, std::span<const Figure> channels,
                                        std::span<const Operand> operands, const Measurement& measurement);

}  // namespace lobe::cli
