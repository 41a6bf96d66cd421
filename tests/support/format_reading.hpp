#pragma once

#include <array>

#include "formats/format.hpp"
#include "lobe/core/error.hpp"

namespace lobe::test {

/// Reads content as load_measured() does, with the options that formats may ask for: each is tried where those before
/// it do not do.
/// \throws what the reader throws
inline BrdfFunction read_with_any_options(const Format& format, const FileBytes& file) {
  const std::array<ReadOptions, 4> choices{
      {{}, {.wavelengths = {532}}, {.component = "reflection front"}, {.component = "reflection back"}}};
  for (std::size_t i = 0; i + 1 < choices.size(); ++i) {
    try {
      return read_measured(format, file, choices[i]);
    } catch (const ArgumentError&) {
    }
  }
  return read_measured(format, file, choices.back());
}

}  // namespace lobe::test
