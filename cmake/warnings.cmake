# Flags for our own code; a target takes them by linking lobe_warnings.
add_library(lobe_warnings INTERFACE)
target_compile_options(lobe_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wconversion -Wsign-conversion -Wshadow -Wold-style-cast -Wextra-semi
  -Woverloaded-virtual -Wnon-virtual-dtor -Wundef -Wcast-qual $<$<CXX_COMPILER_ID:Clang>:-Wdocumentation>
  $<$<BOOL:${LOBE_WERROR}>:-Werror>)
target_compile_definitions(lobe_warnings INTERFACE $<$<CONFIG:Debug>:_GLIBCXX_ASSERTIONS>)
