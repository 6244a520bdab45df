// SPDX-License-Identifier: Apache-2.0
#include "show/exhibit/exhibit_scans.h"

#include <gtest/gtest.h>

#include "show/exhibit/exhibit_pieces.h"
#include "show/exhibit/json_fields.h"
#include "show/exhibit/piece_choices.h"
#include "show/visit/good_view.h"
#include "unit/show/exhibit/room_package.h"

namespace wellspring::test {
namespace {

// Writes a floor of 2 x 2 m, z up, with a wall at its end 1 m high, far from the file's zero.
void write_cloud(const Folder& folder) {
  std::string text;
  auto add = [&](double x, double y, double z) {
    text += std::to_string(4'000'000 + x) + " " + std::to_string(y) + " " + std::to_string(z) +
            " 200 100 50\n";
  };
  for (int x = 0; x <= 40; x++)
    for (int y = 0; y <= 40; y++) add(0.05 * x, 0.05 * y, 0);
  for (int x = 0; x <= 40; x++)
    for (int z = 1; z <= 20; z++) add(0.05 * x, 2, 0.05 * z);
  folder.write("cloud.xyz", text);
}

struct Scans {
  Folder folder;
  Exhibit exhibit;
  std::vector<Problem> problems;

  explicit Scans(const std::string& piece) {
    write_cloud(folder);
    folder.write("broken.xyz", "1 2 three\n");
    exhibit.folder = folder.path;
    exhibit.languages = {"en"};
    exhibit.scene.objects.push_back("");
    exhibit.scene.materials.emplace_back();
    exhibit.scene.origin = dvec3(100, 0, 0);
    read_fields(json::parse("{\"pieces\": [" + piece + "]}"), "exhibit.json", problems,
                [&](FieldReader& root) { read_pieces(exhibit, root, problems); });
  }
  std::string all() const {
    std::string lines;
    for (const Problem& problem : problems) lines += to_string(problem) + "\n";
    return lines;
  }
};

std::string cloud(const std::string& more, const std::string& source = "cloud.xyz") {
  return R"({"id": "a", "kind": "scan", "source": ")" + source +
         R"(", "label": {"en": "A"}, "place": {"position": [100, 1, 0]})" + more + "}";
}

TEST(ExhibitScans, AScanStandsOnItsPlaceWithTheMeshThatRaysMeet) {
  const Scans s(cloud(""));
  ASSERT_TRUE(s.problems.empty()) << s.all();
  const ExhibitPiece& piece = s.exhibit.pieces.at(0);
  ASSERT_TRUE(piece.points);
  EXPECT_EQ(piece.points->points, 41u * 41 + 41 * 20);
  ASSERT_EQ(piece.layers.size(), 1u);
  EXPECT_EQ(piece.layers[0].colors, ScanColors::captured);
  // Its box is 2 x 1 x 2 m; the middle of the underside is the place.
  const Bounds bounds = bounds_of_scan(s.exhibit, piece);
  EXPECT_NEAR(distance(bounds.low, vec3(-1, 1, -1)), 0, 0.01f);
  EXPECT_NEAR(distance(bounds.high, vec3(1, 2, 1)), 0, 0.01f);
  World world(s.exhibit.scene);
  place_scans(s.exhibit, world);
  ASSERT_EQ(world.scans().size(), 1u);
  const Hit floor = world.intersect({{0.3f, 2, 0.3f}, 0, {0, -1, 0}});
  ASSERT_TRUE(floor.valid());
  EXPECT_NEAR(floor.t, 1, 0.01f);
  EXPECT_EQ(int(floor.instance), world.scans()[0].stand_in);
  // The file's +y lies to -z once z is up.
  const Hit wall = world.intersect({{0.3f, 1.5f, 0}, 0, {0, 0, -1}});
  ASSERT_TRUE(wall.valid());
  EXPECT_NEAR(wall.t, 1, 0.05f);
}

TEST(ExhibitScans, WhoPointsAtAScanMeansIt) {
  const Scans s(cloud(""));
  World world(s.exhibit.scene);
  place_scans(s.exhibit, world);
  View view =
      make_view_towards(s.exhibit.scene, {100, 2.5, 0.8}, {100, 1, 0}, {0, 1, 0}, 0.8f, 64, 64);
  const auto pointed = point_at(s.exhibit, world, view, {0.5f, 0.5f});
  ASSERT_TRUE(pointed);
  EXPECT_EQ(pointed->point, 0);
  EXPECT_NEAR(pointed->place.y, 1, 0.02f);
}

TEST(ExhibitScans, LooksAreChosenAsLayers) {
  const Scans s(cloud(R"(, "brightness": 2, "looks": [
      {"id": "lit", "colors": "lit", "label": {"en": "Lit"}},
      {"id": "high", "colors": "height", "label": {"en": "By height"}}])"));
  ASSERT_TRUE(s.problems.empty()) << s.all();
  World world(s.exhibit.scene);
  place_scans(s.exhibit, world);
  EXPECT_EQ(world.scans()[0].look.colors, ScanColors::lit);
  EXPECT_EQ(world.scans()[0].look.brightness, 1);
  PieceChoices choices(1);
  choices[0].layer = 1;
  show_pieces(s.exhibit, {choices, ""}, world);
  EXPECT_EQ(world.scans()[0].look.colors, ScanColors::height);
  EXPECT_EQ(world.scans()[0].look.brightness, 2);
}

TEST(ExhibitScans, ASizeIsTheHeightAndAnotherAxisMayPointUp) {
  const Scans s(cloud(R"(, "size_m": 5)"));
  const Bounds tall = bounds_of_scan(s.exhibit, s.exhibit.pieces.at(0));
  EXPECT_NEAR(tall.high.y - tall.low.y, 5, 0.01f);
  EXPECT_NEAR(tall.high.x - tall.low.x, 10, 0.05f);
  const Scans lying(cloud(R"(, "up": "y")"));
  const Bounds flat = bounds_of_scan(lying.exhibit, lying.exhibit.pieces.at(0));
  EXPECT_NEAR(flat.high.y - flat.low.y, 2, 0.01f);
}

TEST(ExhibitScans, WhatIsWrongIsNamed) {
  const Scans broken(cloud("", "broken.xyz"));
  ASSERT_FALSE(broken.problems.empty());
  EXPECT_NE(broken.all().find("broken.xyz: line 1"), std::string::npos) << broken.all();
  const Scans missing(cloud("", "none.las"));
  EXPECT_FALSE(missing.problems.empty());
  const Scans twice(cloud(
      R"(, "looks": [{"id": "x", "label": {"en": "X"}}, {"id": "x", "label": {"en": "X"}}])"));
  EXPECT_NE(twice.all().find("another look 'x'"), std::string::npos) << twice.all();
  const Scans below(cloud(R"(, "up": "-z")"));
  EXPECT_NE(below.all().find("only for splats"), std::string::npos) << below.all();
}

}  // namespace
}  // namespace wellspring::test
