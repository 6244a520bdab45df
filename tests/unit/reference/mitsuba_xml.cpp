// SPDX-License-Identifier: Apache-2.0
#include "mitsuba_xml.h"

#include <algorithm>
#include <fstream>

#include "base/load_error.h"

namespace wellspring::mitsuba {
namespace {

namespace fs = std::filesystem;

constexpr int deepest_include = 8;
constexpr size_t most_nodes = 100000, most_bytes = size_t(64) << 20;

struct Expansion {
  Document& document;
  std::map<std::string, std::string> variables;
  size_t nodes = 0;
};

[[noreturn]] void fail(const fs::path& file, const std::string& where, const std::string& what) {
  throw LoadError{file.string(), where, what};
}

std::string substitute(const Expansion& e, const fs::path& file, std::string value) {
  size_t at;
  while ((at = value.find('$')) != std::string::npos) {
    size_t end = at + 1;
    while (end < value.size() && (std::isalnum(uint8_t(value[end])) || value[end] == '_')) end++;
    auto found = e.variables.find(value.substr(at + 1, end - at - 1));
    if (found == e.variables.end()) fail(file, value, "a variable without a value");
    if (found->second.find('$') != std::string::npos) fail(file, value, "a variable in a variable");
    value.replace(at, end - at, found->second);
  }
  return value;
}

void expand_file(Expansion& e, const fs::path& file, pugi::xml_node into, int depth);

void expand(Expansion& e, const fs::path& file, pugi::xml_node from, pugi::xml_node into,
            int depth) {
  for (pugi::xml_node child : from.children()) {
    if (child.type() != pugi::node_element) continue;
    if (++e.nodes > most_nodes) fail(file, child.name(), "too many nodes");
    std::string kind = child.name();
    auto value = [&](const char* name) {
      return substitute(e, file, child.attribute(name).as_string());
    };
    if (kind == "default") {
      e.variables.emplace(value("name"), value("value"));
    } else if (kind == "path") {
      e.document.folders.push_back(file.parent_path() / value("value"));
    } else if (kind == "include") {
      expand_file(e, find_file(e.document, value("filename")), into, depth + 1);
    } else if (kind == "alias") {
      auto found = e.document.by_id.find(value("id"));
      if (found == e.document.by_id.end()) fail(file, value("id"), "an alias of nothing");
      e.document.by_id[value("as")] = found->second;
    } else {
      pugi::xml_node copy = into.append_child(kind.c_str());
      for (pugi::xml_attribute attribute : child.attributes())
        copy.append_attribute(attribute.name()) = substitute(e, file, attribute.value()).c_str();
      if (copy.attribute("id") && kind != "ref")
        e.document.by_id[copy.attribute("id").value()] = copy;
      if (depth + 1 > 64) fail(file, kind, "nested too deeply");
      expand(e, file, child, copy, depth);
    }
  }
}

void expand_file(Expansion& e, const fs::path& file, pugi::xml_node into, int depth) {
  if (depth > deepest_include) fail(file, "include", "nested too deeply");
  std::vector<uint8_t> bytes = read_bytes(file);
  pugi::xml_document xml;
  pugi::xml_parse_result result = xml.load_buffer(bytes.data(), bytes.size());
  if (!result) fail(file, "byte " + std::to_string(result.offset), result.description());
  e.document.folders.push_back(file.parent_path());
  expand(e, file, xml.child("scene"), into, depth);
}

}  // namespace

void load_document(const fs::path& file, Document& out) {
  Expansion e{out, {}, 0};
  expand_file(e, file, out.xml.append_child("scene"), 0);
}

pugi::xml_node resolve(const Document& document, pugi::xml_node node) {
  if (std::string(node.name()) != "ref") return node;
  auto found = document.by_id.find(node.attribute("id").value());
  if (found == document.by_id.end()) fail("scene", node.attribute("id").value(), "no such object");
  return found->second;
}

fs::path find_file(const Document& document, const std::string& name) {
  for (const fs::path& folder : document.folders)
    if (fs::is_regular_file(folder / name)) return folder / name;
  fail(name, "", "no such file");
}

std::vector<uint8_t> read_bytes(const fs::path& file) {
  std::ifstream in(file, std::ios::binary | std::ios::ate);
  if (!in || in.tellg() < 0 || size_t(in.tellg()) > most_bytes) fail(file, "", "cannot be read");
  std::vector<uint8_t> bytes(size_t(in.tellg()));
  in.seekg(0);
  in.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(bytes.size()));
  if (!in) fail(file, "", "cannot be read");
  return bytes;
}

pugi::xml_node find_property(pugi::xml_node plugin, const char* name) {
  return plugin.find_child_by_attribute("name", name);
}

double number(pugi::xml_node plugin, const char* name, double otherwise) {
  pugi::xml_node node = find_property(plugin, name);
  return node ? node.attribute("value").as_double() : otherwise;
}

std::string text(pugi::xml_node plugin, const char* name, const std::string& otherwise) {
  pugi::xml_node node = find_property(plugin, name);
  return node ? node.attribute("value").as_string() : otherwise;
}

bool boolean(pugi::xml_node plugin, const char* name, bool otherwise) {
  pugi::xml_node node = find_property(plugin, name);
  return node ? node.attribute("value").as_bool() : otherwise;
}

dvec3 parse_vector(const std::string& value) {
  std::string list = value;
  std::replace(list.begin(), list.end(), ',', ' ');
  double v[3] = {0, 0, 0};
  int count = 0;
  const char* p = list.c_str();
  for (char* end = nullptr; count < 3; p = end) {
    double x = std::strtod(p, &end);
    if (end == p) break;
    v[count++] = x;
  }
  if (count != 1 && count != 3) fail("scene", value, "neither one nor three numbers");
  return count == 1 ? dvec3(v[0]) : dvec3(v[0], v[1], v[2]);
}

glm::dmat4 transform(pugi::xml_node plugin, const char* name) {
  glm::dmat4 result(1);
  for (pugi::xml_node step : find_property(plugin, name).children()) {
    std::string kind = step.name();
    auto axes = [&](double otherwise) {
      if (step.attribute("value")) return parse_vector(step.attribute("value").value());
      return dvec3(step.attribute("x").as_double(otherwise),
                   step.attribute("y").as_double(otherwise),
                   step.attribute("z").as_double(otherwise));
    };
    glm::dmat4 m(1);
    if (kind == "translate") {
      m = glm::translate(m, axes(0));
    } else if (kind == "scale") {
      m = glm::scale(m, axes(1));
    } else if (kind == "rotate") {
      m = glm::rotate(m, glm::radians(step.attribute("angle").as_double()), normalize(axes(0)));
    } else if (kind == "lookat") {  // +z towards the target, +x to the left
      dvec3 origin = parse_vector(step.attribute("origin").value());
      dvec3 z = normalize(parse_vector(step.attribute("target").value()) - origin);
      dvec3 x = normalize(cross(parse_vector(step.attribute("up").value()), z));
      m = glm::dmat4(glm::dvec4(x, 0), glm::dvec4(cross(z, x), 0), glm::dvec4(z, 0),
                     glm::dvec4(origin, 1));
    } else {
      fail("scene", kind, "unknown step of a transform");
    }
    result = m * result;
  }
  return result;
}

}  // namespace wellspring::mitsuba
