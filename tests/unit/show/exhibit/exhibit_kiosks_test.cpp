// SPDX-License-Identifier: Apache-2.0
#include "show/exhibit/load/exhibit_story.h"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "unit/folder.h"
#include "unit/show/tiny_exhibit.h"

namespace wellspring::test {
namespace {

std::vector<Problem> read(Exhibit& exhibit, const std::string& text) {
  std::vector<Problem> problems;
  read_fields(nlohmann::json::parse(text), "exhibit.json", problems,
              [&](FieldReader& root) { read_kiosks(exhibit, root); });
  return problems;
}

TEST(ExhibitKiosks, AreReadWithWhatIsLeftOut) {
  Exhibit exhibit = make_tiny_exhibit();
  add_storyteller(exhibit, "anna", {-2, 0, 1});
  EXPECT_TRUE(read(exhibit, R"({"kiosks": [{"name": "hall"}, {"name": "attic", "teller": "anna",
      "viewpoint": "corner", "volume": 0.5,
      "screen": {"width": 1.06, "height": 0.6}, "times": {"farewell": 4, "leave_after": 8}}]})")
                  .empty());
  ASSERT_EQ(exhibit.kiosks.size(), 2u);
  EXPECT_EQ(exhibit.kiosks[0].volume, 1);
  EXPECT_EQ(exhibit.kiosks[0].times.leave_after, 6);
  EXPECT_EQ(exhibit.kiosks[1].teller, "anna");
  EXPECT_EQ(exhibit.kiosks[1].viewpoint, "corner");
  EXPECT_FALSE(exhibit.kiosks[0].screen.known());
  EXPECT_EQ(exhibit.kiosks[1].screen.width, 1.06f);
  EXPECT_EQ(exhibit.kiosks[1].screen.height, 0.6f);
  EXPECT_EQ(exhibit.kiosks[1].times.farewell, 4);
  EXPECT_EQ(exhibit.kiosks[1].times.leave_after, 8);
  EXPECT_EQ(exhibit.kiosks[1].times.sleep_after, 30);
}

TEST(ExhibitKiosks, WhatIsWrongIsNamed) {
  Exhibit exhibit = make_tiny_exhibit();
  const std::vector<Problem> problems = read(exhibit, R"({"kiosks": [{}, {"name": "a"},
      {"name": "a", "viewpoint": "moon", "teller": "otto", "volume": 2, "times": {"farewell": -1}},
      {"name": "b", "times": {"naps": 3}}, {"name": "c", "screen": {"width": 106}},
      {"name": "d", "screen": {"width": 1, "height": 0, "depth": 1}}]})");
  std::string all;
  for (const Problem& problem : problems) all += to_string(problem) + "\n";
  for (const char* place :
       {"/kiosks/0/name", "/kiosks/2/name", "/kiosks/2/viewpoint", "/kiosks/2/teller",
        "/kiosks/2/volume", "/kiosks/2/times/farewell", "/kiosks/3/times/naps",
        "/kiosks/4/screen/width", "/kiosks/4/screen/height", "/kiosks/5/screen/height",
        "/kiosks/5/screen/depth"})
    EXPECT_NE(all.find(place), std::string::npos) << place << " is not in\n" << all;
}

TEST(ExhibitKiosks, TheStationIsAFileOfThePackage) {
  Folder folder;
  Exhibit exhibit = make_tiny_exhibit();
  exhibit.folder = folder.path.string();
  auto read_tree = [&](const std::string& tree, const std::string& name = "tree.json") {
    std::ofstream(folder.file("tree.json")) << tree;
    exhibit.files.clear(), exhibit.kiosks.clear();
    const auto problems =
        read(exhibit, R"({"kiosks": [{"name": "hall", "station": ")" + name + "\"}]}");
    return problems.empty() ? std::string() : to_string(problems[0]);
  };
  EXPECT_EQ(read_tree(R"({"root": "a", "nodes": {"a": {"kind": "search", "id": "coins"},
      "b": {"kind": "model", "id": "as"}, "c": {"kind": "model"}, "d": 7}})"),
            "");
  EXPECT_EQ(exhibit.kiosks[0].station, "tree.json");
  EXPECT_EQ(exhibit.kiosks[0].held, std::vector<std::string>{"as"});
  EXPECT_EQ(exhibit.files.at("tree.json").type, "application/json");
  for (const auto& [tree, word] :
       {std::pair("[]", "recognition tree"), std::pair("{\"a\": ", "tree"),
        std::pair("{\"nodes\": 3}", "nodes"), std::pair("", "tree")}) {
    const std::string problem = read_tree(tree);
    EXPECT_NE(problem.find("/kiosks/0/station"), std::string::npos) << problem;
    EXPECT_NE(problem.find(word), std::string::npos) << problem;
  }
  EXPECT_NE(read_tree("{}", "other.json").find("/kiosks/0/station"), std::string::npos);
  EXPECT_NE(read_tree("{}", "../tree.json").find("leaves"), std::string::npos);
}

}  // namespace
}  // namespace wellspring::test
