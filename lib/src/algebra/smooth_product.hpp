#pragma once

#include <cstdint>
#include <span>

#include "lobe/core/progress.hpp"
#include "lobe/device/device.hpp"
#include "lobe/table/table.hpp"

namespace lobe {

/// The product of the smooth parts of one channel, f diag(weights) g, of tables of one grid and form.
/// \param c values of a channel, overwritten
void multiply_smooth(const Device& device, const BrdfTable& f, const BrdfTable& g, std::size_t channel,
                     std::span<double> c, Precision precision, const ProgressCallback& progress);

/// Bytes of device memory that it takes beside the tables.
[[nodiscard]] std::uint64_t smooth_product_bytes(const Device& device, const BrdfTable& f, Precision precision);

/// Whether any value of a channel differs from zero.
[[nodiscard]] bool has_smooth_part(const BrdfTable& table, std::size_t channel);

/// Square roots of the weights that inner nodes (general) or rings (isotropic, per radian of azimuth) are summed with.
[[nodiscard]] std::vector<double> inner_scale(const HemisphereGrid& grid, TableForm form);

}  // namespace lobe
