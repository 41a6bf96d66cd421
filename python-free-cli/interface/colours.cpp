#include "interface/colours.hpp"

#include <cstddef>
#include <string>
#include <vector>

#include "interface/operand.hpp"

namespace lobe::cli {
namespace {

std::vector<std::string> numbered(std::size_t channels) {
  std::vector<std::string> names;
  for (std::size_t c = 1; c <= channels; ++c) names.push_back(std::to_string(c));
  return names;
}

}  // namespace

DisplayColours colours_of(const Reflectance& reflectance) {
  const BrdfFunction* function = reflectance.function();
  const auto names = channel_names(reflectance);
  return display_colours(names.empty() ? numbered(reflectance.channels()) : names,
                         function == nullptr ? std::vector<double>() : function->wavelengths);
}

}  // namespace lobe::cli
