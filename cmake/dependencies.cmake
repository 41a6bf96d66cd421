# Every package comes from Debian; script/bootstrap installs them.
find_package(OpenCL REQUIRED)
find_package(OpenCLHeaders CONFIG REQUIRED)  # must precede OpenCLHeadersCpp
find_package(OpenCLHeadersCpp CONFIG REQUIRED)
# A range would find no Eigen 3.4: its version file takes none that ends beyond 3.
find_package(Eigen3 REQUIRED NO_MODULE)
if(Eigen3_VERSION VERSION_LESS 3.4 OR Eigen3_VERSION VERSION_GREATER_EQUAL 6)
  message(FATAL_ERROR "Eigen ${Eigen3_VERSION} in ${Eigen3_DIR}; expected 3.4 or 5, give Eigen3_DIR")
endif()
find_package(HDF5 1.10 REQUIRED COMPONENTS C HL)
find_package(fmt 9 REQUIRED)
find_package(NLopt 2.7 CONFIG REQUIRED)
find_package(nlohmann_json 3 REQUIRED)
find_package(nanoflann 1.4 CONFIG REQUIRED)
find_package(Threads REQUIRED)
find_package(ZLIB REQUIRED)
find_package(PNG 1.6 REQUIRED)
find_package(OpenEXR 3.1 CONFIG REQUIRED)
find_package(EXPAT 2.4 REQUIRED)
find_package(PkgConfig REQUIRED)
pkg_check_modules(HTTPLIB REQUIRED IMPORTED_TARGET cpp-httplib>=0.11)
find_package(OpenSSL REQUIRED)  # for cpp-httplib, whose headers call it from 0.18 on
target_link_libraries(PkgConfig::HTTPLIB INTERFACE OpenSSL::Crypto)
find_path(LIBZIP_INCLUDE_DIR zip.h REQUIRED)
find_library(LIBZIP_LIBRARY zip REQUIRED)  # its package for CMake asks for tools that Debian has elsewhere
find_path(CLP_INCLUDE_DIR coin/Clp_C_Interface.h REQUIRED)
find_library(CLP_LIBRARY Clp REQUIRED)  # it has no package for CMake
find_path(TOMLPLUSPLUS_INCLUDE_DIR toml++/toml.h REQUIRED)
# Drawn with in reports, which hold a copy of it.
find_file(LOBE_D3 d3.min.js PATHS /usr/share/nodejs/d3/dist NO_DEFAULT_PATH DOC "The JavaScript library D3, version 5")
find_file(LOBE_D3_LICENCE copyright PATHS /usr/share/doc/node-d3 NO_DEFAULT_PATH DOC "Its licence")
if(NOT LOBE_D3 OR NOT LOBE_D3_LICENCE)
  message(FATAL_ERROR "D3 is missing; install node-d3, or give LOBE_D3 (d3.min.js) and LOBE_D3_LICENCE")
endif()

# The command needs it if it is asked for. The tests try it wherever it is there.
if(LOBE_MPI)
  find_package(MPI REQUIRED COMPONENTS C)
elseif(LOBE_BUILD_TESTS)
  find_package(MPI QUIET COMPONENTS C)
endif()

# opencl.hpp changes with its macros, so they are set here and nowhere else. Debian's snapshot does not compile with
# MINIMUM 120 and a higher TARGET (CLHPP issue 108).
add_library(lobe_opencl INTERFACE)
target_compile_definitions(lobe_opencl INTERFACE CL_TARGET_OPENCL_VERSION=120 CL_HPP_TARGET_OPENCL_VERSION=120
                           CL_HPP_MINIMUM_OPENCL_VERSION=120 CL_HPP_ENABLE_EXCEPTIONS)
target_link_libraries(lobe_opencl INTERFACE OpenCL::HeadersCpp OpenCL::OpenCL)

add_library(lobe_toml INTERFACE)
target_include_directories(lobe_toml SYSTEM INTERFACE ${TOMLPLUSPLUS_INCLUDE_DIR})
