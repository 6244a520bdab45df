# SPDX-License-Identifier: Apache-2.0
# What `--version` tells of headers that are compiled in: "NAME|version|package" each, as this build
# found them. Shared libraries are asked for when the program runs.
function(wellspring_built_with out)
  set(all)
  while(ARGN)
    list(POP_FRONT ARGN name version header)
    set(package)
    find_program(DPKG_QUERY dpkg-query)
    if(DPKG_QUERY)
      execute_process(COMMAND ${DPKG_QUERY} -S ${header} OUTPUT_VARIABLE owner ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
      string(REGEX REPLACE "[:,].*" "" package "${owner}")
      if(package)
        execute_process(COMMAND ${DPKG_QUERY} -W -f "\${Version}" ${package} OUTPUT_VARIABLE found ERROR_QUIET)
        if(found)
          set(version ${found})
        endif()
      endif()
    endif()
    list(APPEND all "${name}|${version}|${package}")
  endwhile()
  list(JOIN all "," all)
  set(${out} "${all}" PARENT_SCOPE)
endfunction()

wellspring_built_with(built_with
  Boost "${Boost_VERSION_STRING}" "*/boost/version.hpp"
  CLI11 "" "*/CLI/CLI.hpp"
  GLM "${glm_VERSION}" "*/include/glm/glm.hpp"
  nlohmann-json "${nlohmann_json_VERSION}" "*/nlohmann/json.hpp"
  stb "" "*/stb_image.h")
set_source_files_properties(server/about/version.cpp PROPERTIES COMPILE_DEFINITIONS
  "WELLSPRING_VERSION=\"${PROJECT_VERSION}\";WELLSPRING_BUILT_WITH=\"${built_with}\"")
