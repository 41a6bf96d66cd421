#pragma once

/// Measured files, read and integrated by another route than the library's: written from the descriptions of the
/// formats (docs/file-formats.md), straightforward and slow, in double precision.

#include <array>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace lobe::reference {

/// A value for each of red, green and blue.
using Rgb = std::array<double, 3>;

/// An isotropic reflectance of a file: f in sr^-1, without a cosine, of the angles of both directions from the normal
/// and phi_out - phi_in (radians; pi is the mirror side).
struct MeasuredFile {
  std::string name;
  std::function<Rgb(double theta_in, double theta_out, double delta_phi)> f;
  bool is_even = false;      ///< f is the same for delta_phi and -delta_phi
  double theta_limit = 0;    ///< the last angle of the light that was measured; 0: any
  std::size_t channels = 3;  ///< 1 or 3; of one, all three numbers are the same
};

/// The neural encoding of Sztrajman et al. 2021: layers 6-21-21-3 with ReLU over the half-vector and the difference
/// vector, which give ln(1 + f).
/// \throws std::runtime_error for files that lack a layer
[[nodiscard]] MeasuredFile read_nbrdf(const std::filesystem::path& path);

/// The tensor file of Dupuy and Jakob 2018, isotropic and in RGB: the half-vector is taken to the unit square by the
/// marginal and conditional integrals of its density, where the values are bilinear.
/// \throws std::runtime_error for files without the fields, anisotropic and spectral ones
[[nodiscard]] MeasuredFile read_rgl(const std::filesystem::path& path);

/// A sum of a quadrature by channel, and what it may be off by.
struct RgbIntegral {
  Rgb value{};
  Rgb error{};
};

/// Integral of g over [a, b], cut at given places, by globally adaptive bisection with Gauss rules of 7 and 15 nodes:
/// the panel with the largest difference between both is halved until their sum is below the tolerance in every
/// channel. The error is that sum, which speaks of the rule with 7 nodes.
/// \param most panels, after which the sum is what it is
[[nodiscard]] RgbIntegral integrate(const std::function<Rgb(double)>& g, double a, double b, std::vector<double> cuts,
                                    double tolerance, std::size_t most = 4000);

/// a(theta_in) = integral of f cos(theta_out) dw(V): adaptive in theta_out and, inside, in delta_phi.
/// \param tolerance absolute
/// \param theta_max of V
[[nodiscard]] RgbIntegral albedo(const MeasuredFile& file, double theta_in, double tolerance,
                                 double theta_max = 1.5707963267948966);

/// The same reflectance with one channel for all: luminance by the weights of ITU-R BT.709.
[[nodiscard]] MeasuredFile luminance_of(const MeasuredFile& file);

/// C(L,V) = integral of f(L,X) f(X,V) dmu(X): adaptive in theta of X and, inside, in its azimuth, over panels that
/// shrink towards both mirror directions.
/// \param tolerance absolute
[[nodiscard]] RgbIntegral self_composition(const MeasuredFile& file, double theta_in, double theta_out,
                                           double delta_phi, double tolerance);

/// The mean albedo of C, (1/pi) integral of C dmu dmu: that of the albedos of X as light and as viewer,
/// (1/pi) integral of a(X) a*(X) dmu(X).
/// \param tolerance absolute
[[nodiscard]] RgbIntegral self_composition_mean(const MeasuredFile& file, double tolerance);

/// Integral of C^2 dmu dmu for the first channel, by Fourier series in azimuth over Gauss nodes in theta; the error is
/// what differs on two thirds of the nodes.
/// \param nodes of theta, half of those of azimuth
[[nodiscard]] RgbIntegral self_composition_square(const MeasuredFile& file, std::size_t nodes);

/// The means over all pairs of directions within a cone about the normal, from importance sampling of half-vectors with
/// points of a rank-1 lattice, shifted at random.
struct PairMeans {
  RgbIntegral albedo;  ///< (1/pi) integral of f dmu dmu
  RgbIntegral square;  ///< integral of f^2 dmu dmu, or of f g
};

/// \param theta_max of both directions
/// \param width of the sharpest lobe of half-vectors, radians, of which a third of the points draws
/// \param points of one shift
/// \param shifts independent ones, whose scatter is the standard error that is given, one sigma
/// \param other g, whose product with f is wanted instead of the square
[[nodiscard]] PairMeans pair_means(const MeasuredFile& file, double theta_max, double width, std::size_t points,
                                   std::size_t shifts, unsigned seed, const MeasuredFile* other = nullptr);

}  // namespace lobe::reference
