# Writes the commit that is being built into a header, at every build; the file is touched only when it changes.
# Run with: cmake -D SOURCE=checkout -D IN=template -D OUT=header -P write_commit.cmake
execute_process(COMMAND git -C ${SOURCE} describe --always --dirty --abbrev=12 --exclude *
                OUTPUT_VARIABLE LOBE_COMMIT OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT LOBE_COMMIT)
  set(LOBE_COMMIT unknown)
endif()
configure_file(${IN} ${OUT} @ONLY)
