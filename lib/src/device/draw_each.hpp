#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "device/draw_directions.hpp"
#include "device/opencl.hpp"
#include "device/proposal_rows.hpp"
#include "lobe/device/device.hpp"

namespace lobe {

/// Directions to draw, each for a direction L and from a density of its own.
class DrawOrders {
 public:
  /// Adds a density to draw from.
  /// \param parts at least one
  /// \return its index
  std::size_t add_density(std::span<const ProposalPart> parts);
  /// Adds a direction to draw.
  /// \param density index of its density
  /// \param number of the sample, on which its random numbers depend
  void add(const UnitVector& light, std::size_t density, std::uint64_t number);
  /// Forgets all of them.
  void clear();
  /// Number of directions to draw.
  [[nodiscard]] std::size_t size() const { return numbers_.size(); }

 private:
  friend class EachDrawer;

  std::vector<UnitVector> lights_;
  ProposalRows rows_;
  std::vector<std::uint32_t> ends_;  ///< of the parts of each density
  std::vector<std::uint32_t> densities_;
  std::vector<std::uint64_t> numbers_;
};

/// A direction that was drawn.
struct DrawnDirection {
  UnitVector direction;  ///< V; (0, 0, 0) where there is none
  double density;        ///< sr^-1; of delta parts minus their probability, 0 of what is lost
  std::size_t part;      ///< number of the part that drew it, among those of its density
};

/// Draws a direction for each of many directions (kernels/sampling/draw_each.cl). A sample of some number is the one
/// that DirectionSampler draws.
class EachDrawer {
 public:
  /// \throws DeviceError
  explicit EachDrawer(const Device& device);

  /// \throws DeviceError
  [[nodiscard]] std::vector<DrawnDirection> draw(const DrawOrders& orders, std::uint64_t seed);

 private:
  Device device_;
  cl::Kernel kernel_;
};

}  // namespace lobe
