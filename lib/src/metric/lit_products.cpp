// Products of tables under lightings that are operators: tr(T_f T_g* W).
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "core/text.hpp"
#include "lobe/algebra/algebra.hpp"
#include "lobe/core/error.hpp"
#include "metric/domain.hpp"
#include "metric/lighting_traits.hpp"
#include "metric/table_lighting.hpp"
#include "metric/table_metric.hpp"
#include "metric/table_products.hpp"

namespace lobe {
namespace {

std::vector<Estimate> mean_albedo_products(const BrdfTable& f, const BrdfTable& g) {
  const auto a = row_albedos(f).mean;
  const auto b = row_albedos(g).mean;
  if (a.size() != b.size()) {
    throw ArgumentError("tables with " + std::to_string(a.size()) + " and " + std::to_string(b.size()) +
                        " channels; expected the same number");
  }
  constexpr double kSquaredPi = std::numbers::pi * std::numbers::pi;
  std::vector<Estimate> products;
  for (std::size_t c = 0; c < a.size(); ++c) {
    products.push_back({kSquaredPi * a[c].value * b[c].value,
                        kSquaredPi * (a[c].error * std::abs(b[c].value) + std::abs(a[c].value) * b[c].error +
                                      a[c].error * b[c].error)});
  }
  return products;
}

}  // namespace

TableLight::TableLight(const Device& device, const Lighting& lighting, const HemisphereGrid& grid, double theta_max)
    : device_(device), lighting_(lighting), theta_max_(theta_max), has_domain_(cos_of_domain(theta_max, lighting) > 0) {
  if (traits_of(lighting).has_operator) operator_ = lighting_table(device, lighting, grid);
}

std::vector<Estimate> TableLight::products(const BrdfTable& f, const BrdfTable& g) const {
  if (has_domain_) return channel_products_up_to(theta_max_, f, g, lighting_);
  if (traits_of(lighting_).is_of_means) return mean_albedo_products(f, g);
  if (!operator_) return channel_products(f, g, lighting_);
  if (!(f.grid == g.grid)) {
    throw ArgumentError("tables on grids " + f.grid.name() + " and " + g.grid.name() + "; expected the same grid");
  }
  // tr(T_f T_g* W) = <W T_f, T_g> as an integral over both directions, for W = W*.
  const BrdfTable lit = compose(device_, *operator_, f);
  return lit.form == g.form ? channel_products(lit, g, Lighting::point())
                            : channel_products(to_general(lit), to_general(g), Lighting::point());
}

std::vector<Estimate> TableLight::squared_distances(const BrdfTable& f, const BrdfTable& g) const {
  if (!operator_ && !has_domain_ && !traits_of(lighting_).is_of_means) {
    return squared_channel_distances(f, g, lighting_);
  }
  const BrdfTable between = difference(f, g);
  return products(between, between);
}

Estimate scalar_product(const Device& device, const BrdfTable& f, const BrdfTable& g, const Lighting& lighting) {
  return mean(TableLight(device, lighting, f.grid).products(f, g));
}

Estimate distance(const Device& device, const BrdfTable& f, const BrdfTable& g, const Lighting& lighting) {
  const Estimate square = mean(TableLight(device, lighting, f.grid).squared_distances(f, g));
  if (square.value < -square.error) {
    throw NumericError("the squared distance of '" + f.expression + "' and '" + g.expression + "' under lighting '" +
                       lighting.name() + "' is " + shortest(square.value) +
                       "; expected a positive semi-definite W for distances");
  }
  return square_root(square);
}

}  // namespace lobe
