#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lobe/core/directions.hpp"
#include "lobe/table/table.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// Reflectances in sr^-1, without a cosine; pairs of directions x channels.
struct BrdfValues {
  Eigen::MatrixXd value;  ///< pairs x channels
  Eigen::MatrixXd error;  ///< of interpolation, NaN where unknown; 0 x 0: the values are those that the source defines
};

/// An isotropic reflectance that is constant while L is within a ring and V, turned along with L, within a cell of
/// Shirley and Chiu's square: its integrals are sums.
struct RingCells {
  std::size_t rings = 0;       ///< of L, of equal width in sin(theta_in)
  std::size_t side = 0;        ///< cells of V along each axis of the square, of equal projected solid angle
  std::vector<double> values;  ///< sr^-1, [channel][ring][cell], from the normal outwards
};

/// A reflectance as a function of pairs of directions, wherever it comes from: a file, a table or a material. Delta
/// parts are in its `cells` alone.
struct BrdfFunction {
  std::string name;                   ///< "pink-felt"
  std::string format;                 ///< of the file: "NBRDF neural encoding"; empty where there is no file
  std::string conventions;            ///< of the file: units, directions, colour scale, and how it is read
  std::vector<std::string> channels;  ///< names: "red", "532 nm"
  std::vector<double> wavelengths;    ///< nm, one per channel; empty: channels are no single wavelengths
  std::vector<std::string> remarks;   ///< what was found wanting: "12 of 1439 values are negative, and kept"

  bool has_deviations = false;  ///< its samples state standard deviations
  /// Copies of all channels with samples drawn anew within their standard deviations (ReadOptions::replicates):
  /// `channels`, `wavelengths` and `at` have the reflectance's own channels first, then those of each copy.
  std::size_t replicates = 0;

  bool is_isotropic = true;   ///< does not see phi_in
  bool is_bilateral = false;  ///< isotropic, and the same for delta_phi and -delta_phi, to the last bits

  bool is_concurrent = true;  ///< calls of `at` from several threads run at the same time

  /// Values at any pairs, theta in [0, pi/2). May be called from several threads.
  std::function<BrdfValues(std::span<const Directions>)> at;
  /// Where the source is a matrix of averages over cells: it, with its delta parts.
  std::shared_ptr<const BrdfTable> cells = nullptr;
  /// Where the source is one: albedos, mean albedos and products of such functions are then sums.
  std::shared_ptr<const RingCells> ring_cells = nullptr;
};

/// Refuses reflectances that are more than their values.
/// \throws ArgumentError "'<name>' has delta parts; <expectation>" where values alone are not the reflectance.
void require_no_delta(const BrdfFunction& brdf, std::string_view expectation);

}  // namespace lobe
