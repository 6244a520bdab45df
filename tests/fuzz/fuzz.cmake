# SPDX-License-Identifier: Apache-2.0
# wellspring_fuzz(NAME LAYER ...): fuzz_NAME.cpp gives bytes to a reader of these layers. With
# WELLSPRING_FUZZ each becomes a program of libFuzzer; without, all together become fuzz_replay.
set(fuzz_names)
set(fuzz_layers)
set(requests stream)  # the rules of requests, which know no sockets
if(WELLSPRING_FUZZ)
  add_custom_target(fuzz)
  # What is left out are coroutines, which Clang 14 cannot make of GCC's library.
  set_source_files_properties(kiosk/process/link.cpp PROPERTIES HEADER_FILE_ONLY ON)
  add_library(fuzz_requests STATIC EXCLUDE_FROM_ALL
    server/stream/address.cpp server/stream/certificate.cpp server/stream/reply.cpp
    server/stream/target.cpp)
  target_link_libraries(fuzz_requests PUBLIC wire boost_tls)
  set(requests fuzz_requests)
endif()
add_library(fuzz_stage STATIC EXCLUDE_FROM_ALL tests/unit/show/show_stage.cpp)  # plays browsers
target_link_libraries(fuzz_stage PUBLIC show GTest::gtest)
target_include_directories(fuzz_stage PRIVATE ${PROJECT_SOURCE_DIR}/tests)
target_compile_options(fuzz_stage PRIVATE ${WELLSPRING_LITTLE})
wellspring_precompile(fuzz_stage test)
function(wellspring_fuzz name)
  set(fuzz_names ${fuzz_names} ${name} PARENT_SCOPE)
  set(fuzz_layers ${fuzz_layers} ${ARGN} PARENT_SCOPE)
  if(WELLSPRING_FUZZ)
    add_executable(fuzz_${name} EXCLUDE_FROM_ALL tests/fuzz/fuzz_${name}.cpp tests/fuzz/entry.cpp)
    target_link_libraries(fuzz_${name} PRIVATE ${ARGN} GTest::gtest)
    target_link_options(fuzz_${name} PRIVATE -fsanitize=fuzzer)
    target_include_directories(fuzz_${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
    target_compile_definitions(fuzz_${name} PRIVATE
      WELLSPRING_FUZZ_TARGET=fuzz_${name} WELLSPRING_SOURCE="${PROJECT_SOURCE_DIR}")
    set_target_properties(fuzz_${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
    add_dependencies(fuzz fuzz_${name})
  endif()
endfunction()

wellspring_fuzz(browser_message wire)
wellspring_fuzz(observation wire)
wellspring_fuzz(eye_order wire)
wellspring_fuzz(packet wire)
wellspring_fuzz(sealed wire)
wellspring_fuzz(tokens wire)
wellspring_fuzz(server_config config)
wellspring_fuzz(http_head ${requests})
wellspring_fuzz(http_reply ${requests})
wellspring_fuzz(address ${requests})
wellspring_fuzz(frames ${requests})
wellspring_fuzz(certificate ${requests})
wellspring_fuzz(bvh avatar)
wellspring_fuzz(x3d_xml avatar)
wellspring_fuzz(x3d_classic avatar)
wellspring_fuzz(x3d_json avatar)
wellspring_fuzz(gltf_figure avatar)
wellspring_fuzz(recording avatar)
wellspring_fuzz(story avatar)
wellspring_fuzz(subtitles avatar)
wellspring_fuzz(speech_marks avatar)
wellspring_fuzz(speech_answer avatar)
wellspring_fuzz(kept_speech avatar)
wellspring_fuzz(recorded_marks avatar)
wellspring_fuzz(body_language avatar)
wellspring_fuzz(denoise_weights denoise)
wellspring_fuzz(sums_file ledger)
wellspring_fuzz(gltf_scene light)
wellspring_fuzz(picture world frame)
wellspring_fuzz(spectra_file spectrum)
wellspring_fuzz(dispersion spectrum)
wellspring_fuzz(geojson store)
wellspring_fuzz(painting store)
wellspring_fuzz(tile_folder store)
wellspring_fuzz(tiff_picture store)
wellspring_fuzz(bands store)
wellspring_fuzz(plain_picture store)
wellspring_fuzz(volume_file volume)
wellspring_fuzz(scan_file scan)
wellspring_fuzz(collection collection)
wellspring_fuzz(cached_map light)
wellspring_fuzz(cached_bake light)
wellspring_fuzz(exhibit show)
wellspring_fuzz(house_file show)
wellspring_fuzz(iiif_manifest show)
wellspring_fuzz(question show)
wellspring_fuzz(still_question show ${requests})
wellspring_fuzz(iiif_request show)
wellspring_fuzz(announcement show)
wellspring_fuzz(http_answer show ${requests})
wellspring_fuzz(visit fuzz_stage)
wellspring_fuzz(kept_visit fuzz_stage)
wellspring_fuzz(bench_report show)
wellspring_fuzz(gesture_file gesture)
wellspring_fuzz(kiosk_config kiosk boost_any)
wellspring_fuzz(station_tree kiosk)
wellspring_fuzz(kiosk_recording kiosk)
wellspring_fuzz(face_weights kiosk)
wellspring_fuzz(graph kiosk)

if(NOT WELLSPRING_FUZZ)
  set(declared "")
  set(rows "")
  set(fuzz_sources)
  foreach(name ${fuzz_names})
    string(APPEND declared "void fuzz_${name}(Bytes bytes);\n")
    string(APPEND rows "    {\"${name}\", fuzz_${name}},\n")
    list(APPEND fuzz_sources ${PROJECT_SOURCE_DIR}/tests/fuzz/fuzz_${name}.cpp)
  endforeach()
  file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/embedded/fuzz/targets.h @ONLY CONTENT
"// Made by tests/fuzz/fuzz.cmake.
#pragma once
#include \"fuzz/fuzz.h\"

namespace wellspring::fuzz {

@declared@
struct Target {
  const char* name;
  void (*run)(Bytes);
};
inline constexpr Target targets[] = {
@rows@};

}  // namespace wellspring::fuzz
")
  list(REMOVE_DUPLICATES fuzz_layers)
  add_executable(fuzz_make_seeds EXCLUDE_FROM_ALL tests/fuzz/make_seeds.cpp tests/unit/avatar/figures.cpp)
  target_link_libraries(fuzz_make_seeds PRIVATE avatar light frame ledger show GTest::gtest)
  target_include_directories(fuzz_make_seeds PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  set_target_properties(fuzz_make_seeds PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
  add_executable(fuzz_replay ${fuzz_sources} ${PROJECT_SOURCE_DIR}/tests/fuzz/replay_test.cpp)
  target_link_libraries(fuzz_replay PRIVATE ${fuzz_layers} GTest::gtest_main)
  target_include_directories(fuzz_replay PRIVATE ${PROJECT_SOURCE_DIR}/tests ${CMAKE_BINARY_DIR}/embedded)
  target_compile_options(fuzz_replay PRIVATE ${WELLSPRING_LITTLE})
  wellspring_precompile(fuzz_replay test)
  wellspring_together(fuzz_replay tests/fuzz)
  target_compile_definitions(fuzz_replay PRIVATE WELLSPRING_SOURCE="${PROJECT_SOURCE_DIR}")
  set_target_properties(fuzz_replay PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
  add_test(NAME unit.fuzz_replay COMMAND fuzz_replay --gtest_brief=1)
  set_tests_properties(unit.fuzz_replay PROPERTIES TIMEOUT 900 LABELS unit)
  wellspring_sanitizer_options(unit.fuzz_replay "")
endif()
