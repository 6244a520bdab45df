// SPDX-License-Identifier: Apache-2.0
// Reads the server's settings: its command line, over its configuration file.
#pragma once
#include <map>
#include <string>

#include "museum/museum.h"
#include "stream/stream.h"

namespace wellspring::program {

struct ServerOptions {
  std::string web;     // folder of the pages
  std::string bench;   // file of the report that /status shows; empty: none
  AccessRules access;  // show/http/access.h
  StreamSettings stream;
  MuseumSettings museum;
  std::string log, log_level = "info";          // file; empty: stderr. base/log.h
  std::map<std::string, std::string> settings;  // all options by key, as they were read
  int drain = 0;                                // seconds to go on serving after SIGTERM
};

// Returns the exit status with which the program ends at once, or -1: it goes on. Errors are
// printed on stderr. Takes WELLSPRING_ADMIN_TOKEN and WELLSPRING_KIOSK_TOKEN from the environment.
int read_options(ServerOptions& options, int argc, char** argv);

// Reads all options again. Sets the log's level to the new value; other changed options are named
// in the log, and need a restart. A wrong file changes nothing.
void reread_options(ServerOptions& options, int argc, char** argv);

}  // namespace wellspring::program
