# Flags for our own code; a target takes them by linking lobe_warnings.
add_library(lobe_warnings INTERFACE)
target_compile_options(lobe_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wconversion -Wsign-conversion -Wshadow -Wold-style-cast -Wextra-semi
  -Woverloaded-virtual -Wnon-virtual-dtor -Wundef -Wcast-qual $<$<CXX_COMPILER_ID:Clang>:-Wdocumentation>
  $<$<BOOL:${LOBE_WERROR}>:-Werror>)
# GCC 12 takes `"text" + std::string` for an overflow once it inlines all of it, at -O3 (bugs 105329, 105651).
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  target_compile_options(lobe_warnings INTERFACE -Wno-restrict -Wno-stringop-overflow)
endif()
target_compile_definitions(lobe_warnings INTERFACE $<$<CONFIG:Debug>:_GLIBCXX_ASSERTIONS>)
