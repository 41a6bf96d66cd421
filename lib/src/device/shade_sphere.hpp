#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "device/lobe_batch.hpp"
#include "device/opencl.hpp"
#include "lobe/device/device.hpp"

namespace lobe {

/// A part of the picture of a sphere of radius 1 about the origin; x to the right, y up.
struct SpherePart {
  double x_low, x_high;
  double y_low, y_high;
};

/// Radiance of spheres of one material under distant point lights (kernels/lobes/shade_sphere.cl).
class SphereShader {
 public:
  /// \param mix rows x lobes: what each row of the radiance takes of the lobes, in the order of the batches
  /// \throws DeviceError
  SphereShader(const Device& device, const std::vector<LobeBatch>& batches, const Eigen::MatrixXd& mix,
               Precision precision);

  /// The integral of the radiance over each part, rows x parts; none comes from outside the sphere.
  /// \param nodes of a rule on [0, 1] and
  /// \param weights its weights, along both coordinates
  /// \param lights direction towards the light, z towards the viewer, and irradiance
  /// \throws DeviceError
  [[nodiscard]] Eigen::MatrixXd shade(std::span<const SpherePart> parts, std::span<const double> nodes,
                                      std::span<const double> weights, std::span<const std::array<double, 4>> lights);

 private:
  struct Model {
    cl::Kernel kernel;
    cl::Buffer coefficients;
    std::size_t lobes;
  };

  Device device_;
  std::size_t rows_;
  std::vector<Model> models_;
};

}  // namespace lobe
