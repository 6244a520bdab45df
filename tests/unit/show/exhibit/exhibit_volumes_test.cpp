// SPDX-License-Identifier: Apache-2.0
#include "show/exhibit/pieces/exhibit_volumes.h"

#include <gtest/gtest.h>

#include "image/image.h"
#include "show/exhibit/pieces/exhibit_pieces.h"
#include "show/exhibit/json_fields.h"
#include "unit/show/exhibit/room_package.h"
#include "wire/messages.h"

namespace wellspring::test {
namespace {

// Writes a scan of 20 x 10 x 30 samples of 2 mm: air, and in its middle 500.
void write_scan(const Folder& folder) {
  std::string bytes =
      "NRRD0004\ntype: short\ndimension: 3\nsizes: 20 10 30\nendian: little\n"
      "encoding: raw\nspace: left-posterior-superior\n"
      "space directions: (2,0,0) (0,2,0) (0,0,2)\n\n";
  for (int z = 0; z < 30; z++)
    for (int y = 0; y < 10; y++)
      for (int x = 0; x < 20; x++) {
        const bool inside = x > 4 && x < 15 && y > 2 && y < 7 && z > 4 && z < 25;
        const int16_t value = inside ? (x < 10 ? 500 : 1500) : -1000;
        bytes.append(reinterpret_cast<const char*>(&value), 2);
      }
  folder.write("scan.nrrd", bytes);
}

struct Volumes {
  Folder folder;
  Exhibit exhibit;
  std::vector<Problem> problems;

  explicit Volumes(const std::string& piece) {
    write_scan(folder);
    folder.write("broken.nrrd", "NRRD0004\ntype: short\n");
    exhibit.folder = folder.path;
    exhibit.languages = {"en"};
    exhibit.scene.objects.push_back("");
    exhibit.scene.origin = dvec3(100, 0, 0);
    read_fields(json::parse("{\"pieces\": [" + piece + "]}"), "exhibit.json", problems,
                [&](FieldReader& root) { read_pieces(exhibit, root, problems); });
  }
  int says(const std::string& where, const std::string& what) const {
    int count = 0;
    for (const Problem& problem : problems)
      count += problem.where == where && problem.what.find(what) != std::string::npos;
    return count;
  }
  std::string all() const {
    std::string lines;
    for (const Problem& problem : problems) lines += to_string(problem) + "\n";
    return lines;
  }
};

constexpr const char* place = R"("place": {"position": [101, 1, 2], "yaw_deg": 90})";

std::string scan(const std::string& more) {
  return R"({"id": "a", "kind": "volume", "source": "scan.nrrd", "label": {"en": "A"}, )" + more +
         "}";
}

TEST(ExhibitVolumes, AScanStandsOnItsPlaceInItsSize) {
  const Volumes v(scan(place));
  ASSERT_TRUE(v.problems.empty()) << v.all();
  const ExhibitPiece& piece = v.exhibit.pieces.at(0);
  ASSERT_TRUE(piece.volume);
  const PlacedVolume placed = place_volume(v.exhibit, piece);
  EXPECT_NEAR(distance(placed.position, vec3(1, 1.03f, 2)), 0, 1e-5f);
  EXPECT_NEAR(distance(size_of(piece), vec3(0.04f, 0.06f, 0.02f)), 0, 1e-5f);
  EXPECT_EQ(placed.scale, 1);
  EXPECT_EQ(v.exhibit.scene.objects.at(placed.object), "a");
  ASSERT_EQ(v.exhibit.points.size(), 1u);
  EXPECT_NEAR(distance(vec3(v.exhibit.points[0].place), vec3(101, 1.03f, 2)), 0, 1e-4f);
}

TEST(ExhibitVolumes, ASizeIsTheHeight) {
  const Volumes v(scan(std::string(place) + R"(, "size_m": 1.2)"));
  ASSERT_TRUE(v.problems.empty()) << v.all();
  EXPECT_NEAR(size_of(v.exhibit.pieces[0]).y, 1.2f, 1e-5f);
  EXPECT_NEAR(size_of(v.exhibit.pieces[0]).x, 0.8f, 1e-5f);
}

TEST(ExhibitVolumes, PresetsAreFoundWhereNoneAreNamed) {
  const Volumes v(scan(place));
  const std::vector<PieceLayer>& layers = v.exhibit.pieces.at(0).layers;
  ASSERT_GE(layers.size(), 3u);
  EXPECT_EQ(layers.front().id, "outside");
  for (const PieceLayer& layer : layers) {
    EXPECT_TRUE(layer.preset);
    EXPECT_FALSE(layer.label.empty());
    EXPECT_TRUE(layer.label.contains("de"));
  }
}

TEST(ExhibitVolumes, PresetsAreData) {
  const Volumes v(scan(std::string(place) + R"(, "presets": [
      {"id": "skin", "label": {"en": "Skin"}, "mode": "surface",
       "points": [{"value": -200, "color": [0.5, 0.4, 0.3]}]},
      {"id": "core", "label": {"en": "Core"}, "find": "bone"}])"));
  ASSERT_TRUE(v.problems.empty()) << v.all();
  const std::vector<PieceLayer>& layers = v.exhibit.pieces.at(0).layers;
  ASSERT_EQ(layers.size(), 2u);
  EXPECT_EQ(layers[0].preset->mode, VolumeMode::surface);
  EXPECT_EQ(layers[0].preset->points.at(0).value, -200);
  EXPECT_EQ(layers[0].preset->points.at(0).color, vec3(0.5f, 0.4f, 0.3f));
  EXPECT_GT(layers[1].preset->points.at(0).value, 500);
}

TEST(ExhibitVolumes, WhatIsWrongIsNamed) {
  EXPECT_EQ(Volumes(scan(R"("size_m": 1)")).says("/pieces/0", "place"), 1);
  const Volumes broken(R"({"id": "a", "kind": "volume", "source": "broken.nrrd", )" +
                       std::string(place) + "}");
  ASSERT_FALSE(broken.problems.empty());
  EXPECT_NE(broken.problems[0].file.find("broken.nrrd"), std::string::npos) << broken.all();
  EXPECT_EQ(Volumes(R"({"id": "a", "kind": "volume", )" + std::string(place) + "}")
                .says("/pieces/0/source", "missing"),
            1);
  const std::string begin = std::string(place) + R"(, "presets": [{"id": "x", "label": "X", )";
  EXPECT_EQ(Volumes(scan(begin + R"("points": []}])")).says("/pieces/0/presets/0/points", "value"),
            1);
  EXPECT_EQ(Volumes(scan(begin + R"("points": [{"value": 5}, {"value": 4}]}])"))
                .says("/pieces/0/presets/0/points/1/value", "less"),
            1);
  EXPECT_EQ(
      Volumes(scan(begin + R"("find": "light"}])")).says("/pieces/0/presets/0/find", "no such"), 1);
}

TEST(ExhibitVolumes, ANebulaIsMadeOfItsPicture) {
  Volumes v("");
  Image8 image{48, 32, {}};
  for (int y = 0; y < 32; y++)
    for (int x = 0; x < 48; x++) {
      const float r = std::hypot(float(x) - 23.5f, 1.6f * (float(y) - 15.5f));
      const auto light = uint8_t(std::clamp(250 - 14 * r, 0.0f, 250.0f));
      image.rgb.insert(image.rgb.end(), {light, uint8_t(light / 2), uint8_t(light / 3)});
    }
  const std::vector<uint8_t> png = encode_png(image, "", "a.png");
  v.folder.write("cloud.png", std::string(png.begin(), png.end()));
  read_fields(json::parse(R"({"pieces": [{"id": "n", "kind": "volume", "source": "cloud.png",
      "nebula": {"angle_deg": 0, "tilt_deg": 30}, "size_m": 0.5, )" +
                          std::string(place) + "}]}"),
              "exhibit.json", v.problems,
              [&](FieldReader& root) { read_pieces(v.exhibit, root, v.problems); });
  ASSERT_TRUE(v.problems.empty()) << v.all();
  const ExhibitPiece& piece = v.exhibit.pieces.at(0);
  ASSERT_TRUE(piece.nebula);
  EXPECT_NEAR(piece.nebula->tilt, 30 * pi / 180, 1e-5f);
  ASSERT_EQ(piece.layers.size(), 1u);
  EXPECT_EQ(piece.layers[0].preset->mode, VolumeMode::glow);
  EXPECT_FALSE(piece.volume->levels[0].colors[0].empty());
  // Another tilt is another volume.
  const auto other = solve_nebula(*piece.nebula, 0.1f);
  EXPECT_NE(other->levels[0].codes, piece.volume->levels[0].codes);
  PieceChoices choices;
  EXPECT_EQ(choose_piece(v.exhibit, PieceOrder{.name = "n", .tilt = 40.4}, choices), "");
  EXPECT_EQ(choices.at(0).tilt, 40);
}

TEST(ExhibitVolumes, AnOrderTurnsAndCuts) {
  const Volumes v(scan(place));
  PieceChoices choices;
  const PieceOrder order{.name = "a",
                         .layer = "bone",
                         .turn = 90,
                         .low = {-1, 0, 0.5f},
                         .plane = vec4(0, 2, 0, 0.01f)};
  ASSERT_EQ(choose_piece(v.exhibit, order, choices), "");
  const PieceChoice& choice = choices.at(0);
  EXPECT_NEAR(choice.turn, pi / 2, 1e-6f);
  EXPECT_EQ(choice.low, vec3(0, 0, 0.5f));
  EXPECT_EQ(choice.plane, vec4(0, 1, 0, 0.01f));
  EXPECT_TRUE(changes_volume(v.exhibit, {}, choices));
  EXPECT_FALSE(changes_volume(v.exhibit, choices, choices));
  EXPECT_NE(choose_piece(v.exhibit, PieceOrder{.name = "a", .layer = "none"}, choices), "");
}

}  // namespace
}  // namespace wellspring::test
