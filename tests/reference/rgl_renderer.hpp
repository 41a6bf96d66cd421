#pragma once

/// RGL's tensor files as renderers load and sample them: written from the sources of the loaders of powitacq (Dupuy and
/// Jakob), Mitsuba 3 (`measured`) and pbrt-v4 (`MeasuredBxDF`), in single precision as there.

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace lobe::reference {

using Vec3f = std::array<float, 3>;

/// A density over the unit square, bilinear between the nodes of a grid, that depends on up to two parameters, between
/// whose values it is linear. It is sampled by the marginal over rows and the conditional along them.
class Marginal2D {
 public:
  struct Found {
    std::array<float, 2> place;  ///< x, y
    float density;
  };

  Marginal2D() = default;
  /// \param parameters their values; the first one has the longest stride
  /// \param is_density whether every grid is divided by its integral
  Marginal2D(std::vector<float> data, std::size_t width, std::size_t height, std::vector<std::vector<float>> parameters,
             bool is_density);

  [[nodiscard]] Found sample(std::array<float, 2> uniform, const std::vector<float>& parameters) const;
  [[nodiscard]] Found invert(std::array<float, 2> place, const std::vector<float>& parameters) const;
  [[nodiscard]] float eval(std::array<float, 2> place, const std::vector<float>& parameters) const;

 private:
  struct Slice {
    std::size_t index;
    float weight;
  };
  [[nodiscard]] std::vector<Slice> slices_at(const std::vector<float>& parameters) const;

  std::size_t width_ = 0;
  std::size_t height_ = 0;
  std::vector<std::vector<float>> parameters_;
  std::vector<float> data_;         // [slice][row][column]
  std::vector<float> conditional_;  // integrals along rows, in cells
  std::vector<float> marginal_;     // integrals over rows, in cells
};

class RglRenderer {
 public:
  /// \throws std::runtime_error for content that one of the loaders refuses: pbrt-v4 and powitacq, and the spectral
  ///   variants of Mitsuba, for files of spectra; the RGB variants of Mitsuba for others
  explicit RglRenderer(const std::string& content);

  [[nodiscard]] std::size_t channels() const { return wavelengths_.size(); }

  struct Drawn {
    Vec3f out;
    float pdf;                  ///< per solid angle
    std::vector<float> weight;  ///< f cos(theta_out) / pdf, by channel
  };

  /// f cos(theta_out) of all channels.
  [[nodiscard]] std::vector<float> eval(const Vec3f& in, const Vec3f& out) const;
  /// Density of drawing a direction, per solid angle.
  [[nodiscard]] float pdf(const Vec3f& in, const Vec3f& out) const;
  /// A direction by two uniform numbers; none where it is below the horizon.
  [[nodiscard]] std::optional<Drawn> sample(const Vec3f& in, float u0, float u1) const;

 private:
  [[nodiscard]] std::vector<float> values(const std::array<float, 2>& place, const Vec3f& in,
                                          const std::array<float, 2>& normal) const;

  Marginal2D ndf_;
  Marginal2D sigma_;
  Marginal2D vndf_;
  Marginal2D luminance_;
  Marginal2D values_;
  std::vector<float> wavelengths_;  // 0, 1, 2 for red, green and blue
  bool is_isotropic_ = false;
};

/// A field of a tensor file as it lies there.
struct TensorField {
  std::string name;
  unsigned type = 0;
  std::size_t offset = 0;
  std::vector<std::size_t> shape;
  std::vector<float> floats;  ///< of fields of single precision
  std::string bytes;          ///< of all fields
};

/// Fields in the order of the file.
/// \throws std::runtime_error for content that is no tensor file of version 1.0
[[nodiscard]] std::vector<TensorField> tensor_fields_of(const std::string& content);

}  // namespace lobe::reference
