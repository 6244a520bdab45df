// SPDX-License-Identifier: Apache-2.0
// Reads the XML encoding (ISO/IEC 19776-1) into the node tree. PROTO instances become nodes of the
// PROTO's name.
#include <algorithm>
#include <cstring>
#include <pugixml.hpp>

#include "avatar/load/x3d_node.h"
#include "base/load_error.h"

namespace wellspring::avatar {
namespace {

// Finds the lines of byte offsets; UTF-16 and UTF-32 files have none.
class Lines {
 public:
  explicit Lines(const std::string& text) {
    known_ = text.substr(0, 4).find('\0') == std::string::npos;
    for (size_t i = 0; known_ && i < text.size(); i++)
      if (text[i] == '\n') ends_.push_back(ptrdiff_t(i));
  }
  int at(ptrdiff_t offset) const {
    if (!known_ || offset < 0) return 0;
    return int(std::lower_bound(ends_.begin(), ends_.end(), offset) - ends_.begin()) + 1;
  }

 private:
  bool known_;
  std::vector<ptrdiff_t> ends_;
};

const char* local_name(const char* name) {
  const char* colon = std::strrchr(name, ':');
  return colon ? colon + 1 : name;
}

bool is(const pugi::xml_node& node, const char* name) {
  return std::strcmp(local_name(node.name()), name) == 0;
}

struct XmlBuilder {
  X3dFile& file;
  const Lines& lines;
  std::vector<X3dPendingUse> uses;

  int line(const pugi::xml_node& xml) const { return lines.at(xml.offset_debug()); }

  // The walk is iterative, so that hostile nesting cannot exhaust the stack.
  struct Open {
    pugi::xml_node next;  // next child to look at
    int node;             // node that the children belong to
    std::string field;    // field for children without containerField (inside fieldValue)
  };

  void build(const pugi::xml_node& scene) {
    file.nodes.push_back(
        {.type = "Scene", .def = "", .line = line(scene), .fields = {}, .children = {}});
    std::vector<Open> stack{{scene.first_child(), 0, ""}};
    while (!stack.empty()) {
      Open& top = stack.back();
      pugi::xml_node xml = top.next;
      if (!xml) {
        stack.pop_back();
        continue;
      }
      top.next = xml.next_sibling();
      if (xml.type() != pugi::node_element) continue;
      int parent = top.node;
      std::string field = top.field;
      if (stack.size() > size_t(x3d_max_depth))
        throw LoadError(file.path, "line " + std::to_string(line(xml)),
                        "nodes are nested deeper than " + std::to_string(x3d_max_depth));
      if (is(xml, "fieldValue")) {
        read_field_value(xml, parent, stack);
      } else if (is(xml, "ProtoDeclare") || is(xml, "ExternProtoDeclare")) {
        std::string name = xml.attribute("name").value();
        if (x3d_type_name(name).rfind("HAnim", 0) != 0)
          warn_once(file.warnings, "line " + std::to_string(line(xml)) + ": prototype '" +
                                       name.substr(0, 60) + "' is not expanded");
      } else if (is(xml, "ROUTE")) {
        add_route(file, {xml.attribute("fromNode").value(), xml.attribute("fromField").value(),
                         xml.attribute("toNode").value(), xml.attribute("toField").value()});
      } else if (is(xml, "IS") || is(xml, "field") || is(xml, "IMPORT") || is(xml, "EXPORT")) {
        continue;
      } else {
        int made = add_node(xml, parent, field);
        if (made >= 0) stack.push_back({xml.first_child(), made, ""});
      }
    }
  }

  // Adds a node. Returns its index, or -1 for a USE.
  int add_node(const pugi::xml_node& xml, int parent, const std::string& field) {
    if (file.nodes.size() >= size_t(x3d_max_nodes))
      throw LoadError(file.path, "line " + std::to_string(line(xml)),
                      "more than " + std::to_string(x3d_max_nodes) + " nodes");
    bool instance = is(xml, "ProtoInstance");
    int index = int(file.nodes.size());
    X3dChild child{field, index, false};
    if (auto container = xml.attribute("containerField")) child.field = container.value();
    if (auto use = xml.attribute("USE"); use && *use.value()) {
      // child.node is the node before the USE, by which resolve_uses knows where the USE stands.
      uses.push_back({parent, file.nodes[size_t(parent)].children.size(), use.value(), line(xml)});
      child.node = index - 1;
      file.nodes[size_t(parent)].children.push_back(child);
      return -1;
    }
    X3dNode node;
    node.type = x3d_type_name(instance ? xml.attribute("name").value() : xml.name());
    node.line = line(xml);
    for (const pugi::xml_attribute& attribute : xml.attributes()) {
      const char* name = local_name(attribute.name());
      if (std::strcmp(name, "DEF") == 0) node.def = attribute.value();
      else if (std::strcmp(name, "containerField") != 0 &&
               !(instance && std::strcmp(name, "name") == 0))
        node.fields.push_back({name, attribute.value()});
    }
    file.nodes[size_t(parent)].children.push_back(child);
    file.nodes.push_back(std::move(node));
    return index;
  }

  void read_field_value(const pugi::xml_node& xml, int parent, std::vector<Open>& stack) {
    std::string name = xml.attribute("name").value();
    if (auto value = xml.attribute("value"))
      file.nodes[size_t(parent)].fields.push_back({name, value.value()});
    if (xml.first_child()) stack.push_back({xml.first_child(), parent, name});
  }
};

}  // namespace

X3dFile parse_x3d_xml(const std::string& path, const std::string& text) {
  Lines lines(text);
  pugi::xml_document document;
  pugi::xml_parse_result result = document.load_buffer(
      text.data(), text.size(), pugi::parse_default | pugi::parse_ws_pcdata_single);
  if (!result) {
    int line = lines.at(result.offset);
    throw LoadError(path, line ? "line " + std::to_string(line) : "",
                    std::string("XML is broken: ") + result.description());
  }
  pugi::xml_node root, scene;
  for (const pugi::xml_node& node : document.children())
    if (is(node, "X3D")) root = node;
  if (!root) throw LoadError(path, "", "the outermost element is not X3D");
  X3dFile file;
  file.path = path;
  for (const pugi::xml_node& node : root.children()) {
    if (is(node, "Scene")) scene = node;
    if (!is(node, "head")) continue;
    for (const pugi::xml_node& unit : node.children())
      if (is(unit, "unit") && std::string(unit.attribute("category").value()) == "length") {
        float factor = unit.attribute("conversionFactor").as_float(1);
        if (factor > 1e-6f && factor < 1e6f) file.length_unit = factor;
      }
  }
  if (!scene) throw LoadError(path, "", "the X3D element has no Scene");
  XmlBuilder builder{file, lines, {}};
  builder.build(scene);
  resolve_uses(file, builder.uses);
  return file;
}

}  // namespace wellspring::avatar
