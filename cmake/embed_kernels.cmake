# lobe_embed_kernels(<target> DIRECTORY <folder> KERNELS <file>... TABLE <file>...)
# Adds the text of each kernel file to a target, and lobe::kernels::text(), which finds the texts of the table by their
# paths below the folder. Makes kernels.hpp in the current binary folder. Files of the table that are not in KERNELS come
# from elsewhere.
function(lobe_embed_kernels target)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "DIRECTORY" "KERNELS;TABLE")
  set(declarations "")
  set(table "")
  foreach(kernel IN LISTS arg_TABLE)
    string(MAKE_C_IDENTIFIER ${kernel} id)
    string(APPEND declarations "extern const std::string_view ${id};\n")
    string(APPEND table "    {\"${kernel}\", ${id}},\n")
  endforeach()
  foreach(kernel IN LISTS arg_KERNELS)
    string(MAKE_C_IDENTIFIER ${kernel} id)
    set(source ${CMAKE_CURRENT_BINARY_DIR}/${id}.cpp)
    set(script ${PROJECT_SOURCE_DIR}/cmake/embed_text.cmake)
    add_custom_command(
      OUTPUT ${source}
      COMMAND ${CMAKE_COMMAND} -D IN=${arg_DIRECTORY}/${kernel} -D OUT=${source} -D ID=${id} -D HEADER=kernels.hpp
              -D NAMESPACE=lobe::kernels -D NAME=kernels/${kernel} -P ${script}
      DEPENDS ${arg_DIRECTORY}/${kernel} ${script}
      VERBATIM)
    target_sources(${target} PRIVATE ${source})
  endforeach()
  file(CONFIGURE OUTPUT kernels.hpp CONTENT [[
#pragma once
#include <string_view>
namespace lobe::kernels {
@declarations@
/// The text of a kernel file by its path below kernels/; empty for an unknown path.
std::string_view text(std::string_view path);
}  // namespace lobe::kernels
]])
  file(CONFIGURE OUTPUT text.cpp CONTENT [[
#include <array>
#include <utility>
#include "kernels.hpp"
namespace lobe::kernels {
std::string_view text(std::string_view path) {
  const auto files = std::to_array<std::pair<std::string_view, std::string_view>>({
@table@  });
  for (const auto& [name, content] : files) {
    if (name == path) return content;
  }
  return {};
}
}  // namespace lobe::kernels
]])
  target_sources(${target} PRIVATE ${CMAKE_CURRENT_BINARY_DIR}/text.cpp)
endfunction()
