#pragma once

#include <string>

namespace [[gnu::visibility("default")]] lobe {

/// The name of a material, and the family to which it belongs.
struct MaterialLabel {
  std::string name;         ///< distinct within a set
  std::string family = {};  ///< the same for the materials of one kind
};

}  // namespace lobe
