#pragma once

/// Readers of further formats of measured files, written from the descriptions of the formats and not from the
/// library's: straightforward and slow, in double precision.

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "reference/measured_files.hpp"

namespace lobe::reference {

/// Fourier table of layerlab and pbrt-v3 (SCATFUN; also compressed by gzip): series over the azimuth, Catmull-Rom
/// splines in both cosines, divided by that of the light. Light from above.
/// \throws std::runtime_error for other files
[[nodiscard]] MeasuredFile read_scatfun(const std::filesystem::path& path);

/// Polynomial of Germer 2017 for unpolarised light.
/// \param wavelength in micrometres; matters for coefficients with powers of it
/// \throws std::runtime_error for lines that are no coefficients
[[nodiscard]] MeasuredFile read_zernike(const std::filesystem::path& path, double wavelength);

/// Whether a file of such coefficients has powers of the wavelength.
[[nodiscard]] bool depends_on_wavelength(const std::filesystem::path& path);

/// ALTA text over COS_TH with three outputs: taken for all pairs of directions by their half-vector, linear in its
/// angle.
/// \throws std::runtime_error for other files
[[nodiscard]] MeasuredFile read_alta_slice(const std::filesystem::path& path);

/// An operator that is constant on pairs of cells, which lie in rings, one cell of each about azimuth 0.
struct CellFile {
  /// Between two angles from the normal, radians.
  struct Ring {
    double low, high;
    std::size_t count;
  };
  std::string name;
  std::vector<Ring> rings;
  std::vector<std::string> channels;
  std::vector<double> measure;              ///< projected solid angle of each cell
  std::vector<std::vector<double>> values;  ///< [channel][in * cells + out], in: where light comes from

  /// Index of a cell.
  [[nodiscard]] std::size_t cell_at(double theta, double phi) const;
};

/// Klems matrices of LBNL's XML on its full basis: reflection front, or back if that is all.
/// \throws std::runtime_error for other files
[[nodiscard]] CellFile read_klems(const std::filesystem::path& path);

/// Albedo for light from within a cell.
[[nodiscard]] double albedo(const CellFile& file, std::size_t channel, std::size_t in);
[[nodiscard]] double mean_albedo(const CellFile& file, std::size_t channel);
/// Integral of f g dmu dmu of two files on the same cells, over the rings that end at an angle or before.
[[nodiscard]] double product(const CellFile& f, const CellFile& g, std::size_t channel, double theta_max);
/// The composition of a file with itself.
[[nodiscard]] CellFile self_composition(const CellFile& file);

/// Tensor tree of three dimensions (Radiance): an isotropic reflectance, constant on rings of equal width in the sine
/// of the light's angle and on cells of Shirley and Chiu's square for the viewer, seen from the light.
struct RingFile {
  std::string name;
  std::size_t rings = 0;       ///< as many as the finest leaf asks for
  std::size_t side = 0;        ///< cells of the square along each axis
  std::vector<double> values;  ///< [ring][cell], from the normal outwards
};
/// \throws std::runtime_error for other files
[[nodiscard]] RingFile read_tensor_tree3(const std::filesystem::path& path);
[[nodiscard]] double albedo(const RingFile& file, double theta_in);
[[nodiscard]] double mean_albedo(const RingFile& file);
[[nodiscard]] double squared_norm(const RingFile& file);

/// A measured value at a pair of directions, radians; azimuths absolute, 180 degrees apart on the mirror side.
struct Sample {
  double theta_in, phi_in, theta_out, phi_out;
  double value;  ///< sr^-1 without a cosine
};

/// Samples of one channel of goniometers' files: Cornell's .brdf, rows of NIST, tables of the Black Lab, FRED's
/// tabulated scatter, Zemax' .bsdf and ALTA over ISOTROPIC_TL_TV_PROJ_DPHI or ISOTROPIC_TV_TL_DPHI.
/// \param channel counted from 0, as the file has it
/// \throws std::runtime_error for other files
[[nodiscard]] std::vector<Sample> read_samples(const std::filesystem::path& path, std::size_t channel);

/// Samples that no other one, nor its reciprocal or mirror image, comes near: what an interpolation has to meet.
/// \param distance between directions, radians
/// \param most samples that are looked at, spread over all
[[nodiscard]] std::vector<Sample> lonely(const std::vector<Sample>& samples, bool is_isotropic, double distance,
                                         std::size_t most);

}  // namespace lobe::reference
