#pragma once

#include <string>
#include <vector>

#include "formats/format.hpp"

namespace lobe::test {

/// A whole file of a format.
struct FormatSample {
  std::string name;  ///< of the file that it comes from, for messages
  std::string content;
  std::size_t cost = 0;  ///< of reading it, in bytes of plain formats
};

/// The smallest readable files of a format below LOBE_DATA_DIR, gunzipped, what its writer makes, and those that
/// format_samples.cpp makes by hand. Empty where there are none, as for formats without a writer and no data.
/// \param largest bytes of a file
[[nodiscard]] std::vector<FormatSample> samples_of(const Format& format, std::size_t largest);

}  // namespace lobe::test
