#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <span>
#include <string>

#include "lobe/core/directions.hpp"
#include "lobe/device/device.hpp"
#include "lobe/model/material.hpp"

namespace lobe {

/// How nodes are made of pairs of directions.
enum class NodeMaking {
  closely,  ///< one by one, right to an ulp or two
  quickly   ///< several at a time, right to about four
};

/// The values of a material at any number of pairs of directions, again and again: what it needs on the device is made
/// once. For one thread at a time.
class MaterialValues {
 public:
  /// \param at_once how many pairs the device gets together
  /// \throws ArgumentError, DeviceError
  MaterialValues(const Device& device, const Material& material, Precision precision, NodeMaking making,
                 std::size_t at_once = kAtOnce);
  ~MaterialValues();
  MaterialValues(const MaterialValues&) = delete;
  MaterialValues& operator=(const MaterialValues&) = delete;

  /// As evaluate(), whatever the values are.
  /// \throws ArgumentError for an angle outside its range; DeviceError
  [[nodiscard]] Eigen::MatrixXd at(std::span<const Directions> directions);

  static constexpr std::size_t kAtOnce = 4096;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// As evaluate(), whatever the values are.
[[nodiscard]] Eigen::MatrixXd unchecked_values(const Device& device, const Material& material,
                                               std::span<const Directions> directions,
                                               Precision precision = Precision::double_precision);

/// \throws NumericError naming the first pair with a value that is no finite number
void require_finite(const Eigen::MatrixXd& values, const std::string& name, std::span<const Directions> directions);

}  // namespace lobe
