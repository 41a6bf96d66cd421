#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "lobe/core/form.hpp"
#include "lobe/io/measured.hpp"

namespace lobe {

/// A file, and what of it is read.
struct ChosenFile {
  std::filesystem::path path;  ///< without brackets
  ReadOptions options = {};    ///< those in the brackets, and what holds beside them
  bool has_brackets = false;   ///< options were written behind the name
};

/// Takes "FILE[KEY=VALUE,...]" apart, such as "paint.bsdf[theta_max=80,channels=red,blue]". The keys are those of
/// file_choices(); `theta_max` is in degrees, lists go on until the next key, and `srgb` may stand alone. A text that
/// is the name of a file is that file, brackets or not; one without brackets at its end is a path.
/// \param options what holds where the brackets say nothing; their choice of channels, of wavelengths or of the
///   luminance replaces any of the three
/// \throws ArgumentError "'TEXT', character N: ..." for brackets that cannot be read
[[nodiscard]] ChosenFile parse_file(const std::string& text, const ReadOptions& options = {});

/// What may stand in the brackets: key, "KEY=VALUE", meaning.
[[nodiscard]] std::span<const Form> file_choices();

/// The largest angle that counts, radians, of one in degrees.
/// \throws ArgumentError outside of (0, 90].
[[nodiscard]] double theta_max_of(double degrees);

}  // namespace lobe
