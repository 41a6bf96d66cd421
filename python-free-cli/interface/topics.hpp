#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "interface/page.hpp"

namespace lobe::cli {

/// What `lobe help NAME` explains besides the commands.
struct Topic {
  std::string_view name;
  std::string_view summary;
  std::vector<Section> (*sections)();  ///< ends with examples that can be copied
};

[[nodiscard]] std::span<const Topic> topics();

/// What is known of a topic.
[[nodiscard]] Page topic_page(const Topic& topic);

}  // namespace lobe::cli
