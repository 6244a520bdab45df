// SPDX-License-Identifier: Apache-2.0
// Labels and the map over HTTP, and what a browser sees that asks for nothing that there is.
#include "show/answer/objects.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "show/http/answer.h"
#include "show/visit/tour.h"
#include "unit/show/show_stage.h"

namespace wellspring::test {
namespace {

using nlohmann::json;

struct ObjectsTest : testing::Test {
  Exhibit exhibit = make_tiny_exhibit(dvec3(50, 0, 0));
  std::map<std::string, PageFile> pages;
  ReportBoard board;
  std::unique_ptr<World> world;
  TourRoads roads;
  AnswerSources sources;

  void SetUp() override {
    PointOfInterest& lamp = exhibit.points.emplace_back();
    lamp.id = "lamp";
    lamp.title = {{"en", "Lamp"}, {"de", "Lampe"}};
    lamp.text = {{"en", "It shines."}};
    lamp.story = "tale";
    lamp.manifest = "https://example.org/m";
    lamp.provenance = {{"date", {{"de", "heute"}, {"en", "today"}}}, {"creator", {{"en", "me"}}}};
    exhibit.points.emplace_back().id = "nameless";
    world = std::make_unique<World>(exhibit.scene);
    std::vector<Problem> problems;
    roads = make_tour_roads(exhibit, *world, problems);
    sources.exhibits = {{&exhibit, &board, {}, &*roads.map}};
    sources.pages = &pages;
  }
  HttpReply ask(const std::string& path, const std::string& accept = "") {
    HttpQuestion question{.method = "GET", .path = path, .accept = accept};
    return answer(sources, question);
  }
};

TEST_F(ObjectsTest, AreDescribedInAllLanguagesAndInOne) {
  json all = json::parse(ask("/api/v1/exhibits/tiny").body)["objects"];
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0]["title"]["de"], "Lampe");
  EXPECT_EQ(all[0]["story"], "tale");
  EXPECT_EQ(all[0]["manifest"], "https://example.org/m");
  EXPECT_FALSE(all[1].contains("provenance"));
  json one = describe_objects(exhibit, "de");
  ASSERT_EQ(one.size(), 1u) << "what has no name is not offered";
  EXPECT_EQ(one[0]["title"], "Lampe");
  EXPECT_EQ(one[0]["text"], "It shines.") << "of the exhibit's first language";
  EXPECT_EQ(
      one[0]["provenance"],
      json::parse(R"([{"element":"creator","value":"me"},{"element":"date","value":"heute"}])"));
}

TEST_F(ObjectsTest, TheMapShowsRoomWallsAndPlaces) {
  json map = json::parse(ask("/api/v1/exhibits/tiny/map").body);
  auto cell = [&](double x, double z) {  // metres from the room's middle, which is at x = 50
    int column =
        int(std::lround((50 + x - map["corner"][0].get<double>()) / map["cell"].get<double>()));
    int row = int(std::lround((z - map["corner"][1].get<double>()) / map["cell"].get<double>()));
    return map["rows"][size_t(row)].get<std::string>()[size_t(column)];
  };
  EXPECT_EQ(cell(-2, 2), 'o');
  EXPECT_EQ(cell(-2, -2), 'o');
  EXPECT_EQ(cell(-2, 0.1), 'x') << "the wall across";
  EXPECT_EQ(cell(2, 0), 'o') << "its opening";
  EXPECT_EQ(map["viewpoints"].size(), 2u);
  EXPECT_EQ(map["viewpoints"][0]["name"], "door");
  EXPECT_EQ(map["viewpoints"][0]["position"], (json{48, 1.6, 3}));
  EXPECT_LE(map["rows"].size(), 240u);
  sources.exhibits.front().walk_map = nullptr;
  EXPECT_EQ(ask("/api/v1/exhibits/tiny/map").status, 404);
}

TEST_F(ObjectsTest, WhatIsToldCanBeRead) {
  ExhibitViewpoint& end = exhibit.viewpoints.back();
  end.title = {{"en", "The end"}};
  StoryLine line{.text = "It began here."};
  line.marks.push_back({StoryMarkKind::gesture, 3, "wave", 1, {}});
  exhibit.stories = {
      {"tale", {{"en", "A tale"}}, {{"en", {line, {.text = "And ended."}}}}, {}, -1}};
  TourStop stop{.viewpoint = int(exhibit.viewpoints.size()) - 1,
                .way_text = {{"de", {{.text = "Komm mit."}}}}};
  exhibit.tours = {{"round", {{"en", "Round"}}, {stop}}};
  json all = json::parse(ask("/api/v1/exhibits/tiny/transcript").body);
  EXPECT_EQ(all["stories"], json::parse(R"([{"id": "tale", "title": {"en": "A tale"},
      "text": {"en": ["It began here.", "And ended."]}}])"));
  EXPECT_EQ(all["tours"], json::parse(R"([{"id": "round", "title": {"en": "Round"}, "stops":
      [{"title": {"en": "The end"}, "way_text": {"de": ["Komm mit."]}, "text": {}}]}])"));
}

TEST_F(ObjectsTest, APersonsBrowserIsToldKindlyThatThereIsNothing) {
  pages["/missing.html"] = {"text/html", "<h1>Nothing</h1>", "\"tag\""};
  const char* browser = "text/html,application/xhtml+xml,*/*;q=0.8";
  HttpReply page = ask("/nothing", browser);
  EXPECT_EQ(page.status, 404);
  EXPECT_EQ(page.content_type, "text/html");
  EXPECT_EQ(page.body, "<h1>Nothing</h1>");
  for (const char* accept : {"", "*/*", "application/json", "application/json, text/html"}) {
    HttpReply reply = ask("/nothing", accept);
    EXPECT_EQ(reply.status, 404);
    EXPECT_EQ(json::parse(reply.body)["error"]["code"], "not_found") << accept;
  }
}

}  // namespace
}  // namespace wellspring::test
