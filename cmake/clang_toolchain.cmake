# Compiles with the clang that cmake/clang.cmake finds: presets `clang` and `tidy`.
include(${CMAKE_CURRENT_LIST_DIR}/clang.cmake)
set(CMAKE_C_COMPILER ${LOBE_CLANG})
string(REGEX REPLACE "clang([^/]*)$" "clang++\\1" CMAKE_CXX_COMPILER ${LOBE_CLANG})
