#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "study/run/study_units.hpp"

namespace lobe {

/// Hands units out to takers that ask for one after the other, so that whoever is quick gets more. A taker stays with a
/// group of units as long as it has any; what cannot be cut comes first, and small units fill the gaps at the end.
class UnitDealer {
 public:
  /// \param is_known units that nobody has to compute
  UnitDealer(const std::vector<StudyUnit>& units, const std::function<bool(const StudyUnit&)>& is_known,
             std::size_t takers);

  /// Place of the next unit for a taker; none: there is nothing left that is worth its while.
  [[nodiscard]] std::optional<std::size_t> next(std::size_t taker);

 private:
  struct Group {
    std::vector<std::size_t> left;  ///< last one first
    std::size_t units = 0;          ///< of which it had so many
    double cost = 0;                ///< estimated, of those that are left
    double shared_cost = 0;         ///< of each taker
    std::size_t takers = 0;
  };
  /// The group that a taker turns to; null: none.
  [[nodiscard]] Group* choose();

  const std::vector<StudyUnit>& units_;
  std::vector<Group> groups_;
  std::vector<Group*> current_;  ///< of each taker
};

}  // namespace lobe
