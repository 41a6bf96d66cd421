#include "algebra/smooth_product.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "device/isotropic_product.hpp"
#include "device/multiply_matrices.hpp"

namespace lobe {

bool has_smooth_part(const BrdfTable& table, std::size_t channel) {
  return std::ranges::any_of(table.channel(channel), [](double value) { return value != 0; });
}

std::vector<double> inner_scale(const HemisphereGrid& grid, TableForm form) {
  std::vector<double> scale;
  if (form == TableForm::general) {
    for (const double weight : grid.weights()) scale.push_back(std::sqrt(weight));
    return scale;
  }
  for (const Ring& ring : grid.rings()) {
    scale.push_back(std::sqrt(ring.weight * static_cast<double>(ring.count) / (2 * std::numbers::pi)));
  }
  return scale;
}

void multiply_smooth(const Device& device, const BrdfTable& f, const BrdfTable& g, std::size_t channel,
                     std::span<double> c, Precision precision, const ProgressCallback& progress) {
  const std::size_t rows = f.rows();
  const auto scale = inner_scale(f.grid, f.form);
  const auto a = f.channel(channel);
  const auto b = g.channel(channel);
  if (f.form == TableForm::isotropic) {
    IsotropicProduct product(device, {rows, rows, rows, f.grid.n_phi()}, precision);
    product.multiply(a, b, scale, c, progress);
    return;
  }
  multiply(device, {a.data(), rows, rows, rows}, {b.data(), rows, rows, rows}, scale, {c.data(), rows, rows, rows},
           precision, progress);
}

std::uint64_t smooth_product_bytes(const Device& device, const BrdfTable& f, Precision precision) {
  const std::size_t rows = f.rows();
  if (f.form == TableForm::isotropic) {
    return isotropic_workspace_bytes(device, {rows, rows, rows, f.grid.n_phi()}, precision);
  }
  return multiply_workspace_bytes(device, rows, rows, rows, precision);
}

}  // namespace lobe
