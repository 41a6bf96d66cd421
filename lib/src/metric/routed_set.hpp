#pragma once

#include <optional>
#include <span>
#include <vector>

#include "lobe/metric/comparison.hpp"
#include "lobe/metric/metric.hpp"

namespace lobe {

/// Reflectances that are measured under one lighting after the other: what a route needs of them is made once.
class RoutedSet {
 public:
  /// There may be none, of which nothing can be measured.
  RoutedSet(const Device& device, ReflectanceList reflectances, MetricOptions options);

  /// How measure() takes them.
  /// \throws as choose_route()
  [[nodiscard]] RouteChoice choice(const Lighting& lighting) const {
    return choose_route(reflectances_, lighting, options_);
  }
  /// \throws as measure()
  [[nodiscard]] MetricResult measure(const Lighting& lighting);
  /// The route is that of `options`, whatever the set's own are.
  /// \throws as compare()
  [[nodiscard]] ComparisonResult compare(Comparison comparison, const ComparisonOptions& options);

  /// All of them as functions.
  /// \throws as as_function()
  [[nodiscard]] std::span<const BrdfFunction> functions();
  /// All of them on a grid.
  /// \throws as tabulate() and resample(); Cancelled
  [[nodiscard]] std::span<const BrdfTable* const> tables(const HemisphereGrid& grid);

 private:
  void require_some() const;
  [[nodiscard]] std::span<const Material> formulas();
  [[nodiscard]] MetricResult by_route(const RouteChoice& choice, const Lighting& lighting);

  const Device& device_;
  std::vector<Reflectance> reflectances_;  // formulas are prepared
  MetricOptions options_;
  std::vector<Material> formulas_;
  std::vector<BrdfFunction> functions_;
  /// Tables on one grid.
  struct GridTables {
    HemisphereGrid grid;
    std::vector<BrdfTable> made;           ///< those that are not tables on this grid anyway
    std::vector<const BrdfTable*> tables;  ///< all of them
  };
  std::optional<GridTables> grid_tables_;
};

}  // namespace lobe
