// SPDX-License-Identifier: Apache-2.0
// Reads a program's configuration file. Every option of its command line is a key of the file:
//   # a comment stands on a line of its own
//   port = 8080
// The key is the option's long name without dashes, the value is the rest of the line without
// spaces around it. Switches take true or false. A key stands once, except for options that take a
// list, which has a line for each of its values. The command line wins over the environment, and
// this over the file.
#pragma once
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace wellspring::config {

// Holds all that is wrong with a file: "FILE: line N: what".
struct ConfigError : std::runtime_error {
  explicit ConfigError(std::vector<std::string> problems);
  std::vector<std::string> problems;
};

// Adds --config and --print-config. `standard`: the file that is read if --config names none and
// this file exists; "": none.
void add_config(CLI::App& app, const std::string& standard);

// Adds a switch that shows its default: names as CLI::App::add_flag takes them, "--x,!--no-x".
CLI::Option* add_switch(CLI::App& app, const std::string& names, bool& value,
                        const std::string& what);

// Reads the command line, then the file, which also checks the values that do not win.
// --print-config writes to stdout and throws CLI::Success. Throws CLI::ParseError for a wrong
// command line, ConfigError for a wrong file.
void parse_with_config(CLI::App& app, int argc, char** argv);

// Writes all options as such a file, with what they are for. Options that nobody has set are
// comments with their defaults. `app` has been parsed.
std::string write_config(const CLI::App& app);

// Returns the value of every key, those of a list on lines of their own. `app` has been parsed.
std::map<std::string, std::string> config_values(const CLI::App& app);

}  // namespace wellspring::config
