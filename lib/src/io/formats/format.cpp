#include "io/formats/format.hpp"

#include <algorithm>
#include <array>

namespace lobe {
namespace {

/// Those that cannot be mistaken for anything else come first.
const std::array<const Format*, 5> kFormats{&kNeuralEncodingFormat, &kRglFormat, &kMerlFormat, &kUtiaFormat,
                                            &kZernikeFormat};

}  // namespace

std::span<const Format* const> formats() {
  return kFormats;
}

const Format* format_of(const FileBytes& head) {
  const auto found = std::ranges::find_if(kFormats, [&](const Format* format) { return format->recognises(head); });
  return found == kFormats.end() ? nullptr : *found;
}

}  // namespace lobe
