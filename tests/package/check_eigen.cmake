# Configures the project against an Eigen that only announces its version: 3.4 and 5 are taken, and what is installed asks
# for the same; others are refused by name.
# Run with: cmake -D SOURCE=checkout -D BINARY=folder -D GENERATOR=name -P check_eigen.cmake
include(CMakePackageConfigHelpers)

# configure(<version>): leaves `status` and `output`.
function(configure version)
  set(config ${BINARY}/eigen-${version})
  file(WRITE ${config}/Eigen3Config.cmake "if(NOT TARGET Eigen3::Eigen)\n  add_library(Eigen3::Eigen INTERFACE IMPORTED)\nendif()\n")
  write_basic_package_version_file(${config}/Eigen3ConfigVersion.cmake VERSION ${version} COMPATIBILITY SameMajorVersion
                                   ARCH_INDEPENDENT)
  execute_process(COMMAND ${CMAKE_COMMAND} -S ${SOURCE} -B ${BINARY}/build -G ${GENERATOR} --fresh
                          -D Eigen3_DIR=${config} -D LOBE_BUILD_TESTS=OFF
                  RESULT_VARIABLE result OUTPUT_VARIABLE text ERROR_VARIABLE text)
  set(status ${result} PARENT_SCOPE)
  set(output "${text}" PARENT_SCOPE)
endfunction()

foreach(version IN ITEMS 3.4.0 5.0.1)
  configure(${version})
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "Eigen ${version} is not taken:\n${output}")
  endif()
  string(REGEX REPLACE "^(3\\.4|5).*" "\\1" asked ${version})
  file(STRINGS ${BINARY}/build/lobeConfig.cmake found REGEX "^find_dependency\\(Eigen3 ${asked} NO_MODULE\\)")
  if(NOT found)
    message(FATAL_ERROR "built with Eigen ${version}, but lobeConfig.cmake does not ask for ${asked}")
  endif()
endforeach()
foreach(version IN ITEMS 3.3.9 6.0.0)
  configure(${version})
  if(status EQUAL 0 OR NOT output MATCHES "Eigen ${version} in ")
    message(FATAL_ERROR "Eigen ${version} is not refused by name:\n${output}")
  endif()
endforeach()
