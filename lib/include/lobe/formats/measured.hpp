#pragma once

#include <cstddef>
#include <filesystem>
#include <numbers>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lobe/core/progress.hpp"
#include "lobe/device/device.hpp"
#include "lobe/table/reflectance.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// Value of a uniform of a shader.
struct UniformValue {
  std::string name;                                      ///< "roughness"
  std::vector<double> values;                            ///< one number, which serves all components, or one for each
  bool operator==(const UniformValue&) const = default;  ///< compares name and numbers
};

/// Options for reading a measured file.
struct ReadOptions {
  /// Channels to read, by name or by number, counted from 1; empty: all.
  std::vector<std::string> channels = {};
  /// Wavelengths to read, nm, which become the channels. Sampled spectra are interpolated linearly; spectra given as
  /// functions of the wavelength require this option.
  std::vector<double> wavelengths = {};
  /// Luminance to read as the only channel: "rec709" weights red, green and blue, "photopic" spectra (CIE 1931 y,
  /// equal-energy light).
  std::string luminance = {};
  /// Largest angle from the normal, radians, to which the file is trusted, for both directions; beyond, values stay as
  /// they are at that angle. Goniometers end at 75 to 85 degrees, and expansions fitted to them may be anything at the
  /// horizon.
  double theta_max = std::numbers::pi / 2;
  /// Reflectance to read from files with several: "reflection front", "reflection back"; of BiRD files the polarization
  /// of the light, "s", "p" or "u".
  std::string component = {};
  /// Number of copies of the channels redrawn within the standard deviations of the samples, for
  /// measurement_deviations(). There are fewer copies, but at least 20, if there are many samples, and none if the file
  /// states no deviations.
  std::size_t replicates = 0;
  /// Whether values are sRGB-encoded and must be decoded (UTIA, whose publications differ on that).
  bool decode_srgb = false;
  /// Function of a shader (GLSL) to take; empty: the last one that takes two directions.
  std::string entry = {};
  /// Values of uniforms of a shader, which replace those that its text gives.
  std::vector<UniformValue> uniforms = {};
};

/// Reads "NAME=VALUE", or "NAME=A/B/C" for vectors.
/// \throws ArgumentError for a text that is neither
[[nodiscard]] UniformValue parse_uniform(std::string_view text);

/// Whether options select anything but the whole file.
[[nodiscard]] bool has_choices(const ReadOptions& options);

/// Reads a measured reflectance; the format is recognised by content (docs/file-formats.md), also in gzip files and
/// pipes.
/// \throws IoError "cannot read FILE: ..." for files in no known format and damaged ones; ArgumentError for options
///   that the file cannot meet, with the available choices
[[nodiscard]] BrdfFunction load_measured(const std::filesystem::path& path, const ReadOptions& options = {});

/// Whether load_measured() reads the format of a file; false for files that cannot be read.
[[nodiscard]] bool is_measured_file(const std::filesystem::path& path);

/// Selects the channels, wavelengths or luminance of a table that options ask for; the names of its channels give the
/// wavelengths.
/// \throws ArgumentError for choices that the table does not have, and for the other options
[[nodiscard]] BrdfTable with_channels(const BrdfTable& table, const ReadOptions& options);

/// Options for writing a file for other programs.
struct WriteOptions {
  bool overwrite = false;           ///< replace a file that exists
  std::string command_line = {};    ///< recorded in formats that have comments
  std::size_t cell_points = 4;      ///< as in TabulateOptions, for averages over cells
  std::size_t light_angles = 24;    ///< rgl: angles of the light from the normal, 0 to 89 degrees
  std::size_t light_azimuths = 32;  ///< rgl: azimuths of the light, of anisotropic reflectances
  std::size_t nodes = 48;  ///< rgl: nodes along each axis of the square with the viewer's directions, for each light
  bool spectra = false;    ///< rgl: whether a single channel is written as a spectrum instead of red, green and blue
  /// tensor-tree: leaves along each axis of the viewer's square, a power of two up to 128 (anisotropic: 32); 0: 64 (16)
  std::size_t leaves = 0;
  ProgressCallback progress = {};  ///< told of the progress; may cancel
};

/// Writes a reflectance in a format of other programs: its values if the format holds samples, averages over cells if
/// it holds these. The averages are those of a table or function on such cells; any other reflectance is tabulated on
/// klems:145, whether that resolves it or not. The file is complete or absent.
/// \param format name of the format, see measured_formats()
/// \throws ArgumentError for formats that are not written, channels that the format cannot hold, and delta parts in
///   formats with samples; NumericError for values that are not finite; IoError; as as_function() and tabulate()
void save_measured(const Device& device, const Reflectance& reflectance, std::string_view format,
                   const std::filesystem::path& path, const WriteOptions& options = {});

/// A file format of other programs.
struct MeasuredFormat {
  std::string_view name;    ///< "merl"
  std::string_view title;   ///< "MERL .binary (Matusik et al. 2003)"
  bool is_written = false;  ///< whether save_measured() writes it
};
/// Lists all formats that lobe reads, by title.
[[nodiscard]] std::vector<MeasuredFormat> measured_formats();

}  // namespace lobe
