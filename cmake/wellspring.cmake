# SPDX-License-Identifier: Apache-2.0
# Compiler settings, packages, and the two words CMakeLists.txt is written in:
# wellspring_layer(NAME FOLDER [TOGETHER] [EXCEPT PART] LINKS ...)  a static library of every .cpp below
#   FOLDER but main*.cpp and what has PART in its path; TOGETHER: see wellspring_together
# wellspring_program(NAME FILES LINKS ...)  an executable of one main file, or of all that match

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()
set(CMAKE_CXX_FLAGS_RELEASE "-O3 -DNDEBUG")
set(WELLSPRING_ARCH "x86-64-v3" CACHE STRING "-march of the build; empty for the compiler's default")
find_program(MOLD mold)
if(MOLD)
  add_link_options(-fuse-ld=mold)
endif()
find_program(CCACHE ccache)
if(CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE})
endif()

add_compile_options(-Wall -Wextra -Wno-unused-parameter -fno-math-errno -pthread)
if(WELLSPRING_ARCH AND CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  add_compile_options(-march=${WELLSPRING_ARCH})
endif()
option(WELLSPRING_FUZZ "programs that look for bytes which break a reader (Clang's libFuzzer)" OFF)
if(WELLSPRING_FUZZ)
  set(WELLSPRING_SANITIZE address,undefined,float-cast-overflow)
  add_compile_options(-fsanitize=fuzzer-no-link,${WELLSPRING_SANITIZE} -fno-sanitize-recover=all
    -fno-omit-frame-pointer -gline-tables-only)
  add_link_options(-fsanitize=${WELLSPRING_SANITIZE})
elseif(WELLSPRING_SANITIZE)
  add_compile_options(-fsanitize=${WELLSPRING_SANITIZE} -fno-sanitize-recover=all
    -fno-omit-frame-pointer -g1 $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)  # false, then
  add_link_options(-fsanitize=${WELLSPRING_SANITIZE})
endif()

find_package(Threads REQUIRED)
find_package(TBB REQUIRED)
find_package(spdlog REQUIRED)
find_package(fmt REQUIRED)
find_package(glm REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(PkgConfig REQUIRED)
pkg_check_modules(OPENEXR REQUIRED IMPORTED_TARGET OpenEXR)
find_package(TIFF REQUIRED)
pkg_check_modules(LCMS REQUIRED IMPORTED_TARGET lcms2)
pkg_check_modules(CAIRO REQUIRED IMPORTED_TARGET cairo)
find_package(ZLIB REQUIRED)
find_package(GTest REQUIRED)
find_package(Boost REQUIRED)
find_package(pugixml QUIET)
pkg_check_modules(QRCODE REQUIRED IMPORTED_TARGET qrcodegencpp)
pkg_check_modules(ZXING REQUIRED IMPORTED_TARGET zxing)
pkg_check_modules(UTF8PROC REQUIRED IMPORTED_TARGET libutf8proc)
pkg_check_modules(YAML REQUIRED IMPORTED_TARGET yaml-cpp)
pkg_check_modules(SODIUM REQUIRED IMPORTED_TARGET libsodium)
pkg_check_modules(NATS REQUIRED IMPORTED_TARGET libnats)
pkg_check_modules(SNDFILE REQUIRED IMPORTED_TARGET sndfile)
pkg_check_modules(ESPEAK_NG REQUIRED IMPORTED_TARGET espeak-ng)  # wellspring_voice alone: GPL-3+

# Embree 4 where there is one, else 3; server/world/embree.h hides the difference.
find_package(embree 4 QUIET)
if(NOT embree_FOUND)
  find_package(embree 3 REQUIRED)
endif()
add_library(embree_any INTERFACE)
target_link_libraries(embree_any INTERFACE embree)
message(STATUS "Embree ${embree_VERSION}")

find_package(PNG REQUIRED)
find_library(MESHOPT meshoptimizer REQUIRED)
add_library(meshopt_any INTERFACE)
target_link_libraries(meshopt_any INTERFACE ${MESHOPT})
find_library(DRACO NAMES libdraco.so draco REQUIRED)
add_library(draco_any INTERFACE)
target_link_libraries(draco_any INTERFACE ${DRACO})
pkg_check_modules(WEBP REQUIRED IMPORTED_TARGET libwebp)
pkg_check_modules(ZSTD REQUIRED IMPORTED_TARGET libzstd)
find_library(TURBOJPEG turbojpeg REQUIRED)
add_library(turbojpeg INTERFACE)
target_link_libraries(turbojpeg INTERFACE ${TURBOJPEG})

# oneDNN 2 or 3, by name: its CMake files ask for OpenCL. Its threads are OpenMP's, of which denoise
# asks for one a call.
find_library(DNNL dnnl REQUIRED)
add_library(dnnl_any INTERFACE)
target_link_libraries(dnnl_any INTERFACE ${DNNL} gomp)

find_library(PUGIXML pugixml REQUIRED)
add_library(pugixml_any INTERFACE)
target_link_libraries(pugixml_any INTERFACE ${PUGIXML})

find_path(SQLITE_INCLUDE sqlite3.h REQUIRED)
find_library(SQLITE sqlite3 REQUIRED)
add_library(sqlite_any INTERFACE)
target_include_directories(sqlite_any SYSTEM INTERFACE ${SQLITE_INCLUDE})
target_link_libraries(sqlite_any INTERFACE ${SQLITE})

find_path(STB_INCLUDE stb_image.h PATH_SUFFIXES stb REQUIRED)

find_path(CLI11_INCLUDE CLI/CLI.hpp REQUIRED)
add_library(cli11_any INTERFACE)
target_include_directories(cli11_any SYSTEM INTERFACE ${CLI11_INCLUDE})

# Asio and Beast: their parts that are no templates are compiled once, here.
file(GENERATE OUTPUT ${CMAKE_BINARY_DIR}/boost_any.cpp CONTENT
  "#include <boost/asio/impl/src.hpp>\n#include <boost/beast/src.hpp>\n")
add_library(boost_any STATIC EXCLUDE_FROM_ALL ${CMAKE_BINARY_DIR}/boost_any.cpp)
target_include_directories(boost_any SYSTEM PUBLIC ${Boost_INCLUDE_DIRS})
target_link_libraries(boost_any PUBLIC Threads::Threads)
target_compile_definitions(boost_any PUBLIC BOOST_ASIO_SEPARATE_COMPILATION BOOST_BEAST_SEPARATE_COMPILATION)
if(WELLSPRING_SANITIZE MATCHES thread)  # it does not know memory fences, Asio does without
  target_compile_definitions(boost_any PUBLIC BOOST_ASIO_DISABLE_FENCED_BLOCK)
endif()

# Asio's TLS likewise, by OpenSSL.
find_package(OpenSSL REQUIRED)
file(GENERATE OUTPUT ${CMAKE_BINARY_DIR}/boost_tls.cpp CONTENT "#include <boost/asio/ssl/impl/src.hpp>\n")
add_library(boost_tls STATIC EXCLUDE_FROM_ALL ${CMAKE_BINARY_DIR}/boost_tls.cpp)
target_link_libraries(boost_tls PUBLIC boost_any OpenSSL::SSL)

pkg_check_modules(SECCOMP REQUIRED IMPORTED_TARGET libseccomp)

# Headers and libraries by name: OpenCV's own CMake files come only with the whole libopencv-dev.
find_path(OPENCV_INCLUDE opencv2/core.hpp PATH_SUFFIXES opencv4 REQUIRED)
add_library(opencv_any INTERFACE)
target_include_directories(opencv_any SYSTEM INTERFACE ${OPENCV_INCLUDE})
foreach(module core imgproc imgcodecs videoio objdetect video calib3d features2d dnn)
  find_library(OPENCV_${module} opencv_${module} REQUIRED)
  target_link_libraries(opencv_any INTERFACE ${OPENCV_${module}})
endforeach()

# Another opinion on landmarks, for a measurement; where it is not installed that one is left out.
find_path(DLIB_INCLUDE dlib/image_processing.h)
find_library(DLIB dlib)
find_library(DLIB_BLAS NAMES blas libblas.so.3)
find_library(DLIB_LAPACK NAMES lapack liblapack.so.3)
add_library(dlib_any INTERFACE)
if(DLIB_INCLUDE AND DLIB AND DLIB_BLAS AND DLIB_LAPACK)
  target_include_directories(dlib_any SYSTEM INTERFACE ${DLIB_INCLUDE})
  target_link_libraries(dlib_any INTERFACE ${DLIB} ${DLIB_LAPACK} ${DLIB_BLAS})
  target_compile_definitions(dlib_any INTERFACE WELLSPRING_DLIB)
endif()

# Image reads .hdr pictures through stb: headers, not part of a layer's interface.
include_directories(SYSTEM ${STB_INCLUDE})
include_directories(${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/server)

# Half the time to compile, but the same products and sums in one rounding (fused multiply-add).
set(WELLSPRING_LITTLE -O1 $<$<CXX_COMPILER_ID:GNU>:-fexpensive-optimizations>)
# Headers that nearly every file reads are compiled once: for all layers, and with GoogleTest for
# tests. Without them (WELLSPRING_PRECOMPILE=OFF) everything compiles as well, only slower. JSON is
# not among them: reading what was compiled of it takes longer than most files that do without.
option(WELLSPRING_PRECOMPILE "precompiled headers" ON)
set(WELLSPRING_HEADERS <algorithm> <array> <cmath> <cstdint> <cstring> <filesystem> <fstream> <functional>
  <limits> <map> <memory> <optional> <span> <sstream> <string> <string_view> <vector>
  <oneapi/tbb/parallel_for.h> ${PROJECT_SOURCE_DIR}/server/base/vec.h)
function(wellspring_precompiled name)
  add_library(precompiled_${name} OBJECT ${PROJECT_SOURCE_DIR}/cmake/precompiled.cpp)
  target_link_libraries(precompiled_${name} PRIVATE glm::glm TBB::tbb)
  target_precompile_headers(precompiled_${name} PRIVATE ${WELLSPRING_HEADERS} ${ARGN})
endfunction()
if(WELLSPRING_PRECOMPILE)
  wellspring_precompiled(std)
  wellspring_precompiled(test <gtest/gtest.h>)
  target_link_libraries(precompiled_test PRIVATE GTest::gtest)
  target_compile_options(precompiled_test PRIVATE ${WELLSPRING_LITTLE})
endif()
function(wellspring_precompile target name)
  if(WELLSPRING_PRECOMPILE)
    target_precompile_headers(${target} REUSE_FROM precompiled_${name})
  endif()
endfunction()

# wellspring_load_once(PATTERN ...): these files read what is read once, and write messages. Comes
# before the layers and programs that they belong to.
macro(wellspring_load_once)
  file(GLOB WELLSPRING_LOAD_ONCE CONFIGURE_DEPENDS ${ARGN})
endmacro()

# wellspring_together(TARGET FOLDER): up to eight files of a room are compiled as one, since most of
# their time goes into the same headers. Their names in anonymous namespaces have to differ.
# WELLSPRING_UNITY=OFF compiles each file alone.
option(WELLSPRING_UNITY "files of a room are compiled together" ON)
function(wellspring_together target folder)
  get_target_property(sources ${target} SOURCES)
  if(NOT sources)
    return()
  endif()
  set(rooms)
  foreach(file ${sources})
    file(RELATIVE_PATH path ${PROJECT_SOURCE_DIR}/${folder} ${file})
    string(REGEX MATCH "^[^/]*/" room ${path})
    string(MAKE_C_IDENTIFIER "room_${room}" room)
    list(APPEND rooms ${room})
    list(APPEND ${room} ${file})
  endforeach()
  list(REMOVE_DUPLICATES rooms)
  foreach(room ${rooms})
    list(LENGTH ${room} size)
    math(EXPR each "(${size} + (${size} + 7) / 8 - 1) / ((${size} + 7) / 8)")  # parts of one size
    set(index 0)
    foreach(file ${${room}})
      math(EXPR part "${index} / ${each}")
      math(EXPR index "${index} + 1")
      set_property(SOURCE ${file} PROPERTY UNITY_GROUP ${room}${part})
    endforeach()
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${WELLSPRING_UNITY} UNITY_BUILD_MODE GROUP)
endfunction()

function(wellspring_layer name folder)
  cmake_parse_arguments(ARG "TOGETHER" "EXCEPT" "LINKS" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${folder}/*.cpp)
  if(ARG_EXCEPT)
    list(FILTER sources EXCLUDE REGEX "${ARG_EXCEPT}")
  endif()
  list(FILTER sources EXCLUDE REGEX "/main[^/]*\\.cpp$")
  set(once ${sources})
  list(REMOVE_ITEM sources ${WELLSPRING_LOAD_ONCE})
  list(REMOVE_ITEM once ${sources})
  add_library(${name} STATIC ${sources})
  set_target_properties(${name} PROPERTIES LINKER_LANGUAGE CXX)
  set(parts ${name})
  if(once)
    add_library(${name}_once OBJECT ${once})
    target_compile_options(${name}_once PRIVATE ${WELLSPRING_LITTLE})
    list(APPEND parts ${name}_once)
  endif()
  foreach(part ${parts})
    target_link_libraries(${part} PUBLIC ${ARG_LINKS})
    wellspring_precompile(${part} std)
    if(ARG_TOGETHER)
      wellspring_together(${part} ${folder})
    endif()
  endforeach()
  if(once)
    target_sources(${name} PRIVATE $<TARGET_OBJECTS:${name}_once>)
  endif()
endfunction()

function(wellspring_program name files)
  cmake_parse_arguments(ARG "MEASURES" "" "LINKS" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${files})
  if(sources)
    add_executable(${name} ${sources})
    set(once ${sources})
    list(REMOVE_ITEM sources ${WELLSPRING_LOAD_ONCE})
    list(REMOVE_ITEM once ${sources})
    set_property(SOURCE ${once} PROPERTY COMPILE_OPTIONS ${WELLSPRING_LITTLE})
    target_link_libraries(${name} PRIVATE ${ARG_LINKS} about)
    wellspring_precompile(${name} std)
    if(ARG_MEASURES)
      target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
    endif()
    set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
  endif()
endfunction()

# wellspring_embed(LAYER TEMPLATE TEXT_FILES...): compiles text files into a layer. The template has
# @TEXT_0@, @TEXT_1@, ... where their contents belong.
function(wellspring_embed layer template)
  set(index 0)
  foreach(file ${ARGN})
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${file})
    file(READ ${PROJECT_SOURCE_DIR}/${file} TEXT_${index})
    math(EXPR index "${index} + 1")
  endforeach()
  get_filename_component(name ${template} NAME_WLE)
  configure_file(${PROJECT_SOURCE_DIR}/${template} ${CMAKE_BINARY_DIR}/embedded/${name} @ONLY)
  target_sources(${layer} PRIVATE ${CMAKE_BINARY_DIR}/embedded/${name})
endfunction()

# Gives a layer the number of the program's sources (program_number.cmake).
function(wellspring_number_sources layer)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/server/*.h ${PROJECT_SOURCE_DIR}/server/*.cpp)
  set(script ${PROJECT_SOURCE_DIR}/cmake/program_number.cmake)
  set(out ${CMAKE_BINARY_DIR}/embedded/program_number.cpp)
  add_custom_command(OUTPUT ${out} DEPENDS ${sources} ${script} VERBATIM COMMAND ${CMAKE_COMMAND} -D OUT=${out}
    -D ROOT=${PROJECT_SOURCE_DIR} -D "COMPILER=${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}" -P ${script})
  target_sources(${layer} PRIVATE ${out})
endfunction()
