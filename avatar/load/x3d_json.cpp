// SPDX-License-Identifier: Apache-2.0
// Reads the JSON encoding (X3D JSON, ISO/IEC 19776-5 draft) into the node tree: "@name" is a field,
// "-name" holds nodes.
#include <nlohmann/json.hpp>

#include "avatar/load/x3d_node.h"
#include "base/load_error.h"

namespace wellspring::avatar {
namespace {

using nlohmann::json;

using json = nlohmann::json;

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + '"';
}

struct JsonBuilder {
  X3dFile& file;
  std::vector<X3dPendingUse> uses;

  [[noreturn]] void fail(const std::string& place, const std::string& what) const {
    throw LoadError(file.path, place, what);
  }

  // Returns a value as the text another encoding would have.
  std::string text_of(const json& value, const std::string& place) {
    if (value.is_string()) return value.get<std::string>();
    if (value.is_boolean()) return value.get<bool>() ? "true" : "false";
    if (value.is_number()) return value.dump();
    if (value.is_null()) return "";
    if (!value.is_array()) fail(place, "holds an object where a value belongs");
    std::string all;
    for (const json& item : value) {
      if (item.is_array() || item.is_object()) fail(place, "holds a list within a list");
      if (!all.empty()) all += ' ';
      all += item.is_string() ? quoted(item.get<std::string>()) : text_of(item, place);
    }
    return all;
  }

  void add_routes(const json& value) {
    for (const json& route : value.is_array() ? value : json::array({value})) {
      auto text = [&](const char* key) {
        auto found = route.is_object() ? route.find(key) : route.end();
        return found != route.end() && found->is_string() ? found->get<std::string>()
                                                          : std::string();
      };
      add_route(file, {text("@fromNode"), text("@fromField"), text("@toNode"), text("@toField")});
    }
  }

  // Adds {"Group": {...}} or a list of such nodes.
  void add_nodes(const json& value, int parent, const std::string& field, const std::string& place,
                 int depth) {
    if (depth > x3d_max_depth)
      fail(place.substr(0, 200), "nodes are nested deeper than " + std::to_string(x3d_max_depth));
    if (value.is_array()) {
      for (size_t i = 0; i < value.size(); i++)
        add_nodes(value[i], parent, field, place + "/" + std::to_string(i), depth + 1);
      return;
    }
    if (!value.is_object()) return;
    for (const auto& [type, content] : value.items()) {
      if (type.empty() || type[0] == '#' || type[0] == '@' || type[0] == '-') continue;
      std::string here = place + "/" + type;
      if (type == "ROUTE") {
        add_routes(content);
      } else if (type == "ProtoDeclare" || type == "ExternProtoDeclare") {
        std::string name = content.is_object() ? content.value("@name", json()).dump() : "";
        warn_once(file.warnings, "prototype " + name.substr(0, 60) + " is not expanded");
      } else if (content.is_object() && type != "IS") {
        add_node(type, content, parent, field, here, depth);
      }
    }
  }

  void add_node(const std::string& type, const json& content, int parent, const std::string& field,
                const std::string& place, int depth) {
    if (file.nodes.size() >= size_t(x3d_max_nodes))
      fail("", "more than " + std::to_string(x3d_max_nodes) + " nodes");
    int index = int(file.nodes.size());
    std::string container = field;
    if (auto it = content.find("@containerField"); it != content.end())
      container = text_of(*it, place);
    if (auto it = content.find("@USE"); it != content.end()) {
      uses.push_back({parent, file.nodes[size_t(parent)].children.size(), text_of(*it, place), 0});
      file.nodes[size_t(parent)].children.push_back({container, index - 1, false});
      return;
    }
    bool instance = type == "ProtoInstance";
    X3dNode node;
    node.type = x3d_type_name(type);
    for (const auto& [name, value] : content.items()) {
      if (name.empty() || name[0] != '@') continue;
      std::string text = text_of(value, place + "/" + name);
      if (name == "@DEF") node.def = text;
      else if (instance && name == "@name") node.type = x3d_type_name(text);
      else if (name != "@containerField") node.fields.push_back({name.substr(1), text});
    }
    file.nodes[size_t(parent)].children.push_back({container, index, false});
    file.nodes.push_back(std::move(node));
    for (const auto& [name, value] : content.items()) {
      if (name.size() > 1 && name[0] == '-')
        add_nodes(value, index, name.substr(1), place + "/" + name, depth + 1);
      if (name != "fieldValue") continue;
      for (const json& one : value.is_array() ? value : json::array({value})) {
        if (!one.is_object()) continue;
        std::string field_name = one.contains("@name") ? text_of(one["@name"], place) : "";
        if (one.contains("@value"))
          file.nodes[size_t(index)].fields.push_back({field_name, text_of(one["@value"], place)});
        for (const auto& [key, nodes] : one.items())
          if (key[0] == '-') add_nodes(nodes, index, field_name, place + "/fieldValue", depth + 1);
      }
    }
  }
};

// Refuses deep nesting: the parser's own stack is no limit, but a value of 100,000 nested brackets
// cannot be handled safely.
void refuse_deep(const std::string& path, const std::string& text) {
  int depth = 0, line = 1;
  bool in_string = false;
  for (size_t i = 0; i < text.size(); i++) {
    char c = text[i];
    if (c == '\n') line++;
    if (in_string) {
      if (c == '\\') i++;
      else if (c == '"') in_string = false;
    } else if (c == '"') {
      in_string = true;
    } else if (c == '{' || c == '[') {
      if (++depth > 4 * x3d_max_depth)
        throw LoadError(path, "line " + std::to_string(line),
                        "brackets are nested deeper than " + std::to_string(4 * x3d_max_depth));
    } else if (c == '}' || c == ']') {
      depth--;
    }
  }
}

}  // namespace

X3dFile parse_x3d_json(const std::string& path, const std::string& text) {
  refuse_deep(path, text);
  json document;
  try {
    document = json::parse(text);
  } catch (const json::exception& error) {
    throw LoadError(path, "", std::string("JSON is broken: ") + error.what());
  }
  if (!document.is_object() || !document.contains("X3D") || !document["X3D"].is_object())
    throw LoadError(path, "/X3D", "there is no object of this name");
  const json& root = document["X3D"];
  if (!root.contains("Scene") || !root["Scene"].is_object())
    throw LoadError(path, "/X3D/Scene", "there is no object of this name");
  X3dFile file;
  file.path = path;
  file.nodes.push_back({.type = "Scene", .def = "", .line = 0, .fields = {}, .children = {}});
  if (root.contains("head") && root["head"].is_object() && root["head"].contains("unit")) {
    const json& units = root["head"]["unit"];
    for (const json& unit : units.is_array() ? units : json::array({units})) {
      bool length = unit.is_object() && unit.contains("@category") && unit["@category"] == "length";
      if (!length || !unit.contains("@conversionFactor") || !unit["@conversionFactor"].is_number())
        continue;
      float factor = unit["@conversionFactor"].get<float>();
      if (factor > 1e-6f && factor < 1e6f) file.length_unit = factor;
    }
  }
  JsonBuilder builder{file, {}};
  for (const auto& [name, value] : root["Scene"].items())
    if (!name.empty() && name[0] == '-')
      builder.add_nodes(value, 0, name.substr(1), "/X3D/Scene/" + name, 1);
  resolve_uses(file, builder.uses);
  return file;
}

}  // namespace wellspring::avatar
