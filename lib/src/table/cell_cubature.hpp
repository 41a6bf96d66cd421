#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "hemisphere/gauss.hpp"
#include "table/arc_cell.hpp"
#include "table/cell_average.hpp"

namespace lobe {

/// The coordinates of a pair of directions that boxes have limits in.
enum class PairCoordinates {
  rings,  ///< theta_in, theta_out, delta_phi
  cells   ///< theta_in, share of the cell's arc at theta_in; the same of out
};

/// A box of pairs of directions; of `rings` the first three coordinates count.
struct PairBox {
  std::array<double, 4> low{};
  std::array<double, 4> high{};
  std::size_t in = 0;  ///< of `cells`: nodes of the grid
  std::size_t out = 0;
};

/// An integral over a box, in the measure of its coordinates: sin(theta) cos(theta) d theta, d phi.
struct BoxIntegral {
  double value = 0;
  double moment = 0;  ///< of `rings`: of the distance of delta_phi from the box's lower limit
  double given = 0;   ///< of the function's own errors
  double error = 0;   ///< of the cubature
  double change = 0;  ///< share of what the last halving changed
};

/// Adaptive cubature over many boxes at once; see average_over_cells().
class CellCubature {
 public:
  /// \param nodes of the Gauss rules, per coordinate
  CellCubature(const AveragedFunction& function, const HemisphereGrid& grid, std::size_t channels,
               PairCoordinates coordinates, int nodes);

  /// Pairs that a box takes at least.
  [[nodiscard]] std::size_t least_pairs() const;

  /// [box][channel].
  /// \param budget pairs that may be looked at; what was is taken off
  [[nodiscard]] std::vector<BoxIntegral> integrate(std::span<const PairBox> boxes, std::size_t& budget,
                                                   const ProgressCallback& progress) const;

  /// Measure of a box.
  [[nodiscard]] double measure(const PairBox& box) const;

 private:
  /// A part of a target box that is integrated by one rule.
  struct Part {
    PairBox box;
    std::size_t target = 0;
    double variation = 0;  ///< how much the function changes in it, by which differences are shared out
  };
  /// Parts, and their integrals by part and channel.
  struct Parts {
    std::vector<Part> parts;
    std::vector<BoxIntegral> integrals;
  };

  [[nodiscard]] std::size_t dimensions() const { return coordinates_ == PairCoordinates::rings ? 3 : 4; }
  [[nodiscard]] bool is_polar(std::size_t axis) const {
    return coordinates_ == PairCoordinates::rings ? axis < 2 : axis % 2 == 0;
  }
  /// Measure of what lies between a box's limits along an axis; of `cells` with the arc.
  [[nodiscard]] double extent(const PairBox& box, std::size_t axis) const;
  /// Its derivative at a point of the axis.
  [[nodiscard]] double density(const PairBox& box, std::size_t axis, double x) const;
  /// The pair at a point of a box.
  [[nodiscard]] Directions pair_at(const PairBox& box, const std::array<double, 4>& x) const;
  /// Azimuths of one direction of a box of `cells`.
  [[nodiscard]] std::pair<double, double> azimuths(const PairBox& box, bool is_out) const;
  /// Largest lengths along the axes of a box on the ridge of a lobe, infinite off it.
  [[nodiscard]] std::array<double, 4> longest(const PairBox& box, double scale) const;
  /// A box cut up where ridges of lobes run through it.
  void cut(const PairBox& box, std::size_t target, double scale, std::vector<Part>& parts) const;
  [[nodiscard]] std::vector<Part> first_parts(std::span<const PairBox> boxes, std::size_t budget) const;
  /// All halves of a part: 8 or 16.
  void halve(const Part& part, std::vector<Part>& halves) const;
  void evaluate(std::span<const PairBox> targets, Parts& parts) const;
  void evaluate(std::span<const PairBox> targets, Parts& parts, std::size_t first, std::size_t count) const;
  /// Halves all of `parts` and sets the errors of the halves by what that changes.
  [[nodiscard]] Parts refine(std::span<const PairBox> targets, const Parts& parts,
                             std::span<const double> allowed) const;
  /// Errors that integrals over targets may have.
  [[nodiscard]] std::vector<double> allowed_errors(std::span<const BoxIntegral> sums,
                                                   std::span<const double> volumes) const;
  /// The parts that matter of targets that are off by more, of these the worst `most` ones.
  [[nodiscard]] std::vector<bool> chosen_parts(const Parts& active, std::span<const BoxIntegral> sums,
                                               std::span<const double> allowed, std::size_t most) const;
  void move(const Parts& from, std::size_t part, Parts& to) const;
  /// Adds a part to the sum of its target.
  void add(const Parts& from, std::size_t part, std::span<BoxIntegral> sums) const;

  const AveragedFunction& function_;
  std::size_t channels_;
  PairCoordinates coordinates_;
  GaussRule rule_;
  std::vector<ArcCell> cells_;  ///< of `cells`
};

}  // namespace lobe
