// SPDX-License-Identifier: Apache-2.0
#include "show/exhibit/pieces/exhibit_pieces.h"

#include <gtest/gtest.h>

#include "image/image.h"
#include "show/exhibit/load/exhibit_load.h"
#include "show/exhibit/pieces/piece_choices.h"
#include "store/picture/sample_picture.h"
#include "unit/show/exhibit/room_package.h"
#include "world/surface.h"

namespace wellspring::test {
namespace {

// Reads `pieces` into an exhibit with a room, and a picture of 40 x 20: its left half is red, its
// upper half has blue.
struct Pieces {
  Folder folder;
  Exhibit exhibit;
  std::vector<Problem> problems;

  explicit Pieces(const std::string& pieces) {
    Image8 image{40, 20, {}};
    for (int y = 0; y < 20; y++)
      for (int x = 0; x < 40; x++)
        for (int c : {x < 20 ? 200 : 10, 10, y < 10 ? 200 : 10}) image.rgb.push_back(uint8_t(c));
    const std::vector<uint8_t> png = encode_png(image, "", "a.png");
    folder.write("a.png", std::string(png.begin(), png.end()));
    folder.write("b.tif", "II*");
    exhibit.folder = folder.path;
    exhibit.scene.materials.emplace_back().name = "wall";
    exhibit.scene.objects.push_back("");
    exhibit.scene.origin = dvec3(100, 0, 0);
    read_fields(json::parse("{\"pieces\": " + pieces + "}"), "exhibit.json", problems,
                [&](FieldReader& root) { read_pieces(exhibit, root, problems); });
  }
  std::string all() const {
    std::string lines;
    for (const Problem& problem : problems) lines += to_string(problem) + "\n";
    return lines;
  }
  // Returns the base colour where a ray ends.
  vec3 seen(const World& world, dvec3 from, vec3 way) const {
    Ray ray;
    ray.origin = vec3(from - exhibit.scene.origin), ray.direction = way;
    ray.spread = 1e-4f;
    const Hit hit = world.intersect(ray);
    if (!hit.valid()) return vec3(-1);
    return eval_surface(world, ray, hit).base_color;
  }
};

TEST(ExhibitPieces, APictureHangsUprightWhereItIsPut) {
  for (double yaw : {0.0, 90.0, 180.0, -37.0}) {
    Pieces p(R"([{"id": "a", "kind": "picture", "source": "a.png", "width_m": 2,
                  "place": {"position": [103, 1.5, 4], "yaw_deg": )" +
             std::to_string(yaw) + "}, \"label\": {\"en\": \"A\"}}]");
    ASSERT_TRUE(p.problems.empty()) << p.all();
    const World world(p.exhibit.scene);
    const double angle = yaw * pi / 180;
    // It faces this way; who stands there has its left to this side.
    const dvec3 out(-std::sin(angle), 0, -std::cos(angle)), left(-out.z, 0, out.x);
    const dvec3 eye = dvec3(103, 1.5, 4) + out;
    for (int x : {-1, 1})
      for (int y : {-1, 1}) {
        const vec3 color = p.seen(world, eye + left * (0.8 * x) + dvec3(0, 0.4 * y, 0), vec3(-out));
        EXPECT_EQ(color.x > 0.4f, x > 0) << yaw << " " << x << " " << y;
        EXPECT_EQ(color.z > 0.4f, y > 0) << yaw << " " << x << " " << y;
      }
    EXPECT_EQ(p.seen(world, eye + left * 1.1, vec3(-out)), vec3(-1)) << "2 m wide";
    EXPECT_EQ(p.seen(world, eye + dvec3(0, 0.55, 0), vec3(-out)), vec3(-1)) << "1 m high";
    const PointOfInterest& point = p.exhibit.points.at(0);
    EXPECT_EQ(point.title.at("en"), "A");
    EXPECT_LT(glm::length(point.place - dvec3(103, 1.5, 4)), 0.1);
    EXPECT_EQ(p.exhibit.scene.objects.at(point.objects.at(0)), "a");
  }
}

TEST(ExhibitPieces, AFrameSurroundsItAndStandsOut) {
  Pieces p(R"([{"id": "a", "kind": "picture", "source": "a.png", "width_m": 2,
                "place": {"position": [103, 1.5, 4]}, "frame": {"width_m": 0.1, "depth_m": 0.06}}])");
  ASSERT_TRUE(p.problems.empty()) << p.all();
  const Bounds bounds = scene_bounds(p.exhibit.scene);
  EXPECT_NEAR(bounds.high.x - bounds.low.x, 2.2f, 0.02f);
  EXPECT_NEAR(bounds.high.y - bounds.low.y, 1.2f, 0.02f);
  EXPECT_NEAR(bounds.high.z, 4, 1e-4f);
  EXPECT_NEAR(bounds.low.z, 4 - 0.06f, 1e-4f);
  const World world(p.exhibit.scene);
  EXPECT_LT(p.seen(world, dvec3(103 + 1.05, 1.5, 3), vec3(0, 0, 1)).x, 0.2f) << "the frame";
  EXPECT_GT(p.seen(world, dvec3(103 + 0.95, 1.5, 3), vec3(0, 0, 1)).x, 0.4f) << "the picture";
}

TEST(ExhibitPieces, OneThatLiesShowsItsFaceUpwards) {
  Pieces p(R"([{"id": "a", "kind": "picture", "source": "a.png", "width_m": 2,
                "place": {"position": [103, 0.8, 4], "pitch_deg": 90}}])");
  ASSERT_TRUE(p.problems.empty()) << p.all();
  const World world(p.exhibit.scene);
  EXPECT_GT(p.seen(world, dvec3(103 + 0.5, 2, 4.2), vec3(0, -1, 0)).x, 0.4f);
  EXPECT_LT(p.seen(world, dvec3(103 - 0.5, 2, 4.2), vec3(0, -1, 0)).x, 0.1f);
}

TEST(ExhibitPieces, AMaterialOfTheSceneShowsOne) {
  RoomPackage room;
  Image8 image{2, 2, std::vector<uint8_t>(12, 99)};
  const std::vector<uint8_t> png = encode_png(image, "", "a.png");
  room.folder.write("a.png", std::string(png.begin(), png.end()));
  Exhibit exhibit;
  exhibit.folder = room.folder.path;
  Mesh mesh;
  mesh.positions = {vec3(0), vec3(1, 0, 0), vec3(0, 1, 0)};
  mesh.normals.assign(3, vec3(0, 0, 1));
  mesh.uv[0] = {vec2(0), vec2(1, 0), vec2(0, 1)};
  mesh.triangles = {{0, 1, 2}};
  exhibit.scene.materials.emplace_back().name = "canvas";
  exhibit.scene.objects = {"", "easel"};
  exhibit.scene.meshes = {mesh};
  exhibit.scene.instances = {{0, mat4(1), 1}};
  std::vector<Problem> problems;
  read_fields(json::parse(R"({"pieces": [{"id": "a", "kind": "picture", "source": "a.png",
                                          "material": "canvas"}]})"),
              "exhibit.json", problems,
              [&](FieldReader& root) { read_pieces(exhibit, root, problems); });
  EXPECT_TRUE(problems.empty());
  EXPECT_TRUE(exhibit.scene.materials[0].large_picture);
  EXPECT_EQ(exhibit.points.at(0).objects, std::vector<uint32_t>{2});
  EXPECT_EQ(exhibit.scene.instances[0].object, 2u);
  EXPECT_EQ(exhibit.scene.objects[2], "a");
}

TEST(ExhibitPieces, WhatIsWrongIsNamed) {
  Pieces p(R"([{"id": "a", "kind": "picture", "source": "b.tif", "width_m": 1,
                "place": {"position": [0, 0, 0]}},
               {"id": "b", "kind": "picture", "source": "none.png", "place": {"position": [0, 0, 0]}},
               {"id": "c", "kind": "statue", "source": "a.png", "place": {"position": [0, 0, 0]}},
               {"id": "d", "kind": "picture", "source": "a.png"},
               {"id": "e", "kind": "picture", "source": "a.png", "material": "wal"},
               {"id": "d", "kind": "picture", "source": "a.png", "width_m": -1,
                "place": {"position": [0, 0, 0], "yaw_deg": "north"}},
               {"id": "f", "kind": "picture", "source": "../a.png", "place": {}}])");
  const std::string all = p.all();
  for (const char* part :
       {"b.tif: ", "/pieces/1/source", "/pieces/2/kind", "/pieces/3: names neither", "wall",
        "/pieces/5/id", "/pieces/5/width_m", "/pieces/5/place/yaw_deg", "leaves the package",
        "/pieces/6/place/position"})
    EXPECT_NE(all.find(part), std::string::npos) << part << " is not in\n" << all;
}

TEST(ExhibitPieces, WordsOnAMapAreInTheLanguageOfWhoLooks) {
  Pieces p("[]");
  p.exhibit.languages = {"en", "de", "sk"};
  p.folder.write("a.geojson", R"({"type": "Feature", "bbox": [0, 0, 2, 2],
    "properties": {"name": "Town", "name:de": "Stadt"},
    "geometry": {"type": "Point", "coordinates": [1, 1]}})");
  read_fields(json::parse(R"({"pieces": [
      {"id": "map", "kind": "picture", "source": "a.geojson", "width_m": 2,
       "place": {"position": [103, 1.5, 4]}, "label": {"en": "A"}},
      {"id": "photo", "kind": "picture", "source": "a.png", "width_m": 2,
       "place": {"position": [106, 1.5, 4]}, "label": {"en": "A"}}]})"),
              "exhibit.json", p.problems,
              [&](FieldReader& root) { read_pieces(p.exhibit, root, p.problems); });
  ASSERT_TRUE(p.problems.empty()) << p.all();
  EXPECT_EQ(p.exhibit.piece_languages, (std::vector<std::string>{"de"}));
  EXPECT_EQ(piece_language(p.exhibit, "de-AT"), "de");
  EXPECT_EQ(piece_language(p.exhibit, "de"), "de");
  for (const char* other : {"en", "sk", "fr", ""}) EXPECT_EQ(piece_language(p.exhibit, other), "");
  World world(p.exhibit.scene);
  const size_t map = size_t(p.exhibit.pieces[0].image), photo = size_t(p.exhibit.pieces[1].image);
  const auto shown = [&](size_t image) { return world.pictures()[image].base.picture; };
  const auto english = shown(map), plain = shown(photo);
  show_pieces(p.exhibit, {{}, "de"}, world);
  EXPECT_NE(shown(map), english);
  EXPECT_EQ(shown(map), p.exhibit.pieces[0].layers[0].spoken.at("de"));
  EXPECT_NE(shown(map)->source, english->source);
  EXPECT_EQ(shown(map)->coarsest.bytes, english->coarsest.bytes);
  EXPECT_EQ(shown(photo), plain);
  show_pieces(p.exhibit, {}, world);
  EXPECT_EQ(shown(map), english);
}

}  // namespace
}  // namespace wellspring::test
