// SPDX-License-Identifier: Apache-2.0
#include "about/version.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <link.h>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

namespace wellspring::about {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// Returns whether the name or path has only characters of libraries' names, nothing that means more
// to a shell.
bool is_plain(const std::string& name) {
  return !name.empty() && std::ranges::all_of(name, [](unsigned char c) {
    return std::isalnum(c) || std::strchr("/._+-:", c);
  });
}

std::string output_of(const std::string& command) {
  std::string text;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  char part[4096];
  while (pipe && std::fgets(part, sizeof part, pipe.get())) text += part;
  return text;
}

// Returns the paths of all loaded libraries by the names of their files.
std::map<std::string, std::string> loaded_files() {
  std::map<std::string, std::string> files;
  dl_iterate_phdr(
      [](dl_phdr_info* info, size_t, void* to) {
        const std::string path = info->dlpi_name, name = fs::path(path).filename().string();
        if (is_plain(name) && !name.starts_with("linux-vdso"))
          (*static_cast<std::map<std::string, std::string>*>(to))[name] = path;
        return 0;
      },
      &files);
  return files;
}

// Returns a path without "/usr": "/lib" is a link to "/usr/lib", and packages name either.
std::string below_usr(const std::string& path) {
  return path.starts_with("/usr/") ? path.substr(4) : path;
}

// Returns the packages of files, and their versions, by the files' names; empty if there is no
// dpkg.
std::map<std::string, std::pair<std::string, std::string>> packages_of(
    const std::map<std::string, std::string>& files) {
  std::string paths, names;
  for (const auto& [name, path] : files)
    if (is_plain(path)) paths += " " + below_usr(path) + " /usr" + below_usr(path);
  std::map<std::string, std::string> owners;  // package:architecture by file
  std::istringstream found(output_of("dpkg-query -S" + paths + " 2>/dev/null"));
  for (std::string line; std::getline(found, line);) {
    const size_t end = line.find(": /");
    if (end == line.npos || !is_plain(line.substr(0, end))) continue;
    const std::string path = line.substr(end + 2), file = fs::path(path).filename();
    const auto loaded = files.find(file);
    if (loaded == files.end() || below_usr(path) != below_usr(loaded->second)) continue;
    if (owners.try_emplace(file, line.substr(0, end)).second) names += " " + owners[file];
  }
  std::map<std::string, std::string> versions;
  std::istringstream told(
      names.empty()
          ? ""
          : output_of("dpkg-query -W -f '${Package}\\t${Version}\\n'" + names + " 2>/dev/null"));
  for (std::string line; std::getline(told, line);)
    if (const size_t tab = line.find('\t'); tab != line.npos)
      versions[line.substr(0, tab)] = line.substr(tab + 1);
  std::map<std::string, std::pair<std::string, std::string>> packages;
  for (const auto& [file, owner] : owners) {
    const std::string package = owner.substr(0, owner.find(':'));
    packages[file] = {package, versions[package]};
  }
  return packages;
}

// Returns "3.13.5" for libembree3.so.3, a link to libembree3.so.3.13.5.
std::string version_of_file(const std::string& path) {
  std::error_code ec;
  const std::string name = fs::canonical(path, ec).filename().string();
  const size_t at = name.find(".so.");
  return at == name.npos ? "" : name.substr(at + 4);
}

void describe(const std::string& begins, Component& component) {
  component.name = begins;
  for (const KnownLibrary& known : known_libraries)
    if (begins.starts_with(known.begins)) {
      component.name = known.name;
      component.licence = known.licence;
      component.purpose = known.purpose;
    }
}

// Reads a library's entry as the build found it: "NAME|version|package", parted by commas
// (cmake/about.cmake).
Component compiled_in_component(const std::string& name) {
  Component component;
  describe(name, component);
  std::istringstream all(WELLSPRING_BUILT_WITH);
  for (std::string one; std::getline(all, one, ',');) {
    std::istringstream parts(one);
    std::string own;
    std::getline(parts, own, '|');
    if (own != name) continue;
    std::getline(parts, component.version, '|');
    std::getline(parts, component.package, '|');
  }
  return component;
}

// Writes the text as it stands in a package URL.
std::string encode(const std::string& text) {
  std::string out;
  for (unsigned char c : text) {
    if (std::isalnum(c) || std::strchr(".-_~", c)) {
      out += char(c);
    } else {
      const char digits[] = "0123456789ABCDEF";
      out += {'%', digits[c >> 4], digits[c & 15]};
    }
  }
  return out;
}

std::string distribution() {
  std::ifstream in("/etc/os-release");
  for (std::string line; std::getline(in, line);)
    if (line.starts_with("ID=")) return line.substr(line.starts_with("ID=\"") ? 4 : 3);
  return "debian";
}

}  // namespace

std::vector<Component> list_components(std::initializer_list<const char*> compiled_in) {
  std::vector<Component> components;
  const auto files = loaded_files();
  const auto packages = packages_of(files);
  for (const auto& [name, path] : files) {
    Component& component = components.emplace_back();
    describe(name, component);
    component.file = name;
    component.version = version_of_file(path);
    if (auto found = packages.find(name); found != packages.end())
      std::tie(component.package, component.version) = found->second;
  }
  for (const char* name : compiled_in) components.push_back(compiled_in_component(name));
  return components;
}

std::string version_number() { return WELLSPRING_VERSION; }

std::string describe_version(const std::string& program) {
  return program + " " + WELLSPRING_VERSION + "\n";
}

std::string describe_components(const std::string& program,
                                const std::vector<Component>& components) {
  std::string text = describe_version(program) + "Apache-2.0; it is made of:\n";
  for (const Component& one : components) {
    text += one.name + " " + (one.version.empty() ? "of unknown version" : one.version) + " (";
    text += one.file.empty() ? "compiled in" : one.file;
    if (!one.package.empty()) text += ", package " + one.package;
    text += "): " +
            (one.licence.empty() ? "licence in /usr/share/doc/" + one.package + "/copyright"
                                 : one.licence) +
            "; " + (one.purpose.empty() ? "for another of these" : one.purpose) + "\n";
  }
  return text;
}

std::string write_bill(const std::string& program, const std::vector<Component>& components) {
  json bill = {{"bomFormat", "CycloneDX"},
               {"specVersion", "1.5"},
               {"version", 1},
               {"metadata",
                {{"component",
                  {{"type", "application"},
                   {"bom-ref", program},
                   {"name", program},
                   {"version", WELLSPRING_VERSION},
                   {"licenses", {{{"license", {{"id", "Apache-2.0"}}}}}}}}}},
               {"components", json::array()}};
  const std::string system = distribution();
  for (const Component& one : components) {
    json entry = {{"type", "library"},
                  {"bom-ref", one.file.empty() ? one.name : one.file},
                  {"name", one.name},
                  {"version", one.version}};
    if (!one.purpose.empty()) entry["description"] = one.purpose;
    if (!one.licence.empty()) entry["licenses"] = {{{"expression", one.licence}}};
    if (!one.package.empty())
      entry["purl"] = "pkg:deb/" + system + "/" + encode(one.package) + "@" + encode(one.version);
    if (!one.file.empty()) entry["properties"] = {{{"name", "file"}, {"value", one.file}}};
    bill["components"].push_back(std::move(entry));
  }
  return bill.dump(2) + "\n";
}

bool answer_version(int argc, char** argv, std::initializer_list<const char*> compiled_in) {
  auto has = [&](std::string_view word) {
    return std::find(argv + std::min(argc, 1), argv + argc, word) != argv + argc;
  };
  if (!has("--version")) return false;
  const std::string program = argc > 0 ? fs::path(argv[0]).filename().string() : "wellspring";
  if (has("--json")) std::cout << write_bill(program, list_components(compiled_in));
  else if (has("--verbose"))
    std::cout << describe_components(program, list_components(compiled_in));
  else std::cout << describe_version(program);
  return true;
}

}  // namespace wellspring::about
