#include "formats/format.hpp"

#include <algorithm>
#include <iterator>

namespace lobe {
namespace {

/// Those that cannot be mistaken for anything else come first, what is known by its size alone last.
const Format* const kFormats[] = {
    // binary
    &kNeuralEncodingFormat,
    &kRglFormat,
    &kMerlFormat,
    &kScatfunFormat,
    &kNpzFormat,
    // text, or with a text in front
    &kGlslFormat,
    &kBirdFormat,
    &kOpenMaterialFormat,
    &kTensorTreeFormat,
    &kKlemsFormat,
    &kSpeosFormat,
    &kAltaFormat,
    &kZemaxFormat,
    &kFredFormat,
    &kAstmFormat,
    &kBrfFormat,
    &kNistRowsFormat,
    &kCsvFormat,
    &kCornellFormat,
    &kZernikeFormat,
    // by size
    &kUtiaFormat,
};

}  // namespace

std::span<const Format* const> formats() {
  return kFormats;
}

const Format* format_of(const FileBytes& head) {
  const auto found = std::ranges::find_if(kFormats, [&](const Format* format) { return format->recognises(head); });
  return found == std::end(kFormats) ? nullptr : *found;
}

}  // namespace lobe
