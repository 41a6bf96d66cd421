# Installation, the CMake package that find_package(lobe) finds, and the Debian packages that `cpack` makes of both:
# component `command` (lobe: command, library, studies) and component `development` (liblobe-dev: headers, examples).
include(CMakePackageConfigHelpers)

# Matrices cross the library's border: programs have to allocate and free them as it does, with whatever instruction set
# they are compiled for. 16 is what Eigen takes without AVX.
target_compile_definitions(lobe PUBLIC EIGEN_MAX_ALIGN_BYTES=16)
# And by the same Eigen: Debian's 5 frees only what it allocated, 3.4 leaves that to malloc().
if(Eigen3_VERSION VERSION_LESS 5)
  set(lobe_eigen 3.4)
  set(lobe_eigen_end 5)
else()
  set(lobe_eigen 5)
  set(lobe_eigen_end 6)
endif()

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/lobe)

install(TARGETS lobe EXPORT lobeTargets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT command NAMELINK_COMPONENT development
        RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT command
        INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/lib/include/lobe TYPE INCLUDE COMPONENT development)
install(FILES ${PROJECT_BINARY_DIR}/lib/include/lobe/core/version.hpp DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/lobe/core
        COMPONENT development)

# The command finds the library beside itself wherever the tree is moved to.
file(RELATIVE_PATH lib_from_bin ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_LIBDIR})
set_target_properties(lobe_command PROPERTIES INSTALL_RPATH $ORIGIN/${lib_from_bin})
install(TARGETS lobe_command RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT command)
# Whoever builds the target lobe_command alone has no manual pages, and no schema of studies.
install(DIRECTORY ${PROJECT_BINARY_DIR}/share/man/ DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT command OPTIONAL)
set(completions ${PROJECT_SOURCE_DIR}/python-free-cli/completions)
install(FILES ${completions}/lobe.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME lobe
        COMPONENT command)
install(FILES ${completions}/_lobe DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions COMPONENT command)
install(FILES ${completions}/lobe.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d
        COMPONENT command)

install(DIRECTORY ${PROJECT_SOURCE_DIR}/studies/ DESTINATION ${CMAKE_INSTALL_DATADIR}/lobe/studies COMPONENT command
        FILES_MATCHING PATTERN "*.toml")
install(DIRECTORY ${PROJECT_BINARY_DIR}/share/lobe/studies/ DESTINATION ${CMAKE_INSTALL_DATADIR}/lobe/studies
        COMPONENT command OPTIONAL)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/CHANGELOG.md TYPE DOC COMPONENT command)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/examples DESTINATION ${CMAKE_INSTALL_DATADIR}/lobe COMPONENT development)

install(EXPORT lobeTargets NAMESPACE lobe:: DESTINATION ${package_dir} COMPONENT development)
get_target_property(lobe_library_type lobe TYPE)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/lobeConfig.cmake.in ${PROJECT_BINARY_DIR}/lobeConfig.cmake
                              INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/lobeConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/lobeConfig.cmake ${PROJECT_BINARY_DIR}/lobeConfigVersion.cmake
        DESTINATION ${package_dir} COMPONENT development)

# `cpack --config build/CPackConfig.cmake`
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGE_CONTACT "the authors of lobe <lobe@localhost>")
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL command development)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_COMMAND_PACKAGE_NAME lobe)
set(CPACK_DEBIAN_COMMAND_PACKAGE_DEPENDS "pocl-opencl-icd | opencl-icd")
set(CPACK_DEBIAN_COMMAND_PACKAGE_RECOMMENDS gnuplot-nox)
set(CPACK_COMPONENT_COMMAND_DESCRIPTION "${PROJECT_DESCRIPTION}")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME liblobe-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "lobe (= ${PROJECT_VERSION}), libeigen3-dev (>= ${lobe_eigen}), \
libeigen3-dev (<< ${lobe_eigen_end}~)")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SHLIBDEPS OFF)
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "${PROJECT_DESCRIPTION} (headers and examples)")
include(CPack)
