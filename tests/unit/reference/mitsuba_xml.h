// SPDX-License-Identifier: Apache-2.0
// Mitsuba 3 scene files, read for tests: <include>, <default> with $variables, <path>, <alias> and
// <ref> are resolved, so that what remains is a plain tree of plugins and their properties.
#pragma once
#include <filesystem>
#include <map>
#include <pugixml.hpp>
#include <string>
#include <vector>

#include "base/vec.h"

namespace wellspring::mitsuba {

struct Document {
  pugi::xml_document xml;
  std::vector<std::filesystem::path> folders;   // searched for files, in this order
  std::map<std::string, pugi::xml_node> by_id;  // whatever has an id, and aliases
  pugi::xml_node root() const { return xml.child("scene"); }
};

// Throws LoadError: no such file, bad XML, includes nested deeper than 8, a variable without a
// value, a tree of more than 100,000 nodes.
void load_document(const std::filesystem::path& file, Document& out);

// The object itself, or what a <ref> points at. Throws LoadError where it points nowhere.
pugi::xml_node resolve(const Document& document, pugi::xml_node node);
// The first existing file of that name. Throws LoadError.
std::filesystem::path find_file(const Document& document, const std::string& name);
std::vector<uint8_t> read_bytes(const std::filesystem::path& file);

// Properties of a plugin by their names; `otherwise` where there is none.
pugi::xml_node find_property(pugi::xml_node plugin, const char* name);
double number(pugi::xml_node plugin, const char* name, double otherwise);
std::string text(pugi::xml_node plugin, const char* name, const std::string& otherwise);
bool boolean(pugi::xml_node plugin, const char* name, bool otherwise);
// "1 2 3" or "1, 2, 3" or one number for all three.
dvec3 parse_vector(const std::string& value);
// <transform> with the given name: its steps, each applied after those before it.
glm::dmat4 transform(pugi::xml_node plugin, const char* name = "to_world");

}  // namespace wellspring::mitsuba
