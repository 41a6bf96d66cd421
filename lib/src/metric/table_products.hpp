#pragma once

#include <numbers>
#include <optional>
#include <vector>

#include "lobe/core/estimate.hpp"
#include "lobe/device/device.hpp"
#include "lobe/hemisphere/grid.hpp"
#include "lobe/metric/lighting.hpp"
#include "lobe/table/table.hpp"

namespace lobe {

/// f . g of each channel, under point light and daylight.
/// \throws as scalar_product() of tables.
[[nodiscard]] std::vector<Estimate> channel_products(const BrdfTable& f, const BrdfTable& g, const Lighting& lighting);

/// Products up to a largest angle (TableMetricOptions::theta_max), also of mean albedos.
/// \throws ArgumentError, besides, where the angle is within a ring of cells.
[[nodiscard]] std::vector<Estimate> channel_products_up_to(double theta_max, const BrdfTable& f, const BrdfTable& g,
                                                           const Lighting& lighting);

/// f - g with the errors of both.
/// \throws ArgumentError for different grids or numbers of channels.
[[nodiscard]] BrdfTable difference(const BrdfTable& f, const BrdfTable& g);

/// |f - g|^2 of each channel, integrated as such.
/// \throws as scalar_product() of tables.
[[nodiscard]] std::vector<Estimate> squared_channel_distances(const BrdfTable& f, const BrdfTable& g,
                                                              const Lighting& lighting);

/// Products of tables on one grid under any lighting.
class TableLight {
 public:
  /// \param theta_max the domain, see TableMetricOptions.
  /// \throws as lighting_table(), and for the domain
  TableLight(const Device& device, const Lighting& lighting, const HemisphereGrid& grid,
             double theta_max = std::numbers::pi / 2);

  /// Works on the host alone, on several threads at once.
  [[nodiscard]] bool is_host_only() const { return !operator_; }
  /// Looks the same from all sides, and in a mirror.
  [[nodiscard]] bool is_isotropic() const { return !operator_ || operator_->form == TableForm::isotropic; }

  /// f . g of each channel.
  /// \throws as scalar_product() of tables.
  [[nodiscard]] std::vector<Estimate> products(const BrdfTable& f, const BrdfTable& g) const;
  /// |f - g|^2 of each channel, integrated as such; negative ones under an indefinite W.
  /// \throws as products().
  [[nodiscard]] std::vector<Estimate> squared_distances(const BrdfTable& f, const BrdfTable& g) const;

 private:
  Device device_;
  Lighting lighting_;
  double theta_max_;
  bool has_domain_;
  std::optional<BrdfTable> operator_;  ///< W, where the lighting takes one
};

/// With equal weights that sum to 1.
[[nodiscard]] Estimate mean(const std::vector<Estimate>& channels);

}  // namespace lobe
