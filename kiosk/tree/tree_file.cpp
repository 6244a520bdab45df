// SPDX-License-Identifier: Apache-2.0
#include "kiosk/tree/tree_file.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <sodium.h>
#include <utility>

#include "base/load_error.h"
#include "base/write_file.h"
#include "json/fields.h"
#include "wire/limits.h"

namespace wellspring::kiosk {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;
using Bytes = std::vector<uint8_t>;
using Names = std::map<std::string, int>;

constexpr int base64 = sodium_base64_VARIANT_ORIGINAL;
constexpr size_t feature_bytes = 4 + sizeof(Descriptor);
constexpr float place_steps = 32;  // places of features are whole steps of a pixel

std::string to_base64(const Bytes& bytes) {
  std::string text(sodium_base64_encoded_len(bytes.size(), base64), '\0');
  sodium_bin2base64(text.data(), text.size(), bytes.data(), bytes.size(), base64);
  text.resize(std::strlen(text.c_str()));
  return text;
}

// Reads bytes, at most `most`; faults leave none.
Bytes read_bytes(FieldReader& fields, const char* name, size_t most) {
  std::string text;
  Bytes bytes;
  if (!fields.text(name, text, "base64", Need::optional, 4 * (most / 3 + 1))) return bytes;
  bytes.resize(text.size() / 4 * 3 + 3);
  size_t size = 0;
  if (sodium_base642bin(bytes.data(), bytes.size(), text.data(), text.size(), nullptr, &size,
                        nullptr, base64) != 0 ||
      size > most) {
    fields.fail(name, "is no base64");
    size = 0;
  }
  bytes.resize(size);
  return bytes;
}

Bytes pack_features(const std::vector<Feature>& features) {
  Bytes bytes(features.size() * feature_bytes);
  uint8_t* at = bytes.data();
  for (const Feature& one : features) {
    const uint16_t place[2] = {uint16_t(std::lround(one.place.x * place_steps)),
                               uint16_t(std::lround(one.place.y * place_steps))};
    std::memcpy(at, place, 4);
    std::memcpy(at + 4, one.bits.data(), sizeof(Descriptor));
    at += feature_bytes;
  }
  return bytes;
}

std::vector<Feature> read_features(FieldReader& fields, const View& view) {
  const Bytes bytes = read_bytes(fields, "features", most_features * feature_bytes);
  if (bytes.size() % feature_bytes != 0) {
    fields.fail("features", "is no whole number of features");
    return {};
  }
  std::vector<Feature> features(bytes.size() / feature_bytes);
  const uint8_t* at = bytes.data();
  for (Feature& one : features) {
    uint16_t place[2];
    std::memcpy(place, at, 4);
    std::memcpy(one.bits.data(), at + 4, sizeof(Descriptor));
    at += feature_bytes;
    one.place = vec2(place[0], place[1]) / place_steps;
    if (one.place.x > float(view.width) || one.place.y > float(view.height)) {
      fields.fail("features", "has a place outside of the view");
      return {};
    }
  }
  return features;
}

View read_view(FieldReader& fields) {
  View view;
  fields.text("side", view.side);
  fields.integer("width", 16, most_view_side, view.width, "pixels", Need::required);
  fields.integer("height", 16, most_view_side, view.height, "pixels", Need::required);
  fields.vector("size", 10, view.size, "metres");
  if (!(view.size.x >= 0 && view.size.y >= 0)) fields.fail("size", "is below 0");
  fields.vector("mean", 255, view.mean, "mean blue, green, red");
  if (view.width < 16 || view.height < 16) return view;
  view.features = read_features(fields, view);
  const size_t pixels = size_t(view.gray_width()) * size_t(view.gray_height());
  view.gray = read_bytes(fields, "picture", pixels);
  if (!view.gray.empty() && view.gray.size() != pixels)
    fields.fail("picture", "has not a byte for each pixel of half the width and height");
  return view;
}

Mark read_mark(FieldReader& fields) {
  Mark mark;
  constexpr int side = 256;
  fields.integer("view", 0, double(most_views - 1), mark.view, "", Need::required);
  fields.integer("x", 0, most_view_side, mark.x, "", Need::required);
  fields.integer("y", 0, most_view_side, mark.y, "", Need::required);
  fields.integer("width", 1, side, mark.width, "", Need::required);
  fields.integer("height", 1, side, mark.height, "", Need::required);
  const size_t bytes = size_t(mark.width) * size_t(mark.height) * 3;
  mark.bgr = read_bytes(fields, "picture", bytes);
  if (mark.bgr.size() != bytes) fields.fail("picture", "has not three bytes for each pixel");
  return mark;
}

NodeData read_data(FieldReader& fields) {
  NodeData data;
  fields.parts("views", most_views, "",
               [&](FieldReader& one) { data.views.push_back(read_view(one)); });
  fields.parts("marks", most_marks, "",
               [&](FieldReader& one) { data.marks.push_back(read_mark(one)); });
  fields.text("code", data.code, "", Need::optional, most_code_bytes);
  if (fields.vector("box", 10, data.box, "metres") &&
      !(std::min({data.box.x, data.box.y, data.box.z}) > 0))
    fields.fail("box", "has a side that is not above 0");
  return data;
}

Texts read_texts(const JsonValue& value, size_t most_bytes) {
  Texts texts;
  if (!value.object()) return texts;
  FieldReader fields(value);
  const auto members = fields.members();
  if (members.size() > max_languages) value.fail("has too many languages");
  for (const auto& [language, text] : members)
    if (language.empty() || language.size() > max_language) text.fail("is not named by a language");
    else text.text(texts[language], most_bytes, Need::required);
  return texts;
}

Conditions read_when(const JsonValue& list) {
  Conditions out;
  for (const JsonValue& one : list.list(0, 16, "conditions"))
    FieldReader::read_object(one, [&](FieldReader& fields) {
      Condition& to = out.emplace_back();
      fields.text("value", to.value, "", Need::required);
      fields.number("least", -1e9, 1e9, to.least);
      fields.number("most", -1e9, 1e9, to.most);
      fields.text("is", to.is);
      fields.number("quality", 0, 1, to.quality);
    });
  return out;
}

int find_node(const JsonValue& value, const Names& names) {
  std::string name;
  if (!value.text(name, max_text_bytes, Need::required)) return 0;
  const auto found = names.find(name);
  if (found != names.end()) return found->second;
  value.fail("names no node: '" + name + "'");
  return 0;
}

void read_search(FieldReader& fields, const Names& names, RecognitionNode& node) {
  for (const JsonValue& one : fields.list("solvers", 1, 8, "solvers", Need::required))
    FieldReader::read_object(one, [&](FieldReader& part) {
      SolverChoice& choice = node.solvers.emplace_back();
      part.text("solver", choice.solver, "", Need::required);
      if (std::ranges::find(solver_names, choice.solver) == std::end(solver_names))
        part.fail("solver", "names no solver that there is: '" + choice.solver + "'");
      if (const auto when = part.take("when")) choice.when = read_when(*when);
    });
  for (const JsonValue& one : fields.list("children", 1, most_children, "children", Need::required))
    node.children.push_back(find_node(one, names));
}

void read_node(FieldReader& fields, const Names& names, RecognitionNode& node) {
  fields.choice("kind", {"search", "switch", "model"}, node.kind, "", Need::required);
  if (node.kind == NodeKind::search) read_search(fields, names, node);
  if (node.kind == NodeKind::context_switch)
    for (const JsonValue& one : fields.list("cases", 1, most_children, "cases", Need::required))
      FieldReader::read_object(one, [&](FieldReader& part) {
        const auto when = part.take("when");
        const auto child = part.take("child", Need::required);
        node.cases.push_back(when ? read_when(*when) : Conditions{});
        node.children.push_back(child ? find_node(*child, names) : 0);
      });
  fields.text("id", node.id, "", node.kind == NodeKind::model ? Need::required : Need::optional);
  fields.text("hint", node.hint);
  if (const auto title = fields.take("title")) node.title = read_texts(*title, max_text_bytes);
  if (const auto text = fields.take("text")) node.text = read_texts(*text, 4000);
  if (const auto link = fields.take("backtrack")) node.backtrack = find_node(*link, names);
  for (const JsonValue& one : fields.list("refresh", 0, most_depth, "nodes"))
    node.refresh.push_back(find_node(one, names));
}

// Returns a node of a circle or one that lies too deep, or -1.
int find_circle(const RecognitionTree& tree) {
  // Heights are settled once a node, so that shared parts cost no more.
  std::vector<int> height(tree.nodes.size(), -1);  // -2: on the way down
  auto visit = [&](auto& self, int at, size_t depth) -> int {
    if (height[size_t(at)] == -2 || depth > most_depth) return at;
    if (height[size_t(at)] >= 0) return depth + size_t(height[size_t(at)]) > most_depth ? at : -1;
    height[size_t(at)] = -2;
    int most = 0;
    for (const int child : tree.nodes[size_t(at)].children) {
      if (const int wrong = self(self, child, depth + 1); wrong >= 0) return wrong;
      most = std::max(most, height[size_t(child)] + 1);
    }
    height[size_t(at)] = most;
    return -1;
  };
  for (size_t i = 0; i < tree.nodes.size(); i++)
    if (const int wrong = visit(visit, int(i), 0); wrong >= 0) return wrong;
  return -1;
}

void check_node(const RecognitionTree& tree, size_t at, FieldReader& root) {
  const RecognitionNode& node = tree.nodes[at];
  const std::string place = "nodes/" + node.name;
  if (!node.hint.empty() && !tree.hints.contains(node.hint))
    root.fail(place + "/hint", "names no hint: '" + node.hint + "'");
  const NodeData& data = tree.data[at];
  // Marks lie in views of the class, or in the node's own.
  for (const int child : node.children) {
    if (tree.data[size_t(child)].marks.size() != tree.data[size_t(node.children[0])].marks.size())
      root.fail("metadata/" + tree.nodes[size_t(child)].name + "/marks",
                "are not as many as those of its siblings");
    for (const Mark& mark : tree.data[size_t(child)].marks) {
      const std::string where = "metadata/" + tree.nodes[size_t(child)].name + "/marks";
      if (size_t(mark.view) >= data.views.size())
        root.fail(where, "names no view of '" + node.name + "'");
      else if (const View& view = data.views[size_t(mark.view)];
               mark.x + mark.width > view.width || mark.y + mark.height > view.height)
        root.fail(where, "lies outside of the view");
    }
  }
}

ordered_json to_json(const Conditions& when) {
  ordered_json out = ordered_json::array();
  for (const Condition& one : when) {
    ordered_json item{{"value", one.value}};
    if (std::isfinite(one.least)) item["least"] = one.least;
    if (std::isfinite(one.most)) item["most"] = one.most;
    if (!one.is.empty()) item["is"] = one.is;
    if (one.quality > 0) item["quality"] = one.quality;
    out.push_back(std::move(item));
  }
  return out;
}

ordered_json to_json(const RecognitionTree& tree, const RecognitionNode& node) {
  constexpr const char* kinds[] = {"search", "switch", "model"};
  const auto name = [&](int at) { return tree.nodes[size_t(at)].name; };
  ordered_json out{{"kind", kinds[size_t(node.kind)]}};
  if (!node.id.empty()) out["id"] = node.id;
  if (!node.title.empty()) out["title"] = node.title;
  if (!node.text.empty()) out["text"] = node.text;
  if (!node.hint.empty()) out["hint"] = node.hint;
  for (const SolverChoice& choice : node.solvers) {
    ordered_json item{{"solver", choice.solver}};
    if (!choice.when.empty()) item["when"] = to_json(choice.when);
    out["solvers"].push_back(std::move(item));
  }
  for (size_t i = 0; i < node.children.size(); i++)
    if (node.kind == NodeKind::search) out["children"].push_back(name(node.children[i]));
    else
      out["cases"].push_back({{"when", to_json(node.cases[i])}, {"child", name(node.children[i])}});
  if (node.backtrack >= 0) out["backtrack"] = name(node.backtrack);
  for (const int one : node.refresh) out["refresh"].push_back(name(one));
  return out;
}

ordered_json to_json(const NodeData& data) {
  ordered_json out = ordered_json::object();
  for (const View& view : data.views) {
    ordered_json item{{"side", view.side}, {"width", view.width}, {"height", view.height}};
    if (view.size.x > 0) item["size"] = {view.size.x, view.size.y};
    item["mean"] = {view.mean.x, view.mean.y, view.mean.z};
    item["features"] = to_base64(pack_features(view.features));
    item["picture"] = to_base64(view.gray);
    out["views"].push_back(std::move(item));
  }
  for (const Mark& mark : data.marks)
    out["marks"].push_back({{"view", mark.view},
                            {"x", mark.x},
                            {"y", mark.y},
                            {"width", mark.width},
                            {"height", mark.height},
                            {"picture", to_base64(mark.bgr)}});
  if (!data.code.empty()) out["code"] = data.code;
  if (data.box.x > 0) out["box"] = {data.box.x, data.box.y, data.box.z};
  return out;
}

}  // namespace

RecognitionTree parse_tree(const std::string& file, const std::string& text) {
  const json value = parse_json_file(file, text);
  Faults faults(file, true);
  FieldReader fields(value, faults);
  RecognitionTree tree;
  Names names;
  const auto nodes = fields.take("nodes", Need::required);
  const auto members = nodes && nodes->object() ? FieldReader(*nodes).members()
                                                : decltype(FieldReader(*nodes).members()){};
  if (members.empty() || members.size() > most_nodes)
    fields.fail("nodes", "has not 1 to " + std::to_string(most_nodes) + " nodes");
  for (const auto& [name, node] : members) names.emplace(name, int(names.size()));
  tree.nodes.resize(members.size());
  tree.data.resize(members.size());
  for (const auto& [name, node] : members) {
    RecognitionNode& to = tree.nodes[size_t(names.at(name))];
    to.name = name;
    FieldReader::read_object(node, [&](FieldReader& part) { read_node(part, names, to); });
  }
  if (const auto root = fields.take("root", Need::required)) tree.root = find_node(*root, names);
  if (const auto hints = fields.take("hints"); hints && hints->object())
    for (const auto& [name, texts] : FieldReader(*hints).members())
      tree.hints[name] = read_texts(texts, max_text_bytes);
  fields.members("metadata", "", [&](const std::string& name, FieldReader& part) {
    const auto found = names.find(name);
    if (found == names.end()) return fields.fail("metadata/" + name, "is of no node");
    tree.data[size_t(found->second)] = read_data(part);
  });
  fields.finish();
  size_t links = 0, views = 0;
  for (const RecognitionNode& node : tree.nodes) links += node.children.size();
  for (const NodeData& data : tree.data) views += data.views.size();
  if (links > most_links) fields.fail("nodes", "have too many children");
  if (views > most_all_views) fields.fail("metadata", "has too many views");
  if (const int wrong = find_circle(tree); wrong >= 0)
    fields.fail("nodes/" + tree.nodes[size_t(wrong)].name, "is below itself, or too deep");
  for (size_t i = 0; i < tree.nodes.size(); i++) check_node(tree, i, fields);
  return tree;
}

RecognitionTree load_tree(const std::string& file) {
  return parse_tree(file, read_json_text(file));
}

std::string write_tree(const RecognitionTree& tree) {
  ordered_json out{{"root", tree.nodes[size_t(tree.root)].name}, {"hints", tree.hints}};
  for (const RecognitionNode& node : tree.nodes) out["nodes"][node.name] = to_json(tree, node);
  for (size_t i = 0; i < tree.nodes.size(); i++)
    if (ordered_json data = to_json(tree.data[i]); !data.empty())
      out["metadata"][tree.nodes[i].name] = std::move(data);
  return out.dump(1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

void save_tree(const RecognitionTree& tree, const std::string& file) {
  write_file(file, write_tree(tree));
}

}  // namespace wellspring::kiosk
