# Installation and the CMake package that find_package(lobe) finds.
include(CMakePackageConfigHelpers)

# Matrices cross the library's border: programs have to allocate and free them as it does, with whatever instruction set
# they are compiled for. 16 is what Eigen takes without AVX.
target_compile_definitions(lobe PUBLIC EIGEN_MAX_ALIGN_BYTES=16)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/lobe)

install(TARGETS lobe EXPORT lobeTargets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
        RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/lib/include/lobe TYPE INCLUDE)
install(FILES ${PROJECT_BINARY_DIR}/lib/include/lobe/version.hpp DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/lobe)

# The command finds the library beside itself wherever the tree is moved to.
file(RELATIVE_PATH lib_from_bin ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_LIBDIR})
set_target_properties(lobe_command PROPERTIES INSTALL_RPATH $ORIGIN/${lib_from_bin})
install(TARGETS lobe_command RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})

install(DIRECTORY ${PROJECT_SOURCE_DIR}/studies/ DESTINATION ${CMAKE_INSTALL_DATADIR}/lobe/studies
        FILES_MATCHING PATTERN "*.toml")
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/CHANGELOG.md TYPE DOC)

install(EXPORT lobeTargets NAMESPACE lobe:: DESTINATION ${package_dir})
get_target_property(lobe_library_type lobe TYPE)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/lobeConfig.cmake.in ${PROJECT_BINARY_DIR}/lobeConfig.cmake
                              INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/lobeConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/lobeConfig.cmake ${PROJECT_BINARY_DIR}/lobeConfigVersion.cmake
        DESTINATION ${package_dir})
