// SPDX-License-Identifier: Apache-2.0
// What wellspring_server is told: its command line, over its configuration file.
#pragma once
#include <map>
#include <string>

#include "museum/museum.h"
#include "stream/stream.h"

namespace wellspring::program {

struct ServerOptions {
  std::string web;     // folder of the pages
  std::string bench;   // report that /status shows; empty: none
  AccessRules access;  // show/http/access.h
  StreamSettings stream;
  MuseumSettings museum;
  std::string log, log_level = "info";          // file; empty: stderr. base/log.h
  std::map<std::string, std::string> settings;  // all of them by key, as they were read
  int drain = 0;                                // seconds that it goes on serving after SIGTERM
};

// The exit status with which the program ends at once, or -1: it goes on. What is wrong is on
// stderr. Takes WELLSPRING_ADMIN_TOKEN and WELLSPRING_KIOSK_TOKEN from the environment.
int read_options(ServerOptions& options, int argc, char** argv);

// Reads all of it again, and logs it. The level of the log is as it says now; what else has changed
// is named, and needs a restart. A wrong file changes nothing.
void reread_options(ServerOptions& options, int argc, char** argv);

}  // namespace wellspring::program
