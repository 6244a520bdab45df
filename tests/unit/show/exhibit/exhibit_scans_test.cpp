// SPDX-License-Identifier: Apache-2.0
#include "show/exhibit/pieces/exhibit_scans.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "show/exhibit/pieces/exhibit_annotations.h"
#include "show/exhibit/pieces/exhibit_pieces.h"
#include "show/exhibit/pieces/exhibit_volumes.h"
#include "scan/format/open_scan.h"
#include "scan/tree/import/write_tree.h"
#include "show/exhibit/json_fields.h"
#include "show/exhibit/pieces/piece_choices.h"
#include "show/visit/good_view.h"
#include "unit/show/exhibit/room_package.h"
#include "wire/messages.h"

namespace wellspring::test {
namespace {

// Writes a floor of 2 x 2 m, z up, with a wall at its end 1 m high, far from the file's zero.
void write_cloud(const Folder& folder, const char* name, double lower) {
  std::string text;
  auto add = [&](double x, double y, double z) {
    text += std::to_string(4'000'000 + x) + " " + std::to_string(y) + " " +
            std::to_string(z - lower) + " 200 100 50\n";
  };
  for (int x = 0; x <= 40; x++)
    for (int y = 0; y <= 40; y++) add(0.05 * x, 0.05 * y, 0);
  for (int x = 0; x <= 40; x++)
    for (int z = 1; z <= 20; z++) add(0.05 * x, 2, 0.05 * z);
  folder.write(name, text);
}

struct Scans {
  Folder folder;
  Exhibit exhibit;
  std::vector<Problem> problems;

  explicit Scans(const std::string& piece) {
    write_cloud(folder, "cloud.xyz", 0);
    write_cloud(folder, "deeper.xyz", 2);
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
  ASSERT_EQ(piece.sets.size(), 1u);
  EXPECT_EQ(piece.sets[0].points->points, 41u * 41 + 41 * 20);
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

TEST(ExhibitScans, ADigIsSeenAtSeveralTimes) {
  const std::string times = R"({"id": "a", "kind": "scan", "sphere_m": 0.02,
      "place": {"position": [100, 1, 0]}, "times": [{"year": 1990, "source": "cloud.xyz"},
      {"year": 2020, "source": "deeper.xyz", "colors": "lit", "label": {"en": "Now"}}TWICE]})";
  auto with = [&](const char* more) {
    std::string all = times;
    return all.replace(all.find("TWICE"), 5, more);
  };
  const Scans s(with(""));
  ASSERT_TRUE(s.problems.empty()) << s.all();
  const ExhibitPiece& piece = s.exhibit.pieces.at(0);
  ASSERT_EQ(piece.sets.size(), 2u);
  ASSERT_EQ(piece.layers.size(), 2u);
  EXPECT_EQ(piece.layers[1].year, 2020);
  // Files share one frame: the second lies 2 m lower than the first, so the box reaches from its
  // floor to the first one's wall.
  const Bounds bounds = bounds_of_scan(s.exhibit, piece);
  EXPECT_NEAR(bounds.high.y - bounds.low.y, 3, 0.01f);
  World world(s.exhibit.scene);
  place_scans(s.exhibit, world);
  const PlacedScan& placed = world.scans()[0];
  EXPECT_EQ(placed.look.set, 0);
  EXPECT_FLOAT_EQ(placed.sphere, 0.02f);
  const double first = placed.sets[0].points->origin.y;
  EXPECT_NEAR(placed.sets[1].points->origin.y - first, placed.sets[1].offset.y, 1e-9);
  PieceChoices choices(1);
  choices[0].layer = 1;
  show_pieces(s.exhibit, {choices, ""}, world);
  EXPECT_EQ(world.scans()[0].look.set, 1);
  EXPECT_EQ(world.scans()[0].look.colors, ScanColors::lit);
  const Scans twice(with(R"(, {"year": 1990, "source": "cloud.xyz"})"));
  EXPECT_NE(twice.all().find("times/2/year"), std::string::npos) << twice.all();
  const Scans missing(with(R"(, {"year": 1991, "source": "none.xyz"})"));
  EXPECT_NE(missing.all().find("none.xyz"), std::string::npos) << missing.all();
  const Scans looks(with(R"(], "looks": [{"id": "x", "label": {"en": "X"}})"));
  EXPECT_NE(looks.all().find("exclude one another"), std::string::npos) << looks.all();
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

// Chooses as a message does; returns how it looks then.
ScanLook look_after(const Scans& s, const PieceOrder& order) {
  PieceChoices choices;
  EXPECT_EQ(choose_piece(s.exhibit, order, choices), "");
  World world(s.exhibit.scene);
  place_scans(s.exhibit, world);
  show_pieces(s.exhibit, {choices, ""}, world);
  return world.scans()[0].look;
}

TEST(ExhibitScans, SlidersAndPlanesCutAsTheyCutVolumes) {
  const Scans s(cloud(R"(, "size_m": 2)"));
  PieceOrder order{.name = "a"};
  order.high = {1, 0.25f, 1};
  const ScanLook low = look_after(s, order);
  // It is 2 m high, from 1 m on: half a metre is left.
  ASSERT_EQ(low.cuts.size(), 1u);
  EXPECT_NEAR(low.cuts[0].normal.y, -1, 1e-6f);
  EXPECT_NEAR(low.cuts[0].offset, -1.5f, 0.01f);
  order.high = vec3(1), order.plane = {0, 3, 0, 0.4f};
  const ScanLook plane = look_after(s, order);
  ASSERT_EQ(plane.cuts.size(), 1u);
  EXPECT_NEAR(plane.cuts[0].normal.y, 1, 1e-6f);
  EXPECT_NEAR(plane.cuts[0].offset, 2 + 0.4f, 0.01f) << "0.4 m above its middle";
  EXPECT_TRUE(look_after(s, PieceOrder{.name = "a", .turn = 30}).cuts.empty());
}

TEST(ExhibitScans, AGlassCutsAwayAllThatIsNearer) {
  // Turned round, so that its own axes are not the scene's.
  Scans s(cloud(""));
  s.exhibit.pieces[0].yaw = 0.5f * pi;
  World world(s.exhibit.scene);
  LensOrder order;
  order.depth = 0.5f;
  auto cut = [&](vec3 eye) {
    PieceChoices choices;
    cut_ahead(s.exhibit, order, {eye, 0, {0, 0, -1}}, choices);
    const ScanLook look = look_of(s.exhibit, s.exhibit.pieces[0], choices[0]);
    EXPECT_EQ(look.cuts.size(), 1u);
    EXPECT_NEAR(look.cuts[0].normal.z, -1, 1e-5f);
    return -look.cuts[0].offset;
  };
  EXPECT_NEAR(cut({0.2f, 1.5f, 0.6f}), 0.1f, 0.01f) << "from within, before the eye";
  EXPECT_NEAR(cut({0.2f, 1.5f, 4}), 0.5f, 0.01f) << "from outside, from where it begins";
}

TEST(ExhibitScans, WhoPointsPassesWhatIsCutAway) {
  const Scans s(cloud(""));
  World world(s.exhibit.scene);
  place_scans(s.exhibit, world);
  const View view =
      make_view_towards(s.exhibit.scene, {100, 1.5, 0.9}, {100, 1.5, 0}, {0, 1, 0}, 0.8f, 64, 64);
  const auto wall = point_at(s.exhibit, world, view, {0.5f, 0.5f});
  ASSERT_TRUE(wall);
  EXPECT_NEAR(wall->place.z, -1, 0.02f);
  ScanLook look;
  look.cuts = {{{0, 0, 1}, -0.5f}};
  world.show_scan(0, look);
  EXPECT_FALSE(point_at(s.exhibit, world, view, {0.5f, 0.5f}));
}

TEST(ExhibitScans, PlacesAreKnownInTheFilesOwnCoordinates) {
  const Scans s(cloud(R"(, "size_m": 3)"));
  const glm::dmat4 to_world = file_to_world(s.exhibit.pieces[0]);
  // The corner of floor and wall: survey coordinates of millions of metres, three times as large.
  const dvec3 corner(to_world * glm::dvec4(4'000'002, 2, 0, 1));
  EXPECT_NEAR(glm::distance(corner, dvec3(103, 1, -3)), 0, 2e-3);
  const dvec3 back(glm::inverse(to_world) * glm::dvec4(corner, 1));
  EXPECT_NEAR(glm::distance(back, dvec3(4'000'002, 2, 0)), 0, 1e-6);
}

TEST(ExhibitScans, SpheresLieInSmallNodesWhichHideOneAnother) {
  std::string text;
  for (int x = 0; x < 100; x++)
    for (int y = 0; y < 100; y++) text += fmt::format("{} {} 0\n", 0.02 * x, 0.02 * y);
  for (const bool spheres : {false, true}) {
    Folder folder;
    folder.write("plane.xyz", text);
    Exhibit exhibit;
    exhibit.folder = folder.path, exhibit.languages = {"en"};
    exhibit.scene.objects.push_back("");
    exhibit.scene.materials.emplace_back();
    std::vector<Problem> problems;
    const std::string piece = cloud(spheres ? R"(, "sphere_m": 0.01)" : "", "plane.xyz");
    read_fields(json::parse("{\"pieces\": [" + piece + "]}"), "exhibit.json", problems,
                [&](FieldReader& root) { read_pieces(exhibit, root, problems); });
    ASSERT_TRUE(problems.empty()) << to_string(problems[0]);
    const PointTree& tree = *exhibit.pieces[0].sets[0].points;
    EXPECT_EQ(tree.nodes.size() > 1, spheres);
    for (const TreeNode& node : tree.nodes)
      if (spheres && node.is_leaf()) EXPECT_LE(node.count, 3000u);
  }
}

// A tree remembers how its files lay when they were imported.
TEST(ExhibitScans, PlacesOfImportedTreesAreThoseOfTheirFilesHoweverTheseLay) {
  for (const UpAxis up : {UpAxis::x, UpAxis::y, UpAxis::z})
    for (const double turn : {0.0, 0.7}) {
      const Folder folder;
      // A floor of 2 x 1 m across the axis that points up, and a post 1 m high at its far corner.
      const int axis = int(up), one = (axis + 1) % 3, two = (axis + 2) % 3;
      dvec3 zero(4'000'000, 20, 300), top = zero;
      top[one] += 2, top[two] += 1, top[axis] += 1;
      std::string text;
      const auto add = [&](double a, double b, double c) {
        dvec3 at = zero;
        at[one] += a, at[two] += b, at[axis] += c;
        text += fmt::format("{} {} {}\n", at.x, at.y, at.z);
      };
      for (int a = 0; a <= 40; a++)
        for (int b = 0; b <= 20; b++) add(0.05 * a, 0.05 * b, 0);
      for (int c = 1; c <= 20; c++) add(2, 1, 0.05 * c);
      const std::string file = folder.write("cloud.xyz", text);
      TreeSettings settings;
      settings.up = up, settings.turn = turn;
      write_tree({{file, [file] { return open_scan(file); }}}, folder.file("a.points"), settings);
      Exhibit exhibit;
      exhibit.folder = folder.path, exhibit.languages = {"en"};
      exhibit.scene.objects.push_back("");
      exhibit.scene.materials.emplace_back();
      std::vector<Problem> problems;
      read_fields(json::parse("{\"pieces\": [" + cloud("", "a.points") + "]}"), "exhibit.json",
                  problems, [&](FieldReader& root) { read_pieces(exhibit, root, problems); });
      ASSERT_TRUE(problems.empty()) << to_string(problems[0]);
      const dvec3 at(file_to_world(exhibit.pieces[0]) * glm::dvec4(top, 1));
      // The post's end is the highest place of the scan.
      const Bounds bounds = bounds_of_scan(exhibit, exhibit.pieces[0]);
      EXPECT_NEAR(at.y, double(bounds.high.y), 2e-3) << axis << " " << turn;
      World world(exhibit.scene);
      place_scans(exhibit, world);
      const Hit post = world.intersect({vec3(at) + vec3(0, 1, 0), 0, {0, -1, 0}});
      EXPECT_TRUE(post.valid()) << axis << " " << turn;
      const Hit beside = world.intersect({vec3(at) + vec3(0.6f, 1, 0), 0, {0, -1, 0}});
      EXPECT_GT(beside.t, 1.9f) << axis << " " << turn;
    }
}

TEST(ExhibitScans, NotesLieAtPlacesInItsCoordinates) {
  Scans s(cloud(""));
  s.folder.write("notes.json", R"({"type": "AnnotationPage", "items": [
      {"body": {"value": "A crack", "language": "en"}, "target": {"source": "a", "selector":
          [{"type": "PointSelector", "x": 4000001, "y": 2, "z": 0.5}]}},
      {"body": {"value": "Far", "language": "en"}, "target": {"selector":
          {"type": "PointSelector", "x": 1, "y": 2, "z": 0.5}}},
      {"body": {"value": "Flat", "language": "en"}, "target": "a#xywh=0,0,1,1"}]})");
  std::vector<Problem> problems;
  const PointOfInterest whole = s.exhibit.points[0];
  read_annotations(s.exhibit, s.exhibit.pieces[0], (s.folder.path / "notes.json").string(), whole,
                   problems);
  ASSERT_EQ(s.exhibit.points.size(), 2u);
  const PointOfInterest& note = s.exhibit.points[1];
  EXPECT_EQ(note.id, "a.1");
  EXPECT_EQ(note.title.at("en"), "A crack");
  EXPECT_EQ(note.objects, s.exhibit.points[0].objects);
  EXPECT_NEAR(glm::distance(note.place, dvec3(100, 1.5, -1)), 0, 2e-3);
  std::string all;
  for (const Problem& problem : problems) all += to_string(problem) + "\n";
  EXPECT_NE(all.find("lies outside the scan"), std::string::npos) << all;
  EXPECT_NE(all.find("says no place of the scan"), std::string::npos) << all;
}

}  // namespace
}  // namespace wellspring::test
