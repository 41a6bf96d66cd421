#pragma once

#include <string>

#include "formats/file_bytes.hpp"

namespace lobe {

/// Looks for signs that a text was cut within its last number, which then is a number, too. Files that end in anything
/// else, or whose last line is ended, have none.
/// \return a remark where the last number stands in a line that is not ended; else nothing
/// \throws IoError where moreover it has fewer decimals than all numbers at the ends of the lines before, which have as
///   many
[[nodiscard]] std::string remark_on_end(const FileBytes& file);

}  // namespace lobe
