#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "interface/page.hpp"

namespace lobe::cli {

/// Topics of `lobe help NAME` besides the commands.
struct Topic {
  std::string_view name;
  std::string_view summary;
  std::vector<Section> (*sections)();  ///< ends with examples that can be copied
};

[[nodiscard]] std::span<const Topic> topics();

/// A help topic.
[[nodiscard]] Page topic_page(const Topic& topic);

}  // namespace lobe::cli
