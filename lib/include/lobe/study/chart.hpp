#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lobe/core/estimate.hpp"
#include "lobe/core/progress.hpp"
#include "lobe/core/tolerance.hpp"
#include "lobe/device/device.hpp"
#include "lobe/io/table_pictures.hpp"
#include "lobe/model/material.hpp"

namespace lobe {

/// What the curves of a chart show of the first channel of materials, and over what.
enum class ChartQuantity {
  albedo,           ///< a(theta) over the angle of incidence
  mirror_radiance,  ///< f(L, R) cos(theta), sr^-1, over the angle of incidence: radiance in the mirror direction of a
                    ///< surface under a point light of irradiance 1 on a plane across it
  reflectance,      ///< f(L, V), sr^-1, over the angle of V in the plane of incidence, below 0 on the retro side
  radiance,         ///< the same times cos(theta_in)
  mean_albedo       ///< (1.20), over a parameter
};
/// "albedo", "mirror-radiance", "reflectance", "radiance", "mean-albedo".
[[nodiscard]] std::string_view to_string(ChartQuantity quantity);
/// Reads such a name.
/// \throws ArgumentError for another name, with the nearest known one.
[[nodiscard]] ChartQuantity parse_chart_quantity(std::string_view name);

/// Whether abscissae are angles.
[[nodiscard]] bool is_over_angle(ChartQuantity quantity);
/// Whether these angles are of V, from -pi/2 to pi/2, rather than of L.
[[nodiscard]] bool is_over_viewer(ChartQuantity quantity);

/// A curve of a chart.
struct ChartCurve {
  std::string label;                ///< its name in the key
  std::vector<Material> materials;  ///< one; of mean albedos one per abscissa
  double theta_in = 0;              ///< where abscissae are angles of V, radians
};

/// Curves of one quantity of several materials in one picture.
struct Chart {
  std::string name;                                  ///< part of the names of its files
  std::string title;                                 ///< stands above the picture
  ChartQuantity quantity = ChartQuantity::albedo;    ///< what is drawn
  std::string parameter;                             ///< of mean albedos: name of what is swept
  std::vector<double> x;                             ///< abscissae, ascending; angles in radians
  std::vector<ChartCurve> curves;                    ///< in the order of the key
  std::optional<Material> unit;                      ///< values are divided by its f(N, N)
  std::optional<double> tolerance;                   ///< of albedos, relative, where it is not the one of all charts
  bool log_x = false;                                ///< of angles of incidence: logarithmic in 90 degrees - theta
  bool log_y = false;                                ///< logarithmic axis of the values
  std::optional<std::pair<double, double>> y_range;  ///< what the picture shows; none: all up to 80 degrees
};

/// Abscissae for angles, radians: of incidence every degree up to 80, then ever denser up to 89.9 degrees, with `log_x`
/// evenly in the logarithm of the elevation up to 89.9999 degrees; of V every half degree between the horizons.
[[nodiscard]] std::vector<double> default_abscissae(ChartQuantity quantity, bool log_x);

/// Estimates by curve and abscissa. What adjustments may be off by (prepare()) is part of the errors.
using ChartValues = std::vector<std::vector<Estimate>>;

/// Computes the values of a chart.
/// \param tolerance of albedos, relative
/// \param missed called for each albedo whose error stays above it
/// \throws as prepare(), evaluate(), albedo() and mean_albedo(); ArgumentError for a curve without as many materials as
///   its quantity asks for.
[[nodiscard]] ChartValues compute_chart(const Device& device, const Chart& chart, double tolerance = 1e-6,
                                        const ProgressCallback& progress = {},
                                        const MissedToleranceCallback& missed = {});

/// Draws values as those of compute_chart(), of which the curves' labels are enough: DIRECTORY/STEM.png beside its
/// gnuplot script and data. Without gnuplot the picture is left out and `note` says so.
/// \throws IoError when a file exists and overwrite is false, or cannot be written; nothing half-written stays.
PictureFiles write_chart_picture(const Chart& chart, const ChartValues& values, const std::filesystem::path& directory,
                                 const std::string& stem, bool overwrite = false);

}  // namespace lobe
