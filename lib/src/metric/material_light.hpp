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

/// Whether reflectances are composed with that of a lighting at the nodes of a product grid, whatever it resolves.
[[nodiscard]] bool are_lit_by_values(const Reflectance& eta, std::span<const Reflectance> reflectances);

/// \throws NumericError naming a reflectance, or that of the lighting, which has no norm under such light
/// \param reflectances prepared
void require_lit_norms(const Lighting& lighting, const Reflectance& eta, std::span<const Reflectance> reflectances);

}  // namespace lobe
