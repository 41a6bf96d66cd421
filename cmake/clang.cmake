# Clang and its tools: version 14 of Debian 12 or 19 of Debian 13, as script/bootstrap installs them, else the system's.
find_program(LOBE_CLANG NAMES clang-14 clang-19 clang)
# From version 16 on clang takes `\throws Error` for a paragraph that is missing.
set(LOBE_CLANG_WARNINGS "" CACHE INTERNAL "")
execute_process(COMMAND ${LOBE_CLANG} -dumpversion OUTPUT_VARIABLE clang_version OUTPUT_STRIP_TRAILING_WHITESPACE)
if(clang_version VERSION_LESS 16)
  set(LOBE_CLANG_WARNINGS -Wdocumentation CACHE INTERNAL "Warnings that gcc does not have")
endif()
find_program(LOBE_CLANG_TIDY NAMES clang-tidy-14 clang-tidy-19 clang-tidy)
# Other versions lay code out differently.
find_program(LOBE_CLANG_FORMAT NAMES clang-format-14)
