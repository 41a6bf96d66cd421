#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lobe/core/written_form.hpp"
#include "lobe/formats/measured.hpp"
#include "lobe/model/material.hpp"

namespace [[gnu::visibility("default")]] lobe {

/// A file, with options for reading it.
struct ChosenFile {
  std::filesystem::path path;                ///< without brackets and adjustments
  ReadOptions options = {};                  ///< options in the brackets, and defaults for the others
  bool has_brackets = false;                 ///< whether options were written behind the name
  std::vector<Adjustment> adjustments = {};  ///< adjustments behind "@", of a material file
};

/// Splits "FILE[KEY=VALUE,...]", such as "paint.bsdf[theta_max=80,channels=red,blue]". The keys are those of
/// file_choices(); `theta_max` is in degrees, lists extend to the next key, and `srgb` may stand alone. If the text is
/// the name of a file, it is that file, with or without brackets; a text without brackets at its end is a path. Behind
/// "@" at the end of a name with a slash or a point stand adjustments, as in "paint.toml@normalise".
/// \param options defaults for whatever the brackets do not set; a choice of channels, wavelengths or luminance in the
///   brackets replaces any of the three
/// \throws ArgumentError "'TEXT', character N: ..." for brackets that cannot be read; as parse_adjustment()
[[nodiscard]] ChosenFile parse_file(const std::string& text, const ReadOptions& options = {});

/// Refuses adjustments behind the name of a file that cannot be adjusted.
/// \throws ArgumentError if there are any
void refuse_adjustments(const ChosenFile& file);

/// Lists the options that brackets may hold: key, "KEY=VALUE", meaning.
[[nodiscard]] std::span<const WrittenForm> file_choices();

/// Converts the largest angle that counts from degrees to radians.
/// \throws ArgumentError outside (0, 90]
[[nodiscard]] double theta_max_of(double degrees);

}  // namespace lobe
