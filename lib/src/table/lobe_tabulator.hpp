#pragma once

#include <span>
#include <vector>

#include "lobe/device/device.hpp"
#include "lobe/model/material.hpp"
#include "lobe/table/table.hpp"
#include "model/lobes.hpp"
#include "table/nodes.hpp"

namespace lobe {

/// Values of the lobes of one material at pairs of directions.
class LobeTabulator {
 public:
  /// \param material without delta parts; without terms its values are zero
  LobeTabulator(const Device& device, const Material& material, Precision precision);

  [[nodiscard]] const LobeSet& lobes() const { return lobes_; }
  /// f(L,V) = f(V,L) for all of its models.
  [[nodiscard]] bool is_reciprocal() const { return is_reciprocal_; }
  /// One azimuth of L is enough.
  [[nodiscard]] bool is_isotropic() const { return lobes_.aspect == 0; }

  /// values[row][column] of a channel.
  /// \param first_column see tabulate_pairs()
  void channel(std::size_t channel, const DirectionSet& rows, const DirectionSet& columns,
               std::span<const unsigned> first_column, std::span<double> values) const;
  /// values[row][column] of a single lobe with weight 1.
  void lobe(std::size_t lobe, const DirectionSet& rows, const DirectionSet& columns, std::span<double> values) const;

 private:
  [[nodiscard]] WeightedLobe place(std::size_t lobe, double weight) const;

  Device device_;
  Precision precision_;
  LobeSet lobes_;
  bool is_reciprocal_ = true;
};

}  // namespace lobe
