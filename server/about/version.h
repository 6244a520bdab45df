// SPDX-License-Identifier: Apache-2.0
// Which version a program is, and what it is made of.
#pragma once
#include <initializer_list>
#include <string>
#include <vector>

namespace wellspring::about {

// What is compiled into a program, or loaded with it.
struct Component {
  std::string name;     // "Embree"
  std::string file;     // "libembree3.so.3"; empty: compiled in
  std::string version;  // as its package has it, else as its file or header has it; may be empty
  std::string package;  // Debian's; empty: it is of none
  std::string licence;  // SPDX expression; empty: unknown here, /usr/share/doc/PACKAGE/copyright
  std::string purpose;  // empty: another library needs it
};

// Of this process: its shared libraries as the loader lists them, and `compiled_in`, headers alone.
// Asks dpkg-query where there is one.
std::vector<Component> list_components(std::initializer_list<const char*> compiled_in);

// "NAME VERSION"; with `components` what it is made of, a line each, or as CycloneDX 1.5.
std::string describe_version(const std::string& program);
std::string describe_components(const std::string& program,
                                const std::vector<Component>& components);
std::string write_bill(const std::string& program, const std::vector<Component>& components);

// Where an argument is --version: prints it, with --verbose also what the program is made of, with
// --json that as CycloneDX; true, and the program is to end.
bool answer_version(int argc, char** argv,
                    std::initializer_list<const char*> compiled_in = {"CLI11", "GLM",
                                                                      "nlohmann-json", "stb"});

}  // namespace wellspring::about
