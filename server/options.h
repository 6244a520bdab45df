// SPDX-License-Identifier: Apache-2.0
// What wellspring_server is told: its command line, over its configuration file.
#pragma once
#include <string>

#include "museum/museum.h"
#include "stream/stream.h"

namespace wellspring {

struct ServerOptions {
  std::string web = "web";  // folder of the pages
  std::string bench;        // report that /status shows; empty: none
  AccessRules access;       // show/http/access.h
  StreamSettings stream;
  MuseumSettings museum;
};

// The exit status with which the program ends at once, or -1: it goes on. What is wrong is on
// stderr. Takes WELLSPRING_ADMIN_TOKEN and WELLSPRING_KIOSK_TOKEN from the environment.
int read_options(ServerOptions& options, int argc, char** argv);

}  // namespace wellspring
