# What `git archive` makes of the project has all of its files, is configured without .git and knows the commit.
# Run with: cmake -D SOURCE=checkout -D BINARY=folder -D GENERATOR=name -P check_archive.cmake
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE text ERROR_VARIABLE error
                  OUTPUT_STRIP_TRAILING_WHITESPACE)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${ARGN}:\n${text}\n${error}")
  endif()
  set(output "${text}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE ${BINARY})
file(MAKE_DIRECTORY ${BINARY}/lobe)
run(git -C ${SOURCE} archive --format=tar --output=${BINARY}/lobe.tar HEAD)
file(ARCHIVE_EXTRACT INPUT ${BINARY}/lobe.tar DESTINATION ${BINARY}/lobe)
run(git -C ${SOURCE} ls-tree -r --name-only HEAD)
string(REPLACE "\n" ";" files "${output}")
foreach(file IN LISTS files)
  if(NOT EXISTS ${BINARY}/lobe/${file})
    message(FATAL_ERROR "${file} is not in the archive")
  endif()
endforeach()

run(${CMAKE_COMMAND} -S ${BINARY}/lobe -B ${BINARY}/build -G ${GENERATOR} -D LOBE_BUILD_TESTS=OFF)
run(${CMAKE_COMMAND} -D SOURCE=${BINARY}/lobe -D IN=${BINARY}/lobe/lib/build_commit.hpp.in -D OUT=${BINARY}/commit.hpp
    -P ${BINARY}/lobe/cmake/write_commit.cmake)
run(git -C ${SOURCE} rev-parse --short=12 HEAD)
set(commit ${output})
file(READ ${BINARY}/commit.hpp header)
if(NOT header MATCHES "\"${commit}\"")
  message(FATAL_ERROR "an archive of ${commit} says: ${header}")
endif()
