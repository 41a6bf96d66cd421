#include "lobe/table/least_value.hpp"

#include <cmath>
#include <limits>
#include <numbers>

namespace lobe {

PlacedValue least_value(const BrdfTable& table, std::size_t channel) {
  const auto values = table.channel(channel);
  const auto rings = table.grid.rings();
  const std::size_t rows = table.rows();
  const bool is_isotropic = table.form == TableForm::isotropic;
  const std::size_t half = is_isotropic ? table.grid.half_azimuths() : 1;
  const auto ring_of = [&](std::size_t row) { return is_isotropic ? row : table.grid.ring_of(row); };
  const auto error_at = [&](std::size_t at) {
    const std::size_t pair = at / half;
    return table.error[(channel * rings.size() + ring_of(pair / rows)) * rings.size() + ring_of(pair % rows)];
  };
  std::size_t least = 0;
  std::size_t certain = 0;  // where the upper end of the error bar is least
  double upper = std::numeric_limits<double>::infinity();
  for (std::size_t at = 0; at < values.size(); ++at) {
    if (values[at] < values[least]) least = at;
    if (!(values[at] + error_at(at) < upper)) continue;
    upper = values[at] + error_at(at);
    certain = at;
  }
  const std::size_t index = upper < 0 ? certain : least;
  const std::size_t pair = index / half;
  double delta_phi = 0;
  if (is_isotropic) {
    delta_phi = 2 * std::numbers::pi * static_cast<double>(index % half) / static_cast<double>(table.grid.n_phi());
  } else {
    const auto nodes = table.grid.directions();
    delta_phi = std::abs(std::remainder(nodes[pair % rows].phi - nodes[pair / rows].phi, 2 * std::numbers::pi));
  }
  return {{values[index], error_at(index)},
          {rings[ring_of(pair / rows)].theta, rings[ring_of(pair % rows)].theta, delta_phi}};
}

}  // namespace lobe
