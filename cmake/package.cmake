# SPDX-License-Identifier: Apache-2.0
# cmake --install BUILD [--prefix P] [--component server|kiosk] [--strip]   DESTDIR is kept
# cpack -B FOLDER (or ./wellspring package)   two Debian packages: wellspring, wellspring-kiosk
# Texts that name places are written when they are installed, since only then the prefix is known.
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME server)
set(CMAKE_SKIP_INSTALL_ALL_DEPENDENCY ON)  # packing builds nothing: not the tests, above all
set(server_programs wellspring_server wellspring_voice wellspring_render wellspring_avatar
  wellspring_clip wellspring_speak wellspring_check wellspring_new wellspring_import wellspring_bake
  wellspring_nebula wellspring_worker wellspring_jobs wellspring_plan wellspring_compare wellspring_lamps)
install(TARGETS ${server_programs} DESTINATION libexec/wellspring COMPONENT server)
install(TARGETS wellspring_kiosk wellspring_station DESTINATION libexec/wellspring COMPONENT kiosk)
install(PROGRAMS deploy/wellspring.sh DESTINATION bin RENAME wellspring)
install(PROGRAMS deploy/kiosk.sh DESTINATION libexec/wellspring COMPONENT kiosk)
install(DIRECTORY web DESTINATION share/wellspring)
install(DIRECTORY content/ DESTINATION share/wellspring/content)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/build/weights DESTINATION share/wellspring OPTIONAL
  PATTERN face EXCLUDE PATTERN human EXCLUDE PATTERN "*.part" EXCLUDE)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/build/weights/face ${PROJECT_SOURCE_DIR}/build/weights/human
  DESTINATION share/wellspring/weights COMPONENT kiosk OPTIONAL)
install(FILES deploy/nginx.conf deploy/haproxy.cfg docs/operation.md docs/kiosk.md docs/stories.md README.md CHANGELOG.md
  DESTINATION share/doc/wellspring)
install(FILES docs/deploy.md docs/nodes.md docs/workers.md DESTINATION share/doc/wellspring)
install(FILES deploy/haproxy-nodes.cfg deploy/nats.conf deploy/server.conf deploy/worker.conf
  DESTINATION share/doc/wellspring/museum)
install(PROGRAMS deploy/secrets.sh DESTINATION share/doc/wellspring/museum)
install(DIRECTORY deploy/systemd/nats-server.service.d deploy/systemd/haproxy.service.d
  DESTINATION share/doc/wellspring/museum)
install(FILES LICENSE DESTINATION share/doc/wellspring RENAME copyright)
install(FILES LICENSE DESTINATION share/doc/wellspring-kiosk RENAME copyright COMPONENT kiosk)

# As installed_config() of server/base/host.h has it.
set(places [[
  set(prefix "${CMAKE_INSTALL_PREFIX}")
  if(prefix MATCHES "^(.*)/usr$")
    set(etc "${CMAKE_MATCH_1}/etc")
  else()
    set(etc "${prefix}/etc")
  endif()
  set(libexec "${prefix}/libexec/wellspring")
  set(share "${prefix}/share/wellspring")
  set(docs "${prefix}/share/doc/wellspring")
  set(settings "${etc}/wellspring")
]])
# wellspring_install_text(COMPONENT FILE PLACE): with @prefix@, @libexec@ ... filled in.
function(wellspring_install_text component file place)
  install(CODE "${places}
  configure_file(\"${PROJECT_SOURCE_DIR}/${file}\" \"\$ENV{DESTDIR}${place}\" @ONLY)
  message(STATUS \"Installing: \$ENV{DESTDIR}${place}\")" COMPONENT ${component})
endfunction()
wellspring_install_text(server deploy/systemd/wellspring-server.service.in
  "\${prefix}/lib/systemd/system/wellspring-server.service")
wellspring_install_text(server deploy/systemd/wellspring-worker.service.in
  "\${prefix}/lib/systemd/system/wellspring-worker.service")
wellspring_install_text(kiosk deploy/systemd/wellspring-kiosk.service.in
  "\${prefix}/lib/systemd/system/wellspring-kiosk.service")
wellspring_install_text(kiosk deploy/systemd/wellspring-screen.service.in
  "\${prefix}/lib/systemd/user/wellspring-screen.service")

# What an operator changes is never written over. The server's example is what it prints itself.
function(wellspring_install_settings component place command)
  install(CODE "${places}
  set(place \"\$ENV{DESTDIR}${place}\")
  if(EXISTS \"\${place}\")
    message(STATUS \"Kept: \${place}\")
  else()
    cmake_path(GET place PARENT_PATH folder)
    file(MAKE_DIRECTORY \"\${folder}\")
    execute_process(COMMAND ${command} OUTPUT_FILE \"\${place}\" COMMAND_ERROR_IS_FATAL ANY)
    message(STATUS \"Installing: \${place}\")
  endif()" COMPONENT ${component})
endfunction()
wellspring_install_settings(server "\${settings}/server.conf"
  "\"${CMAKE_COMMAND}\" -E env --unset=WELLSPRING_WEIGHTS --unset=WELLSPRING_LOG
    \"${CMAKE_BINARY_DIR}/bin/wellspring_server\" --content /var/lib/wellspring/exhibits
    --cache /var/cache/wellspring --sums /var/lib/wellspring/sums.sqlite --print-config")
wellspring_install_settings(server "\${settings}/worker.conf"
  "\"${CMAKE_COMMAND}\" -E env \"${CMAKE_BINARY_DIR}/bin/wellspring_worker\"
    --content /var/lib/wellspring/exhibits --cache /var/cache/wellspring/worker --print-config")
wellspring_install_settings(server "\${etc}/logrotate.d/wellspring"
  "\"${CMAKE_COMMAND}\" -E cat \"${PROJECT_SOURCE_DIR}/deploy/logrotate\"")
wellspring_install_settings(kiosk "\${settings}/kiosk.json"
  "\"${CMAKE_COMMAND}\" -E cat \"${PROJECT_SOURCE_DIR}/deploy/kiosk.json\"")

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "Wellspring <root@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "ray-traced virtual museums for browsers")
set(CPACK_SET_DESTDIR ON)
set(CPACK_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL server kiosk)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE zstd)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_SERVER_PACKAGE_NAME wellspring)
set(CPACK_DEBIAN_SERVER_PACKAGE_DEPENDS "adduser, ca-certificates, init-system-helpers")
set(CPACK_DEBIAN_SERVER_PACKAGE_RECOMMENDS "libvips-tools, dcm2niix, fonts-dejavu-core, fonts-urw-base35")
set(CPACK_DEBIAN_SERVER_DESCRIPTION
  "Serves virtual museums to browsers, ray-traced for every visitor, with a storyteller.")
set(CPACK_DEBIAN_KIOSK_PACKAGE_NAME wellspring-kiosk)
set(CPACK_DEBIAN_KIOSK_PACKAGE_DEPENDS "init-system-helpers")
set(CPACK_DEBIAN_KIOSK_PACKAGE_RECOMMENDS "opencv-data, chromium")
set(CPACK_DEBIAN_KIOSK_DESCRIPTION
  "Watches a camera before a museum's screen, and tells the server who stands there.")
foreach(package server kiosk)
  set(unit wellspring-${package})
  set(arch ${WELLSPRING_ARCH})
  foreach(script preinst postinst prerm postrm)
    configure_file(deploy/debian/${script}.in ${CMAKE_BINARY_DIR}/debian/${package}/${script}
      @ONLY FILE_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE
      WORLD_READ WORLD_EXECUTE)
    string(TOUPPER ${package} PACKAGE)
    list(APPEND CPACK_DEBIAN_${PACKAGE}_PACKAGE_CONTROL_EXTRA
      ${CMAKE_BINARY_DIR}/debian/${package}/${script})
  endforeach()
  list(APPEND CPACK_DEBIAN_${PACKAGE}_PACKAGE_CONTROL_EXTRA
    ${CMAKE_BINARY_DIR}/debian/${package}/conffiles)
endforeach()
file(WRITE ${CMAKE_BINARY_DIR}/debian/server/conffiles
  "/etc/wellspring/server.conf\n/etc/wellspring/worker.conf\n/etc/logrotate.d/wellspring\n")
file(WRITE ${CMAKE_BINARY_DIR}/debian/kiosk/conffiles "/etc/wellspring/kiosk.json\n")
include(CPack)
