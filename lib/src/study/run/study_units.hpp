#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "lobe/compare/literature_metric.hpp"
#include "metric/routed_set.hpp"
#include "study/run/study_operands.hpp"

namespace lobe {

/// A part of a study that is computed by itself: it has the same bits whoever computes it, and with whatever others.
struct StudyUnit {
  enum class Kind {
    lighting,    ///< all products under a lighting
    slab,        ///< products over a slab of the quadrature under a lighting
    comparison,  ///< all distances by a metric of the literature
    tile,        ///< distances in a tile of all pairs, likewise
    curves,      ///< curves of a material
    figure,      ///< a printed figure
    chart_curve  ///< a curve of a chart
  };
  Kind kind = Kind::lighting;
  std::size_t index = 0;   ///< of the lighting, metric, material, figure or chart in the study
  std::size_t part = 0;    ///< slab of the lighting, tile of the metric, or curve of the chart
  std::string name = {};   ///< of its record
  double cost = 0;         ///< estimated, in seconds of some machine
  double shared_cost = 0;  ///< what each shard spends once that has any unit of its group
  std::size_t group = 0;   ///< units of one group are best computed together
};

[[nodiscard]] std::string slab_name(const Lighting& lighting, std::size_t slab);
[[nodiscard]] std::string tile_name(LiteratureMetric comparison, std::size_t tile);
[[nodiscard]] std::string curves_name(std::size_t material);
[[nodiscard]] std::string figure_name(std::size_t figure);
[[nodiscard]] std::string chart_curve_name(std::size_t chart, std::size_t curve);

/// Options for the metrics of the literature of a study.
[[nodiscard]] LiteratureOptions literature_options(const Study& study);

/// Units of a study, in the order of a run.
/// \throws as choose_route()
[[nodiscard]] std::vector<StudyUnit> study_units(const Study& study, RoutedSet& set);

/// Deals units to shards, by estimated cost: large ones first, each to the shard with the least so far; groups of many
/// are cut into runs. The same units are always dealt in the same way.
/// \return shard of each unit, from 0 on
[[nodiscard]] std::vector<std::size_t> dealt_units(const std::vector<StudyUnit>& units, std::size_t shards);

}  // namespace lobe
