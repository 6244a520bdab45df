# SPDX-License-Identifier: Apache-2.0
# cmake --build --preset format   rewrites sources as .clang-format has them
# cmake --build --preset tidy     clang-tidy over all production code; what it finds is an error
# Clang reads no precompiled header of GCC, so both belong to a preset without any, whose compile
# database lies where editors look for it.
if(NOT WELLSPRING_PRECOMPILE)
  file(CREATE_LINK ${CMAKE_BINARY_DIR}/compile_commands.json
    ${PROJECT_SOURCE_DIR}/build/compile_commands.json SYMBOLIC RESULT ignored)
endif()
cmake_host_system_information(RESULT cores QUERY NUMBER_OF_LOGICAL_CORES)
find_program(CLANG_FORMAT clang-format)
find_program(CLANG_TIDY clang-tidy)
if(CLANG_FORMAT)
  execute_process(COMMAND ${CLANG_FORMAT} --version OUTPUT_VARIABLE version)
  add_custom_target(format VERBATIM WORKING_DIRECTORY ${PROJECT_SOURCE_DIR}
    COMMAND sh -c "git ls-files '*.h' '*.cpp' | xargs -P ${cores} -n 20 ${CLANG_FORMAT} -i")
  if(version MATCHES "version 14\\.")  # others break some lines otherwise
    add_test(NAME structure.format COMMAND sh -c
      "git ls-files '*.h' '*.cpp' | xargs -P ${cores} -n 20 ${CLANG_FORMAT} --dry-run --Werror"
      WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
    set_tests_properties(structure.format PROPERTIES LABELS structure)
  endif()
endif()
if(CLANG_TIDY)
  add_custom_target(tidy VERBATIM WORKING_DIRECTORY ${PROJECT_SOURCE_DIR}
    COMMAND sh -c "git ls-files 'server/*.cpp' 'avatar/*.cpp' 'kiosk/*.cpp' | xargs -P ${cores} -n 4 ${CLANG_TIDY} --quiet -p ${CMAKE_BINARY_DIR}")
endif()
