// SPDX-License-Identifier: Apache-2.0
// What wellspring_server is told: its command line, over its configuration file.
#pragma once
#include <string>

#include "museum/museum.h"
#include "stream/stream.h"

namespace wellspring {

struct ServerOptions {
  std::string web = "web";  // folder of the pages
  std::string admin_token;  // of those who may announce; empty: nobody may
  std::string bench;        // report that /status shows; empty: none
  StreamSettings stream;
  MuseumSettings museum;
  int drain = 0;  // seconds that it goes on serving after SIGTERM
};

// The exit status with which the program ends at once, or -1: it goes on. What is wrong is on
// stderr. Takes WELLSPRING_ADMIN_TOKEN from the environment.
int read_options(ServerOptions& options, int argc, char** argv);

}  // namespace wellspring
