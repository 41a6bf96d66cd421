# Flags for our own code; a target takes them by linking lobe_warnings.
add_library(lobe_warnings INTERFACE)
set(LOBE_WARNINGS -Wall -Wextra -Wpedantic -Wconversion -Wsign-conversion -Wshadow -Wold-style-cast -Wextra-semi
    -Woverloaded-virtual -Wnon-virtual-dtor -Wundef -Wcast-qual)
target_compile_options(lobe_warnings INTERFACE
  ${LOBE_WARNINGS} $<$<CXX_COMPILER_ID:Clang>:${LOBE_CLANG_WARNINGS}>
  $<$<BOOL:${LOBE_WERROR}>:-Werror>
  # At -O3 GCC 12 takes `"text" + std::string` for an overflow (bugs 105329, 105651); the preset dev, which
  # optimises less, keeps these.
  "$<$<AND:$<CXX_COMPILER_ID:GNU>,$<CONFIG:Release>>:-Wno-restrict;-Wno-stringop-overflow;-Wno-array-bounds>")
target_compile_definitions(lobe_warnings INTERFACE $<$<CONFIG:Debug>:_GLIBCXX_ASSERTIONS>)
