// SPDX-License-Identifier: Apache-2.0
// Feeds a program's configuration file. Accepted files can be written, and are read back.
#include <CLI/CLI.hpp>

#include "config/config_file.h"
#include "fuzz/fuzz.h"

namespace wellspring::fuzz {
namespace {

// False: refused, saying why. `written`: the options as they were read, as such a file.
bool read(const std::string& file, std::string& written) {
  CLI::App app;
  int port = 8080;
  double rate = 30;
  bool quiet = false;
  std::string name;
  std::vector<std::string> hosts;
  app.add_option("--port", port)->check(CLI::Range(1, 65535));
  app.add_option("--rate", rate);
  app.add_option("--name", name);
  app.add_option("--hosts", hosts);
  add_switch(app, "--quiet,!--loud", quiet, "says less");
  add_config(app, "");
  std::string words[] = {"fuzz", "--config", file};
  char* arguments[] = {words[0].data(), words[1].data(), words[2].data()};
  try {
    parse_with_config(app, 3, arguments);
  } catch (const ConfigError& error) {
    require(!error.problems.empty(), "a refusal says why");
    return false;
  }
  require(port >= 1 && port <= 65535, "values are checked");
  written = write_config(app);
  return true;
}

}  // namespace

void fuzz_server_config(Bytes bytes) {
  std::string written;
  if (!read(write_file("fuzz.conf", bytes), written)) return;
  const auto* begin = reinterpret_cast<const uint8_t*>(written.data());
  require(read(write_file("fuzz.conf", {begin, written.size()}), written), "it is read back");
}

}  // namespace wellspring::fuzz
