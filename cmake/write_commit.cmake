# Writes the commit that is being built into a header, at every build; the file is touched only when it changes.
# Run with: cmake -D SOURCE=checkout -D IN=template -D OUT=header -P write_commit.cmake
set(archived "$Format:%H$")  # `git archive` puts the commit here
# A tree without .git may lie in somebody else's checkout.
execute_process(COMMAND git -C ${SOURCE} rev-parse --show-prefix RESULT_VARIABLE status
                OUTPUT_VARIABLE prefix OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(status EQUAL 0 AND prefix STREQUAL "")
  execute_process(COMMAND git -C ${SOURCE} describe --always --dirty --abbrev=12 --exclude *
                  OUTPUT_VARIABLE LOBE_COMMIT OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
elseif(archived MATCHES "^[0-9a-f]+$")
  string(SUBSTRING ${archived} 0 12 LOBE_COMMIT)
endif()
if(NOT LOBE_COMMIT)
  set(LOBE_COMMIT unknown)
endif()
configure_file(${IN} ${OUT} @ONLY)
