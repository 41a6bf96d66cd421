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

/// Reflectance values in sr^-1, without a cosine; pairs of directions x channels.
struct BrdfValues {
  Eigen::MatrixXd value;  ///< pairs x channels
  Eigen::MatrixXd error;  ///< interpolation error, NaN where unknown; 0 x 0 if the source itself defines the values
};

/// An isotropic reflectance that is constant while L stays within a ring and V, turned along with L, within a cell of
/// Shirley and Chiu's square, so that its integrals are sums.
struct RingCells {
  std::size_t rings = 0;       ///< rings of L, of equal width in sin(theta_in)
  std::size_t side = 0;        ///< cells of V along each axis of the square, of equal projected solid angle
  std::vector<double> values;  ///< sr^-1, [channel][ring][cell], from the normal outwards
};

/// The samples of a measurement, before anything is interpolated.
struct MeasuredSamples {
  std::vector<Directions> pairs;  ///< in the order of the file
  Eigen::MatrixXd values;         ///< sr^-1, pairs x channels
  Eigen::MatrixXd deviations;     ///< standard deviations, as the values; 0 x 0 where none are stated
};

/// A reflectance as a function of pairs of directions, from a file, a table or a material. Only its `cells` hold delta
/// parts.
struct BrdfFunction {
  std::string name;                   ///< "pink-felt"
  std::string format;                 ///< format of the file: "NBRDF neural encoding"; empty without a file
  std::string conventions;            ///< conventions of the file: units, directions, colour scale, and how it is read
  std::vector<std::string> channels;  ///< names: "red", "532 nm"
  std::vector<double> wavelengths;    ///< nm, one per channel; empty if channels are not single wavelengths
  std::vector<std::string> remarks;   ///< shortcomings found in the file: "12 of 1439 values are negative, and kept"

  bool has_deviations = false;  ///< whether its samples state standard deviations
  /// Number of copies of all channels with samples redrawn within their standard deviations (ReadOptions::replicates).
  /// `channels`, `wavelengths` and `at` list the reflectance's own channels first, then those of each copy.
  std::size_t replicates = 0;

  bool is_isotropic = true;   ///< whether it is independent of phi_in
  bool is_bilateral = false;  ///< whether it is isotropic and equal for delta_phi and -delta_phi, to the last bits
  /// Whether it is known to be equal for exchanged directions but for rounding, and its errors, too. Of isotropic and
  /// bilateral functions sums then take one order. Whoever puts another `at` here sets it anew.
  bool is_reciprocal = false;

  bool is_concurrent = true;  ///< whether calls of `at` from several threads run at the same time

  /// Computes values at any pairs, theta in [0, pi/2). It may be called from several threads.
  std::function<BrdfValues(std::span<const Directions>)> at;
  /// Table of averages over cells, with its delta parts, if the source is one.
  std::shared_ptr<const BrdfTable> cells = nullptr;
  /// Ring cells, if the source is made of them; albedos, mean albedos and products of such functions are then sums.
  std::shared_ptr<const RingCells> ring_cells = nullptr;
  /// Its samples, if the source is a list of them at any pairs of directions.
  std::shared_ptr<const MeasuredSamples> samples = nullptr;
};

/// Refuses functions with delta parts, which values alone do not represent.
/// \throws ArgumentError "'<name>' has delta parts; <expectation>"
void require_no_delta(const BrdfFunction& brdf, std::string_view expectation);

}  // namespace lobe
