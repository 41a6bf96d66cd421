#pragma once

#include <functional>
#include <string_view>

namespace [[gnu::visibility("default")]] lobe {

/// Callback for long work. It is called now and then with the stage ("point", "daylight", ...) and the share done, in
/// [0, 1]. Return false to stop the work: the call in progress throws Cancelled. It is never called concurrently.
using ProgressCallback = std::function<bool(std::string_view stage, double fraction)>;

}  // namespace lobe
