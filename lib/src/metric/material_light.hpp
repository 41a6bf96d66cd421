#pragma once

#include <optional>
#include <span>
#include <vector>

#include "lobe/device/device.hpp"
#include "lobe/hemisphere/grid.hpp"
#include "lobe/metric/lighting.hpp"
#include "lobe/metric/metric.hpp"
#include "lobe/table/reflectance.hpp"
#include "lobe/table/table.hpp"

namespace lobe {

/// How materials are lit, beside the grid.
struct MaterialLightOptions {
  Precision precision = Precision::double_precision;
  double tolerance = 1e-5;      ///< of compositions, as in ComposeOptions
  std::size_t cell_points = 4;  ///< as in TabulateOptions
  ProgressCallback progress = {};
};

/// Light of the pattern of a reflectance eta (Lighting::material()) on a grid: makes C_{eta,f} of f, whose point
/// products are (5.23). Where both are formulas, or functions that have values anywhere, these are composed at the
/// nodes, which need not resolve them; else tables are multiplied.
class MaterialLight {
 public:
  /// \throws as adjusted() and tabulate()
  MaterialLight(const Device& device, const Lighting& lighting, const HemisphereGrid& grid,
                MaterialLightOptions options = {});

  /// C_{eta,f} with its errors.
  /// \param f prepared
  /// \throws as compose()
  [[nodiscard]] BrdfTable lit(const Reflectance& f) const;
  /// \param f on the grid
  [[nodiscard]] BrdfTable lit(const BrdfTable& f) const;

 private:
  [[nodiscard]] const BrdfTable& eta_table() const;

  Device device_;
  HemisphereGrid grid_;
  MaterialLightOptions options_;
  Reflectance eta_;
  mutable std::optional<BrdfTable> table_;
};

/// measure() under light of the pattern of a reflectance, on the grid of `choice` where that is given or belongs to one
/// of the reflectances, else on grids as fine as the products ask for.
/// \param reflectances prepared
/// \throws NumericError naming a reflectance that has no norm under such light; as measure()
[[nodiscard]] MetricResult measure_lit(const Device& device, std::span<const Reflectance> reflectances,
                                       const Lighting& lighting, const RouteChoice& choice,
                                       const MetricOptions& options);

}  // namespace lobe
