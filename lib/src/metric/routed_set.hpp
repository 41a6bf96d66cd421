#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "lobe/metric/metric.hpp"
#include "metric/slab_store.hpp"

namespace lobe {

/// Reflectances that are measured under one lighting after the other: what a route needs of them is made once.
class RoutedSet {
 public:
  /// There may be none, of which nothing can be measured.
  RoutedSet(const Device& device, ReflectanceList reflectances, MetricOptions options);

  /// How measure() takes them.
  /// \throws as choose_route()
  [[nodiscard]] RouteChoice choice(const Lighting& lighting);
  /// A route for them, by tables on a grid that nobody asked for: on one as fine as they need.
  [[nodiscard]] RouteChoice refined(RouteChoice choice);
  /// \param slabs as of measure_formulas()
  /// \throws as measure()
  [[nodiscard]] MetricResult measure(const Lighting& lighting, const SlabStore* slabs = nullptr);
  /// How many slabs measure() refines independently of each other under a lighting; 0 where it cannot.
  /// \throws as choose_route()
  [[nodiscard]] std::size_t slabs(const Lighting& lighting);
  /// Refines the slabs that a store wants, which it is given to keep.
  /// \throws as measure()
  void refine_slabs(const Lighting& lighting, const SlabStore& slabs);

  [[nodiscard]] const Device& device() const { return device_; }
  /// With their adjustments done.
  [[nodiscard]] const std::vector<Reflectance>& reflectances() const { return reflectances_; }
  /// \throws ArgumentError where there is none
  void require_some() const;
  /// All of them as formulas, which they have to be.
  [[nodiscard]] std::span<const Material> formulas();
  /// All of them as functions. \throws as as_function()
  [[nodiscard]] std::span<const BrdfFunction> functions();
  /// All of them on a grid.
  /// \throws as tabulate() and resample(); Cancelled
  [[nodiscard]] std::span<const BrdfTable* const> tables(const HemisphereGrid& grid);

 private:
  [[nodiscard]] MetricResult by_route(const RouteChoice& choice, const Lighting& lighting, const SlabStore* slabs);
  /// Under point light, with delta parts: infinite norms and distances are infinity.
  [[nodiscard]] MetricResult with_deltas();

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
  std::vector<std::pair<HemisphereGrid, HemisphereGrid>> refined_;  ///< grids that were refined, and what they became
};

}  // namespace lobe
