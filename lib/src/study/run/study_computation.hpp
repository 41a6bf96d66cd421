#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "compare/comparison_tiles.hpp"
#include "lobe/compare/literature_metric.hpp"
#include "lobe/core/progress.hpp"
#include "lobe/device/device.hpp"
#include "lobe/study/study.hpp"
#include "metric/routed_set.hpp"
#include "study/run/study_operands.hpp"
#include "study/run/study_units.hpp"
#include "study/run/unit_records.hpp"

namespace lobe {

/// Records of units by their names (checkpoint_records.hpp, unit_records.hpp): those that are known, and a place for
/// new ones.
struct UnitStore {
  std::function<bool(const std::string& name)> has;
  std::function<std::string(const std::string& name)> get;  ///< content of a record that is there
  /// Whether a record of this name would be kept; content is only written for those.
  std::function<bool(const std::string& name, double seconds)> is_worth_keeping;
  std::function<void(const std::string& name, const std::string& content)> keep;

  /// Knows nothing, and keeps nothing.
  [[nodiscard]] static UnitStore none();
};

/// Place of the unit to compute next among all units, asked when the one before is done; none: there is no more. Slabs
/// of a lighting are best in their order.
using UnitSource = std::function<std::optional<std::size_t>()>;

/// The parts of a study, each taken from the records or computed.
class StudyComputation {
 public:
  /// Prepares materials and reads files.
  /// \throws as run_study()
  StudyComputation(const Device& device, const Study& study, UnitStore store, ProgressCallback progress);

  /// The study as computed: channels named, materials prepared.
  [[nodiscard]] const Study& study() const { return study_; }
  [[nodiscard]] const StudyOperands& operands() const { return operands_; }
  /// Preparation and reading, as far as there was any.
  [[nodiscard]] const std::vector<StageTime>& stages() const { return stages_; }

  // \throws as run_study(), all of these
  [[nodiscard]] MetricResult lighting(std::size_t index);
  [[nodiscard]] LiteratureResult comparison(std::size_t index);
  [[nodiscard]] MaterialCurves curves(std::size_t material) const;
  [[nodiscard]] PublishedCheck figure(std::size_t index) const;
  [[nodiscard]] ChartCurveValues chart_curve(std::size_t chart, std::size_t curve) const;

  [[nodiscard]] std::vector<StudyUnit> units() { return study_units(study_, set_); }
  /// Computes units of which there is no record, as long as there are more, and keeps them.
  /// \param units units()
  void compute(const std::vector<StudyUnit>& units, const UnitSource& next);

 private:
  /// \return the unit that comes after those slabs
  [[nodiscard]] std::optional<std::size_t> compute_slabs(const std::vector<StudyUnit>& units, std::size_t first,
                                                         const UnitSource& next);
  template <typename Value, typename Compute>
  [[nodiscard]] Value taken(const std::string& name, Value value, const Compute& compute) const;
  [[nodiscard]] TileStore tiles_of(LiteratureMetric comparison) const;
  void compute_tile(std::size_t index, std::size_t tile);
  [[nodiscard]] SlabStore slabs_of(const Lighting& lighting, std::function<bool(std::size_t)> is_wanted) const;
  void report(std::string_view stage, std::size_t done, std::size_t all) const;

  const Device& device_;
  UnitStore store_;
  ProgressCallback progress_;
  std::vector<StageTime> stages_;  // filled while what follows is made
  Study study_;
  StudyOperands operands_;
  MetricOptions options_;
  LiteratureOptions comparison_options_;
  RoutedSet set_;
  std::vector<ComparisonTile> tiles_;
};

}  // namespace lobe
