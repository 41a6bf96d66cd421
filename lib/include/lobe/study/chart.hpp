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
#include "lobe/model/material.hpp"
#include "lobe/plot/table_pictures.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// Quantities that the curves of a chart show for the first channel of materials.
enum class ChartQuantity {
  albedo,           ///< a(theta) over the angle of incidence
  mirror_radiance,  ///< f(L, R) cos(theta), sr^-1, over the angle of incidence: radiance in the mirror direction of a
                    ///< surface under a point light of irradiance 1 on a plane across it
  reflectance,      ///< f(L, V), sr^-1, over the angle of V in the plane of incidence, below 0 on the retro side
  radiance,         ///< f(L, V) cos(theta_in), sr^-1, over the angle of V
  mean_albedo       ///< A (1.20), over a parameter
};
/// Name of a quantity: "albedo", "mirror-radiance", "reflectance", "radiance" or "mean-albedo".
[[nodiscard]] std::string_view to_string(ChartQuantity quantity);
/// Reads the name of a quantity.
/// \throws ArgumentError for another name, with the nearest known one
[[nodiscard]] ChartQuantity parse_chart_quantity(std::string_view name);

/// Whether the abscissae of a quantity are angles.
[[nodiscard]] bool is_over_angle(ChartQuantity quantity);
/// Whether these angles belong to V, from -pi/2 to pi/2, rather than to L.
[[nodiscard]] bool is_over_viewer(ChartQuantity quantity);

/// A curve of a chart.
struct ChartCurve {
  std::string label;                ///< its name in the key
  std::vector<Material> materials;  ///< one; for mean albedos one per abscissa
  double theta_in = 0;              ///< angle of incidence, radians, if abscissae are angles of V
};

/// A chart: curves of one quantity for several materials in one picture.
struct Chart {
  std::string name;                                  ///< part of the names of its files
  std::string title;                                 ///< title above the picture
  ChartQuantity quantity = ChartQuantity::albedo;    ///< quantity shown
  std::string parameter;                             ///< for mean albedos: name of the swept parameter
  std::vector<double> x;                             ///< abscissae, ascending; angles in radians
  std::vector<ChartCurve> curves;                    ///< in the order of the key
  std::optional<Material> unit;                      ///< values are divided by its f(N, N)
  std::optional<double> tolerance;                   ///< for albedos, relative, if it differs from that of all charts
  bool log_x = false;                                ///< for angles of incidence: logarithmic in 90 degrees - theta
  bool log_y = false;                                ///< logarithmic axis of the values
  std::optional<std::pair<double, double>> y_range;  ///< range of the picture; none: all values up to 80 degrees
};

/// Default abscissae for angles, radians. For incidence: every degree up to 80, then ever denser up to 89.9 degrees, or
/// with `log_x` evenly in the logarithm of the elevation up to 89.9999 degrees. For V: every half degree between the
/// horizons.
[[nodiscard]] std::vector<double> default_abscissae(ChartQuantity quantity, bool log_x);

/// Estimates by curve and abscissa. The errors include those of adjustments (adjusted()).
using ChartValues = std::vector<std::vector<Estimate>>;

/// Computes the values of a chart.
/// \param tolerance relative tolerance of albedos
/// \param missed called for each albedo whose error stays above it
/// \throws as adjusted(), evaluate(), albedo() and mean_albedo(); ArgumentError for a curve with another number of
///   materials than its quantity needs
[[nodiscard]] ChartValues compute_chart(const Device& device, const Chart& chart, double tolerance = 1e-6,
                                        const ProgressCallback& progress = {},
                                        const MissedToleranceCallback& missed = {});

/// Draws values as computed by compute_chart(), needing only the curves' labels: DIRECTORY/STEM.png beside its gnuplot
/// script and data. Without gnuplot the picture is left out and `note` says so.
/// \throws IoError if a file exists and overwrite is false, or if it cannot be written; nothing half-written stays
PictureFiles write_chart_picture(const Chart& chart, const ChartValues& values, const std::filesystem::path& directory,
                                 const std::string& stem, bool overwrite = false);

}  // namespace lobe
