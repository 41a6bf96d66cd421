# lobe_embed_files(<target> HEADER <name> NAMESPACE <name> FILES <identifier>=<file>...)
# Adds an object library that holds text files as std::string_view, and the header that declares them.
function(lobe_embed_files target)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "HEADER;NAMESPACE" "FILES")
  set(script ${PROJECT_SOURCE_DIR}/cmake/embed_text.cmake)
  set(declarations "")
  add_library(${target} OBJECT)
  foreach(entry IN LISTS arg_FILES)
    string(REGEX MATCH "^([^=]*)=(.*)$" matched ${entry})
    set(id ${CMAKE_MATCH_1})
    set(file ${CMAKE_MATCH_2})
    set(source ${CMAKE_CURRENT_BINARY_DIR}/${target}/${id}.cpp)
    add_custom_command(
      OUTPUT ${source}
      COMMAND ${CMAKE_COMMAND} -D IN=${file} -D OUT=${source} -D ID=${id} -D HEADER=${arg_HEADER}
              -D NAMESPACE=${arg_NAMESPACE} -P ${script}
      DEPENDS ${file} ${script}
      VERBATIM)
    target_sources(${target} PRIVATE ${source})
    string(APPEND declarations "extern const std::string_view ${id};\n")
  endforeach()
  file(CONFIGURE OUTPUT ${target}/${arg_HEADER} CONTENT [[
#pragma once
#include <string_view>
namespace @arg_NAMESPACE@ {
@declarations@}  // namespace @arg_NAMESPACE@
]])
  target_include_directories(${target} PUBLIC $<BUILD_INTERFACE:${CMAKE_CURRENT_BINARY_DIR}/${target}>)
  target_compile_features(${target} PUBLIC cxx_std_20)
  set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON)
endfunction()
