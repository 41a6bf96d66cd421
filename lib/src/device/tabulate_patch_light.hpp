#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "device/opencl.hpp"
#include "lobe/device/device.hpp"

namespace lobe {

/// Points of the unit disc of the base plane in polar coordinates: sin(theta) and the azimuth, in [0, pi].
struct DiscPoints {
  std::vector<double> radius;
  std::vector<double> angle;

  void push(double r, double phi) {
    radius.push_back(r);
    angle.push_back(phi);
  }
  [[nodiscard]] std::size_t size() const { return radius.size(); }
};

/// Discs of the base plane that make a part of a lighting: factor times their common area, sr^-1.
struct LightDisc {
  double radius;
  double factor;
};

/// The lighting W = sum of weight C_{eta_R} of patch lights (Neumann 2001, eqs. 5.23 and 4.2) between points, sr^-1.
class PatchLight {
 public:
  /// \throws DeviceError
  PatchLight(const Device& device, std::vector<LightDisc> discs);

  /// Points P and Q between which W is wanted from now on.
  void place(const DiscPoints& p, const DiscPoints& q);

  /// Values per row of what tabulate() writes: points P, rounded up to packs.
  [[nodiscard]] std::size_t stride() const { return stride_; }
  /// stride() for so many points P.
  [[nodiscard]] std::size_t stride_of(std::size_t points) const;

  /// values[k][i] = W(P_i, Q_{first + k}), k < count, each row with stride() values.
  void tabulate(std::size_t first, std::size_t count, std::span<double> values);

 private:
  [[nodiscard]] cl::Buffer arcs(const DiscPoints& points, std::size_t stride) const;
  [[nodiscard]] cl::Buffer coordinates(const DiscPoints& points, std::size_t stride) const;

  Device device_;
  std::vector<LightDisc> discs_;
  cl::Kernel kernel_;
  cl::Buffer disc_buffer_;
  cl::Buffer p_, p_arcs_, q_, q_arcs_;
  std::size_t stride_ = 0;
  std::size_t columns_ = 0;
};

}  // namespace lobe
