#pragma once

#include <span>
#include <string>
#include <string_view>

#include "formats/file_bytes.hpp"
#include "lobe/formats/measured.hpp"

namespace lobe {

/// A format of other programs. Readers take content that may be anything: what is wrong is an IoError with its place,
/// found before memory beyond a few times the file's size is taken.
struct Format {
  std::string_view name;   ///< "merl"
  std::string_view title;  ///< "MERL .binary (Matusik et al. 2003)"
  /// Whether a file is of the format, from its first 64 KiB at most (and file_size()). Damaged files of the format
  /// should pass, so that their reader says what is wrong.
  bool (*recognises)(const FileBytes& head);
  /// Everything that the file holds. `options` is for formats which need it to make a function: `wavelengths`,
  /// `component`, `decode_srgb`; channels, luminance and theta_max are chosen of the result afterwards.
  BrdfFunction (*read)(const FileBytes& file, const ReadOptions& options);
  /// The reader makes channels of options.wavelengths itself.
  bool makes_wavelengths = false;
  /// The content of a file with this reflectance; nullptr: the format is only read.
  std::string (*write)(const BrdfFunction& brdf, const WriteOptions& options) = nullptr;
  /// Writing takes averages over cells, with delta parts.
  bool holds_cells = false;
  /// Writing takes functions with replicates, and states their standard deviations.
  bool holds_deviations = false;
  /// The reader takes options.entry and options.uniforms.
  bool takes_functions = false;
};

/// All formats, in the order in which they are tried.
[[nodiscard]] std::span<const Format* const> formats();

/// The format of a file, or nothing.
/// \param head its first bytes
[[nodiscard]] const Format* format_of(const FileBytes& head);

/// Reads and chooses; what load_measured() does once the content is in memory.
/// \throws as load_measured().
[[nodiscard]] BrdfFunction read_measured(const Format& format, const FileBytes& file, const ReadOptions& options);

// One file each, in alphabetical order.
extern const Format kAltaFormat;
extern const Format kAstmFormat;
extern const Format kBirdFormat;
extern const Format kBrfFormat;
extern const Format kCornellFormat;
extern const Format kCsvFormat;
extern const Format kFredFormat;
extern const Format kGlslFormat;
extern const Format kKlemsFormat;
extern const Format kMerlFormat;
extern const Format kNeuralEncodingFormat;
extern const Format kNistRowsFormat;
extern const Format kNpzFormat;
extern const Format kOpenMaterialFormat;
extern const Format kRglFormat;
extern const Format kScatfunFormat;
extern const Format kSpeosFormat;
extern const Format kTensorTreeFormat;
extern const Format kUtiaFormat;
extern const Format kZemaxFormat;
extern const Format kZernikeFormat;

}  // namespace lobe
