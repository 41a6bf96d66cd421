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

namespace lobe {

/// What of a file is read, and how.
struct ReadOptions {
  /// Channels wanted, by name or by number from 1 on; empty: all.
  std::vector<std::string> channels = {};
  /// Wavelengths wanted, nm, which become the channels: sampled spectra are interpolated linearly; spectra that are
  /// functions of the wavelength need them.
  std::vector<double> wavelengths = {};
  /// One channel, the luminance: "rec709" weighs red, green and blue, "photopic" spectra (CIE 1931 y, equal-energy
  /// light).
  std::string luminance = {};
  /// Angle from the normal, radians, up to which the file counts, of both directions; beyond, values are those there.
  /// Goniometers end at 75 to 85 degrees, and expansions fitted to them may be anything at the horizon.
  double theta_max = std::numbers::pi / 2;
  /// Of files with several reflectances, which one: "reflection front", "reflection back".
  std::string component = {};
  /// Copies of the channels that are drawn within the standard deviations of the samples, for measurement_deviations();
  /// fewer, but 20 at least, where samples are many; none for files that state no deviations.
  std::size_t replicates = 0;
  /// Values are sRGB-encoded and are decoded (UTIA, whose publications differ on that).
  bool decode_srgb = false;
};

/// Whether options ask for anything but the whole file.
[[nodiscard]] bool has_choices(const ReadOptions& options);

/// Reads a reflectance; the format is recognised by content (docs/file-formats.md), also of what gzip has compressed
/// and of pipes.
/// \throws IoError "cannot read FILE: ..." for files of no known format and damaged ones; ArgumentError for options
///   that the file cannot meet, with what it has.
[[nodiscard]] BrdfFunction load_measured(const std::filesystem::path& path, const ReadOptions& options = {});

/// Whether a file is of a format that load_measured() reads; false for files that cannot be read.
[[nodiscard]] bool is_measured_file(const std::filesystem::path& path);

/// A table with the channels, wavelengths or luminance that options ask for; wavelengths are those that the names of
/// its channels give.
/// \throws ArgumentError for what the table does not have, and for the other options.
[[nodiscard]] BrdfTable with_channels(const BrdfTable& table, const ReadOptions& options);

/// How a file of another program is written.
struct WriteOptions {
  bool overwrite = false;          ///< replace a file that exists
  std::string command_line = {};   ///< recorded in formats that have comments
  std::size_t samples = 4;         ///< as in TabulateOptions, of averages over cells
  ProgressCallback progress = {};  ///< told of the progress; may cancel
};

/// Writes a reflectance in a format of other programs, by its values where the format has samples, by averages over
/// cells where it has these: those of a table or function on such cells, else tabulated on klems:145, whether that
/// resolves it or not. The file is complete or absent.
/// \param format its name, see foreign_formats()
/// \throws ArgumentError for formats that are not written, channels that the format cannot hold, and delta parts where
///   it has samples; NumericError for values that are no finite numbers; IoError; as as_function() and tabulate().
void save_measured(const Device& device, const Reflectance& reflectance, std::string_view format,
                   const std::filesystem::path& path, const WriteOptions& options = {});

/// A format of other programs.
struct ForeignFormat {
  std::string_view name;    ///< "merl"
  std::string_view title;   ///< "MERL .binary (Matusik et al. 2003)"
  bool is_written = false;  ///< save_measured() writes it
};
/// All that are read, by title.
[[nodiscard]] std::vector<ForeignFormat> foreign_formats();

}  // namespace lobe
