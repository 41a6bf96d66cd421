#pragma once

#include <functional>
#include <string_view>

namespace [[gnu::visibility("default")]] lobe {

/// Called now and then during long work with the stage ("point", "daylight", ...) and its share done in [0, 1].
/// Returning false stops the work: the call in progress throws Cancelled. Never called concurrently.
using ProgressCallback = std::function<bool(std::string_view stage, double fraction)>;

}  // namespace lobe
