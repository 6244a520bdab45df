// SPDX-License-Identifier: Apache-2.0
#include "kiosk/tree/tree_file.h"

#include <gtest/gtest.h>

#include "base/load_error.h"

namespace wellspring::test {
namespace {

const std::string whole = R"({
 "root": "start",
 "hints": {"turn": {"en": "Turn it over, please.", "de": "Bitte umdrehen."}},
 "nodes": {
  "start": {"kind": "search", "solvers": [{"solver": "pattern"}], "children": ["sides", "tile"]},
  "sides": {"kind": "switch", "backtrack": "start", "cases": [
    {"when": [{"value": "side", "is": "back"}, {"value": "scale", "least": 0.5, "quality": 0.2}],
     "child": "backs"},
    {"child": "fronts"}]},
  "backs": {"kind": "search", "id": "coin", "title": {"en": "a coin"}, "hint": "turn",
    "solvers": [{"solver": "twins", "when": [{"value": "shared", "is": "yes"}]}, {"solver": "pattern"}],
    "children": ["as", "denarius"], "refresh": ["start"]},
  "fronts": {"kind": "search", "id": "coin", "solvers": [{"solver": "colors"}],
    "children": ["denarius", "as"]},
  "as": {"kind": "model", "id": "as", "title": {"en": "An as"}, "text": {"en": "Of bronze."}},
  "denarius": {"kind": "model", "id": "denarius"},
  "tile": {"kind": "model", "id": "tile"}},
 "metadata": {
  "backs": {"views": [{"side": "back", "width": 32, "height": 16, "size": [0.02, 0.01]}]},
  "as": {"marks": [{"view": 0, "x": 1, "y": 2, "width": 1, "height": 1, "picture": "AQID"}]},
  "denarius": {"marks": [{"view": 0, "x": 1, "y": 2, "width": 1, "height": 1, "picture": "BAUG"}]}}
})";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

// The two searches of coins share leaves, whose marks need views at both.
std::string good() {
  return replaced(whole, "\"as\": {\"marks\"",
                  R"("fronts": {"views": [{"width": 32, "height": 16}]}, "as": {"marks")");
}

TEST(TreeFile, says_what_it_has) {
  const RecognitionTree tree = parse_tree("t.json", good());
  ASSERT_EQ(tree.nodes.size(), 7u);
  const RecognitionNode& root = tree.nodes[size_t(tree.root)];
  EXPECT_EQ(root.name, "start");
  const RecognitionNode& sides = tree.nodes[size_t(root.children[0])];
  EXPECT_EQ(sides.kind, NodeKind::context_switch);
  ASSERT_EQ(sides.cases.size(), 2u);
  EXPECT_EQ(sides.cases[0][1].least, 0.5);
  EXPECT_EQ(sides.cases[0][1].quality, 0.2);
  EXPECT_TRUE(sides.cases[1].empty());
  EXPECT_EQ(sides.backtrack, tree.root);
  const int backs = sides.children[0];
  EXPECT_EQ(tree.nodes[size_t(backs)].id, "coin");
  EXPECT_EQ(tree.nodes[size_t(backs)].refresh, std::vector<int>{tree.root});
  EXPECT_EQ(tree.data[size_t(backs)].views[0].side, "back");
  EXPECT_EQ(tree.hints.at("turn").at("de"), "Bitte umdrehen.");
  const int as = tree.nodes[size_t(backs)].children[0];
  EXPECT_EQ(tree.data[size_t(as)].marks[0].bgr, (std::vector<uint8_t>{1, 2, 3}));
  EXPECT_EQ(tree.nodes[size_t(as)].text.at("en"), "Of bronze.");
}

TEST(TreeFile, comes_back_as_it_was) {
  RecognitionTree tree = parse_tree("t.json", good());
  View& view = tree.data[0].views.emplace_back();
  view.width = 40, view.height = 20;
  view.mean = vec3(1, 2, 3);
  view.features = {{{1.5f, 2.25f}, {1, 2, 3, ~uint64_t(0)}}, {{39, 19}, {}}};
  view.gray.assign(200, 7);
  tree.data[0].code = "https://museum.example/17";
  const std::string text = write_tree(tree);
  const RecognitionTree again = parse_tree("t.json", text);
  EXPECT_EQ(write_tree(again), text);
  const View& same = again.data[0].views.back();
  EXPECT_EQ(same.features[0].place, view.features[0].place);
  EXPECT_EQ(same.features[0].bits, view.features[0].bits);
  EXPECT_EQ(same.gray, view.gray);
}

TEST(TreeFile, each_fault_is_named_with_its_place) {
  const std::tuple<const char*, const char*, const char*> faults[] = {
      {"\"root\": \"start\"", "\"root\": \"begin\"", "/root"},
      {"\"kind\": \"search\"", "\"kind\": \"seek\"", "/nodes/"},
      {"[\"sides\", \"tile\"]", "[\"sides\", \"brick\"]", "/nodes/start/children/1"},
      {"[\"sides\", \"tile\"]", "[]", "/nodes/start/children"},
      {"\"hint\": \"turn\"", "\"hint\": \"jump\"", "/nodes/backs/hint"},
      {"\"children\": [\"as\", \"denarius\"]", "\"children\": [\"as\", \"start\"]", "/nodes/"},
      {"\"least\": 0.5", "\"least\": \"a\"", "/nodes/sides/cases/0/when/1/least"},
      {"\"id\": \"tile\"", "\"identity\": \"tile\"", "/nodes/tile/id"},
      {"\"width\": 32", "\"width\": 5000", "/metadata/backs/views/0/width"},
      {"\"AQID\"", "\"AQI*\"", "/metadata/as/marks/0/picture"},
      {"\"AQID\"", "\"AQIDBAUG\"", "/metadata/as/marks/0/picture"},
      {"\"x\": 1", "\"x\": 400", "/metadata/as/marks"},
      {"\"view\": 0", "\"view\": 3", "/metadata/as/marks"},
      {"\"solver\": \"colors\"", "\"solver\": \"smell\"", "/nodes/fronts/solvers/0/solver"},
      {"\"tile\": {\"kind\"", "\"tile\": {\"colour\": 1, \"kind\"", "/nodes/tile"},
      {"\"metadata\": {", "\"metadata\": {\"nobody\": {},", "/metadata/nobody"},
      {"\"hints\": {\"turn\": {\"en\"", "\"hints\": {\"turn\": {\"\"", "/hints/turn/"},
  };
  for (const auto& [from, to, place] : faults) {
    try {
      parse_tree("t.json", replaced(good(), from, to));
      ADD_FAILURE() << to;
    } catch (const LoadError& error) {
      EXPECT_EQ(error.file, "t.json");
      EXPECT_TRUE(error.where.starts_with(place)) << error.where << " of " << to;
    }
  }
}

TEST(TreeFile, bytes_that_are_no_tree_are_refused) {
  const std::string text = good();
  for (size_t at = 0; at + 3 < text.size(); at += 3) {
    try {
      parse_tree("t.json", text.substr(0, at));
      ADD_FAILURE() << at;
    } catch (const LoadError&) {}
    std::string changed = text;
    changed[at] = char('a' + at % 26);
    try {
      parse_tree("t.json", changed);
    } catch (const LoadError&) {}
  }
}

TEST(TreeFile, long_chain_of_nodes_is_refused) {
  std::string nodes;
  for (int i = 0; i < 200; i++)
    nodes += "\"n" + std::to_string(i) +
             R"(": {"kind": "search", "solvers": [{"solver": "pattern"}],
      "children": ["n)" +
             std::to_string(i + 1) + "\"]},";
  const std::string text =
      "{\"root\": \"n0\", \"nodes\": {" + nodes + R"("n200": {"kind": "model", "id": "x"}}})";
  EXPECT_THROW(parse_tree("t.json", text), LoadError);
}

}  // namespace
}  // namespace wellspring::test
