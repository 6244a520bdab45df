# SPDX-License-Identifier: Apache-2.0
# tests/unit mirrors the tree: every folder of tests there becomes one program, unit_<folder>,
# linked to the layer of that name.
enable_testing()
include(GoogleTest)
set(WELLSPRING_DATA "${PROJECT_SOURCE_DIR}/../shared/data" CACHE PATH "real files for the corpus tests; they are skipped without it")

function(wellspring_unit_test folder)
  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tests/unit/${folder}/*.cpp)
  if(NOT sources)
    return()
  endif()
  add_executable(unit_${folder} ${sources})
  target_link_libraries(unit_${folder} PRIVATE ${ARGN} GTest::gtest_main)
  target_include_directories(unit_${folder} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  target_compile_definitions(unit_${folder} PRIVATE
    WELLSPRING_SOURCE="${PROJECT_SOURCE_DIR}" WELLSPRING_DATA="${WELLSPRING_DATA}")
  set_target_properties(unit_${folder} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
  gtest_discover_tests(unit_${folder} DISCOVERY_TIMEOUT 60 PROPERTIES TIMEOUT 300 LABELS unit)
endfunction()

wellspring_unit_test(base   base)
wellspring_unit_test(wire   wire)
wellspring_unit_test(frame  frame)
wellspring_unit_test(world  world)
wellspring_unit_test(light  light frame)
wellspring_unit_test(cache  cache)
wellspring_unit_test(avatar avatar)
wellspring_unit_test(show   show)
wellspring_unit_test(stream stream boost_any)
wellspring_unit_test(kiosk  kiosk)
