// SPDX-License-Identifier: Apache-2.0
#include "kiosk/network/graph/graph_file.h"

#include <charconv>
#include <cmath>
#include <filesystem>
#include <sodium.h>

#include "base/load_error.h"

namespace wellspring::kiosk {

namespace {

constexpr size_t most_nodes = 10000, most_inputs = 64, most_entries = 64, most_node_name = 512;
constexpr double most_number = 1e9;

// Reads a whole number, which TensorFlow writes as text.
double read_whole(const JsonValue& value) {
  double number = 0;
  if (!value.value().is_string()) return value.whole(-most_number, most_number, number), number;
  const auto& text = value.value().get_ref<const std::string&>();
  int whole = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), whole);
  if (error != std::errc() || end != text.data() + text.size() || std::abs(whole) > most_number)
    value.fail("is no whole number within a thousand million");
  return whole;
}

// Reads a text, which TensorFlow writes in base64.
std::string read_word(const JsonValue& value) {
  std::string text;
  value.text(text);
  std::string word(text.size(), '\0');
  size_t size = 0;
  const char* end = nullptr;
  if (sodium_base642bin(reinterpret_cast<unsigned char*>(word.data()), word.size(), text.data(),
                        text.size(), nullptr, &size, &end, sodium_base64_VARIANT_ORIGINAL) != 0 ||
      end != text.data() + text.size())
    value.fail("is no text in base64");
  word.resize(size);
  return word;
}

void read_shape(const JsonValue& shape, GraphAttribute& to) {
  FieldReader fields(shape);
  for (const JsonValue& one : fields.list("dim", 0, most_entries, "sizes"))
    if (const auto size = FieldReader(one).take("size", Need::required))
      to.numbers.push_back(read_whole(*size));
}

GraphAttribute read_attribute(const JsonValue& value) {
  GraphAttribute out;
  FieldReader fields(value);
  double number = 0;
  bool flag = false;
  if (const auto i = fields.take("i")) out.numbers = {read_whole(*i)};
  if (const auto s = fields.take("s")) out.words = {read_word(*s)};
  if (fields.number("f", -1e30, 1e30, number)) out.numbers = {number};
  if (fields.boolean("b", flag)) out.numbers = {double(flag)};
  if (std::string type; fields.text("type", type)) out.words = {type};
  if (const auto shape = fields.take("shape")) read_shape(*shape, out);
  fields.part("list", "", [&](FieldReader& list) {
    for (const JsonValue& one : list.list("i", 0, most_entries, "numbers"))
      out.numbers.push_back(read_whole(one));
    for (const JsonValue& one : list.list("s", 0, most_entries, "texts"))
      out.words.push_back(read_word(one));
  });
  return out;
}

struct NamedNodes {
  static constexpr size_t none = SIZE_MAX;
  std::vector<GraphNode> nodes;                 // in the order of the file
  std::vector<std::vector<std::string>> reads;  // names of each node's inputs
  std::map<std::string, size_t> by_name;

  // Returns the node whose first output `input` names, or none.
  size_t find(std::string input) const {
    if (input.ends_with(":0")) input.resize(input.size() - 2);
    const auto found = by_name.find(input);
    return found == by_name.end() ? none : found->second;
  }
  // Throws LoadError instead of returning none.
  size_t find(std::string input, const std::string& file, const std::string& where) const {
    if (const size_t found = find(input); found != none) return found;
    if (input.ends_with(":0")) input.resize(input.size() - 2);
    throw LoadError(file, where, "there is no node called '" + input.substr(0, 80) + "'");
  }
};

NamedNodes read_nodes(FieldReader& topology, Faults& faults) {
  NamedNodes out;
  for (const JsonValue& one : topology.list("node", 1, most_nodes, "nodes", Need::required)) {
    GraphNode node;
    FieldReader(one).text("name", node.name, "", Need::required, most_node_name);
    node.where = one.where() + " (" + node.name.substr(0, 80) + ")";
    FieldReader fields(JsonValue(one.value(), faults, node.where));
    fields.text("op", node.operation, "", Need::required);
    out.reads.emplace_back();
    for (const JsonValue& input : fields.list("input", 0, most_inputs, "names of nodes")) {
      std::string name;
      input.text(name, most_node_name, Need::required);
      // A name that begins with ^ has to run before, and is not read.
      if (!name.starts_with("^")) out.reads.back().push_back(name);
    }
    if (node.operation != "Const")
      fields.members("attr", "", [&](const std::string& name, FieldReader& attribute) {
        node.attributes.emplace(name, read_attribute(attribute));
      });
    if (!out.by_name.emplace(node.name, out.nodes.size()).second)
      fields.JsonValue::fail("is a second node of this name");
    out.nodes.push_back(std::move(node));
  }
  return out;
}

// Returns the nodes that `wanted` need, each after its inputs.
std::vector<size_t> sort_nodes(const NamedNodes& all,
                               const std::vector<std::vector<size_t>>& inputs,
                               const std::vector<size_t>& wanted, const std::string& file) {
  enum class State : uint8_t { unseen, open, done };
  std::vector<State> states(all.nodes.size(), State::unseen);
  std::vector<size_t> order;
  struct Step {
    size_t node, next;  // next: which of its inputs is looked at next
  };
  std::vector<Step> open;
  auto enter = [&](size_t node) {
    if (states[node] == State::open)
      throw LoadError(file, all.nodes[node].where, "needs its own result: the graph has a circle");
    if (states[node] == State::unseen) open.push_back({node, 0}), states[node] = State::open;
  };
  for (size_t first : wanted) {
    enter(first);
    while (!open.empty()) {
      const size_t node = open.back().node, next = open.back().next++;
      if (next < inputs[node].size()) {
        // Only a node that is needed has to read what there is.
        if (inputs[node][next] == NamedNodes::none)
          all.find(all.reads[node][next], file, all.nodes[node].where);
        enter(inputs[node][next]);
        continue;
      }
      states[node] = State::done;
      order.push_back(node);
      open.pop_back();
    }
  }
  return order;
}

// Reads which nodes are outputs, by name, as the file's signature says.
void read_signature(FieldReader& root, const NamedNodes& all, Graph& graph) {
  auto read = [&](FieldReader& signature) {
    signature.members("outputs", "", [&](std::string name, FieldReader& output) {
      std::string node;
      output.text("name", node, "", Need::required, most_node_name);
      if (name.ends_with(":0")) name.resize(name.size() - 2);
      graph.outputs[name] = all.find(node, graph.file, output.where());
    });
  };
  root.part("signature", "", read);
  root.part("userDefinedMetadata", "",
            [&](FieldReader& fields) { fields.part("signature", "", read); });
}

}  // namespace

Graph load_graph(const std::string& file, const std::vector<std::string>& cut) {
  const nlohmann::json json = parse_json_file(file, read_json_text(file));
  Faults faults(file);
  FieldReader root(json, faults);
  Graph graph{file, {}, {}, {}};
  NamedNodes all;
  root.part(
      "modelTopology", "", [&](FieldReader& topology) { all = read_nodes(topology, faults); },
      Need::required);
  std::vector<std::vector<size_t>> inputs(all.nodes.size());
  std::vector<bool> is_read(all.nodes.size());
  for (size_t i = 0; i < all.nodes.size(); i++)
    for (const std::string& name : all.reads[i]) {
      inputs[i].push_back(all.find(name));
      if (inputs[i].back() != NamedNodes::none) is_read[inputs[i].back()] = true;
    }
  read_signature(root, all, graph);
  if (!cut.empty()) graph.outputs.clear();
  for (const std::string& name : cut)
    graph.outputs[name] = all.find(name, file, "/modelTopology/node");
  if (graph.outputs.empty())
    for (size_t i = 0; i < all.nodes.size(); i++)
      if (!is_read[i] && all.nodes[i].operation != "Const") graph.outputs[all.nodes[i].name] = i;
  if (graph.outputs.empty())
    throw LoadError(file, "/modelTopology/node", "no node is an output: each is read by another");

  std::vector<size_t> wanted;
  for (const auto& [name, node] : graph.outputs) wanted.push_back(node);
  const std::vector<size_t> order = sort_nodes(all, inputs, wanted, file);
  std::vector<size_t> place(all.nodes.size());
  for (size_t i = 0; i < order.size(); i++) place[order[i]] = i;
  for (size_t from : order) {
    GraphNode node = std::move(all.nodes[from]);
    for (size_t input : inputs[from]) node.inputs.push_back(place[input]);
    graph.nodes.push_back(std::move(node));
  }
  for (auto& [name, node] : graph.outputs) node = place[node];

  const auto manifests = root.take("weightsManifest", Need::required);
  graph.constants =
      load_tensors(*manifests, faults, std::filesystem::path(file).parent_path().string());
  for (const GraphNode& node : graph.nodes)
    if (node.operation == "Const" && !graph.constants.contains(node.name))
      throw LoadError(file, node.where, "weightsManifest has no weights for this constant");
  return graph;
}

}  // namespace wellspring::kiosk
