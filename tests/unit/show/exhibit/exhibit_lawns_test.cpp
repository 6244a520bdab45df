// SPDX-License-Identifier: Apache-2.0
#include "show/exhibit/pieces/exhibit_lawns.h"

#include <gtest/gtest.h>

#include "image/image.h"
#include "unit/show/exhibit/room_package.h"

namespace wellspring::test {
namespace {

json lawn_piece() {
  return {{"id", "grass"},
          {"kind", "lawn"},
          {"place", {{"position", {0, 0, 1.5}}}},
          {"area_m", {4, 2}},
          {"blades", {{"density", 200}, {"height_m", 0.1}}}};
}

struct LawnPackage : RoomPackage {
  explicit LawnPackage(const json& piece) { manifest["pieces"] = json::array({piece}); }
  // Its left half is black, its right half white.
  void write_mask(const std::string& name) const {
    Image8 image{2, 1, {0, 0, 0, 255, 255, 255}};
    const std::vector<uint8_t> png = encode_png(image, "", name);
    write(name, std::string(png.begin(), png.end()));
  }
};

TEST(ExhibitLawns, ALawnGrowsOnTheGroundOfItsRectangle) {
  LawnPackage package(lawn_piece());
  const Exhibit exhibit = package.read();
  ASSERT_EQ(exhibit.lawns.size(), 1u) << package.told();
  const World world(exhibit.scene);
  const auto lawn = grow_lawn(exhibit.lawns[0], world);
  EXPECT_NEAR(lawn->blades, 200 * 4 * 2, 100);
  EXPECT_EQ(lawn->low, vec2(-2, 0.5f));
  EXPECT_EQ(lawn->high, vec2(2, 2.5f));
  for (const float y : lawn->y) EXPECT_NEAR(y, 0, 1e-4f);
  EXPECT_LE(lawn->tallest, 0.1f);
}

TEST(ExhibitLawns, ItGrowsOnTheFirstThingBelowThatIsInReach) {
  json piece = lawn_piece();
  piece["place"]["position"] = {0, 0.5, -0.5};
  piece["area_m"] = {1, 0.8};  // on the table, 0.8 m high
  LawnPackage within(piece);
  const Exhibit table = within.read();
  const auto grown = grow_lawn(table.lawns.at(0), World(table.scene));
  ASSERT_GT(grown->blades, 0);
  EXPECT_NEAR(grown->y[0], 0.8f, 1e-4f);
  piece["reach_m"] = 0.2;
  LawnPackage beyond(piece);
  const Exhibit air = beyond.read();
  EXPECT_EQ(grow_lawn(air.lawns.at(0), World(air.scene))->blades, 0);
}

TEST(ExhibitLawns, CheckNotesALawnOverNoGround) {
  json piece = lawn_piece();
  LawnPackage good(piece);
  good.check();
  EXPECT_EQ(good.told(), "");
  piece["place"]["position"] = {0, 2, 1.5};
  piece["reach_m"] = 0.5;
  LawnPackage in_the_air(piece);
  in_the_air.check();
  EXPECT_EQ(in_the_air.says("/pieces/0", "nothing grows of the lawn 'grass': within 0.5 m"), 1)
      << in_the_air.told();
  EXPECT_EQ(in_the_air.problems.size(), 1u) << in_the_air.told();
  EXPECT_FALSE(in_the_air.problems[0].fatal);
  piece["place"]["position"] = {0, 0, 1.5};
  piece["mask"] = "mask.png";
  LawnPackage masked(piece);
  Image8 black{1, 1, {0, 0, 0}};
  const std::vector<uint8_t> png = encode_png(black, "", "mask.png");
  masked.write("mask.png", std::string(png.begin(), png.end()));
  masked.check();
  EXPECT_EQ(masked.says("/pieces/0", "mask is black"), 1) << masked.told();
}

TEST(ExhibitLawns, ItGrowsWhereTheMaskIsWhite) {
  json piece = lawn_piece();
  piece["mask"] = "mask.png";
  LawnPackage package(piece);
  package.write_mask("mask.png");
  const Exhibit exhibit = package.read();
  ASSERT_EQ(exhibit.lawns.size(), 1u) << package.told();
  const auto lawn = grow_lawn(exhibit.lawns[0], World(exhibit.scene));
  int left = 0, right = 0;
  for (size_t i = 0; i < lawn->x.size(); i++)
    if (lawn->length[i] > 0) (lawn->x[i] < -1 ? left : right)++;
  EXPECT_EQ(left, 0);
  EXPECT_GT(right, 600);
}

TEST(ExhibitLawns, ItGrowsOnItsMaterialsAlone) {
  json piece = lawn_piece();
  piece["ground"] = {"moss"};
  Asset asset = room_asset();
  asset.root["materials"][0]["name"] = "moss";
  asset.root["materials"][1]["name"] = "oak";
  piece["area_m"] = {4, 4};
  RoomPackage package(asset);
  package.manifest["pieces"] = json::array({piece});
  const Exhibit exhibit = package.read();
  ASSERT_EQ(exhibit.lawns.size(), 1u) << package.told();
  const auto lawn = grow_lawn(exhibit.lawns[0], World(exhibit.scene));
  EXPECT_GT(lawn->blades, 100);
  for (const float y : lawn->y) EXPECT_NEAR(y, 0, 1e-4f) << "not on the oak table";
}

TEST(ExhibitLawns, WithoutALabelItIsNoObject) {
  LawnPackage without(lawn_piece());
  EXPECT_TRUE(without.read().points.empty());
  json piece = lawn_piece();
  piece["label"] = {{"en", "The lawn"}};
  LawnPackage with(piece);
  EXPECT_EQ(with.read().points.size(), 1u);
}

TEST(ExhibitLawns, FaultsAreNamedWithTheirPlace) {
  const struct {
    const char *field, *value, *where, *what;
  } faults[] = {
      {"area_m", "[4, 0]", "/pieces/0/area_m", "not above 0"},
      {"area_m", "[4]", "/pieces/0/area_m", "two numbers"},
      {"mask", "\"none.png\"", "/pieces/0/mask", "none.png"},
      {"ground", "[\"lawn\"]", "/pieces/0/ground", "no material 'lawn'"},
      {"wind", "9", "/pieces/0/wind", "0 to 3"},
      {"place", "{\"position\": [0, 0, 0], \"yaw_deg\": 30}", "/pieces/0/place", "not turned"},
      {"blades", "{\"density\": 0}", "/pieces/0/blades/density", "1 to 50000"},
  };
  for (const auto& fault : faults) {
    json piece = lawn_piece();
    piece[fault.field] = json::parse(fault.value);
    LawnPackage package(piece);
    package.read();
    EXPECT_EQ(package.says(fault.where, fault.what), 1) << fault.field << "\n" << package.told();
  }
  json piece = lawn_piece();
  piece.erase("place");
  LawnPackage nowhere(piece);
  nowhere.read();
  EXPECT_EQ(nowhere.says("/pieces/0", "needs a \"place\""), 1) << nowhere.told();
}

TEST(ExhibitLawns, APictureThatCannotBeReadIsAProblemOfThatFile) {
  json piece = lawn_piece();
  piece["mask"] = "mask.png";
  LawnPackage package(piece);
  package.write("mask.png", "this is no picture");
  package.read();
  ASSERT_FALSE(package.problems.empty());
  EXPECT_NE(package.told().find("mask.png"), std::string::npos) << package.told();
}

}  // namespace
}  // namespace wellspring::test
