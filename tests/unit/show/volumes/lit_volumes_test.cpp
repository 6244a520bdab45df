// SPDX-License-Identifier: Apache-2.0
#include "show/volumes/lit_volumes.h"

#include <gtest/gtest.h>

#include "light/sample/lights.h"
#include "show/exhibit/pieces/exhibit_volumes.h"
#include "show/visit/place.h"
#include "unit/show/tiny_exhibit.h"
#include "unit/volume/draw_made.h"
#include "wire/messages.h"
#include "world/world.h"

namespace wellspring::test {
namespace {

// Stands in the open: a ball of 20 mm with a core of 8 mm.
Exhibit open_exhibit() {
  Exhibit exhibit;
  exhibit.scene.objects = {"", "ball"};
  // Something far away that light falls on, or lights would not count.
  Mesh speck;
  add_quad(speck, {0, -100, 0}, {0.001f, 0, 0}, {0, 0, -0.001f});
  exhibit.scene.materials.emplace_back().metallic = 0;
  exhibit.scene.meshes.push_back(speck);
  exhibit.scene.instances.push_back({0, mat4(1), 0});
  ExhibitPiece piece;
  piece.id = "ball", piece.object = 1;
  piece.volume =
      std::make_shared<ShownVolume>(make_shown_volume(made_volume({48, 48, 48}, [](glm::vec3 p) {
        return length(p) < 8 ? 2.0f : length(p) < 20 ? 1.0f : 0.0f;
      })));
  for (const auto& [id, value] : {std::pair("skin", 0.5), std::pair("core", 1.5)}) {
    PieceLayer layer;
    layer.id = id;
    layer.preset = Preset{id, VolumeMode::surface, {{value, vec3(1), 1}}};
    piece.layers.push_back(std::move(layer));
  }
  exhibit.pieces.push_back(std::move(piece));
  return exhibit;
}

struct Room {
  Exhibit exhibit = open_exhibit();
  std::unique_ptr<World> world;
  Lights lights;
  LitVolumes volumes;
  const Technique& technique = *find_technique("path");

  void begin() {
    world = std::make_unique<World>(exhibit.scene);
    lights = make_lights(*world);
    volumes.begin(exhibit, lights, technique, *world);
  }
  VolumeLook show(const PieceChoice& choice) {
    volumes.show(exhibit, {choice}, lights, technique, *world);
    return world->volumes()[0].look;
  }
};

PunctualLight sun_from(vec3 side) {
  PunctualLight sun;
  sun.type = PunctualType::directional;
  sun.direction = -side;
  sun.intensity = vec3(3, 2, 1);
  return sun;
}

TEST(RoomLight, ASunIsALamp) {
  Room room;
  const vec3 side = normalize(vec3(1, 2, -3));
  room.exhibit.scene.lights = {sun_from(side)};
  room.exhibit.pieces[0].yaw = pi;  // axes are the scene's
  room.begin();
  room.world->show_volume(0, {});
  const VolumeLight light =
      room_light(*room.world, room.lights, room.technique, room.world->volumes()[0]);
  EXPECT_NEAR(distance(light.to_lamp, side), 0, 1e-4f);
  EXPECT_NEAR(distance(light.lamp, vec3(3, 2, 1) / pi), 0, 1e-3f);
  EXPECT_NEAR(max_component(light.around), 0, 1e-3f);
}

TEST(RoomLight, LightFromEverywhereIsNoLamp) {
  Room room;
  room.exhibit.scene.environment.radiance = vec3(0.7f);
  room.begin();
  const VolumeLight light =
      room_light(*room.world, room.lights, room.technique, room.world->volumes()[0]);
  EXPECT_NEAR(light.around.x, 0.7f, 0.01f);
  EXPECT_LT(light.lamp.x, 0.02f);
}

TEST(RoomLight, NoLightIsNone) {
  Room room;
  room.begin();
  const VolumeLight light =
      room_light(*room.world, room.lights, room.technique, room.world->volumes()[0]);
  EXPECT_EQ(light.around, vec3(0));
  EXPECT_EQ(light.lamp, vec3(0));
}

TEST(LitVolumes, ShowsTheFirstPresetAtOnce) {
  Room room;
  room.begin();
  ASSERT_EQ(room.world->volumes().size(), 1u);
  const VolumeLook& look = room.world->volumes()[0].look;
  ASSERT_TRUE(look.preset);
  EXPECT_FALSE(look.over);
  EXPECT_TRUE(look.cuts.empty());
}

TEST(LitVolumes, AnotherPresetComesWhenItIsMade) {
  Room room;
  room.begin();
  const auto skin = room.world->volumes()[0].look.preset;
  const uint64_t before = room.volumes.arrivals();
  const auto meanwhile = room.show({.layer = 1}).preset;
  room.volumes.wait();
  EXPECT_EQ(room.volumes.arrivals(), before + 1);
  const auto core = room.show({.layer = 1}).preset;
  EXPECT_NE(core, skin);
  // The thread that makes it may be done at once.
  EXPECT_TRUE(meanwhile == skin || meanwhile == core) << "the one before stays meanwhile";
  EXPECT_GT(core->table.threshold(), skin->table.threshold());
  EXPECT_EQ(room.show({.layer = 0}).preset, skin) << "what was made is kept";
}

TEST(LitVolumes, MixesTwoPresetsAsFarAsBothAreMade) {
  Room room;
  room.begin();
  const PieceChoice both{.layer = 0, .over = 1, .by = Blend::fade, .share = 0.3f};
  const VolumeLook meanwhile = room.show(both);
  EXPECT_EQ(meanwhile.share, meanwhile.over ? 0.3f : 0.0f);
  room.volumes.wait();
  const VolumeLook look = room.show(both);
  ASSERT_TRUE(look.over);
  EXPECT_EQ(look.share, 0.3f);
}

TEST(LitVolumes, ATurnedVolumeKeepsItsLampInTheRoom) {
  Room room;
  const vec3 side = normalize(vec3(0, 1, 2));
  room.exhibit.scene.lights = {sun_from(side)};
  room.begin();
  room.show({.turn = pi / 2});
  room.volumes.wait();
  const VolumeLook look = room.show({.turn = pi / 2});
  PlacedVolume placed = room.world->volumes()[0];
  EXPECT_NEAR(distance(look.preset->light.to_lamp, ToVolume(placed).way(side)), 0, 1e-4f);
}

TEST(LitVolumes, CutsAreSharesOfTheBoxAndPlanesThroughTheScene) {
  Room room;
  room.exhibit.pieces[0].scale = 10;
  room.begin();
  const VolumeLook look =
      room.show({.low = {0.25f, 0, 0}, .high = {1, 1, 0.5f}, .plane = vec4(0, 1, 0, 0.1f)});
  ASSERT_EQ(look.cuts.size(), 3u);
  EXPECT_EQ(look.cuts[0].normal, vec3(1, 0, 0));
  EXPECT_NEAR(look.cuts[0].offset, -0.012f, 1e-5f);
  EXPECT_EQ(look.cuts[1].normal, vec3(0, 0, -1));
  EXPECT_NEAR(look.cuts[1].offset, 0, 1e-5f);
  EXPECT_NEAR(look.cuts[2].offset, 0.01f, 1e-5f) << "metres of the scene";
}

TEST(LitVolumes, AGlassCutsFromTheSideThatIsSeen) {
  Room room;
  room.exhibit.pieces[0].yaw = pi;
  room.begin();
  PieceChoices choices;
  LensOrder order{.depth = 0.01f};
  const vec3 middle = room.world->volumes()[0].position;
  cut_ahead(room.exhibit, order, {middle + vec3(0, 0, 2)}, choices);
  const std::vector<VolumeCut> cuts =
      cuts_of(box_of(*room.exhibit.pieces[0].volume), room.exhibit.pieces[0].scale, choices[0]);
  ASSERT_EQ(cuts.size(), 1u);
  EXPECT_NEAR(cuts[0].normal.z, -1, 1e-6f);
  EXPECT_NEAR(cuts[0].offset, -0.014f, 1e-5f) << "10 of the 24 mm before the middle are gone";
}

TEST(LitVolumes, AVolumeIsAThingThatVisitorsLookAtFromAllSides) {
  Room room;
  room.exhibit.pieces[0].position = {2, 1, 3};
  room.begin();
  PointOfInterest point;
  point.objects = {1};
  const Bounds bounds = object_bounds(*room.world, point);
  const vec3 middle = 0.5f * (bounds.low + bounds.high);
  EXPECT_NEAR(distance(middle, vec3(2, 1.024f, 3)), 0, 1e-4f);
  EXPECT_NEAR(bounds.high.y - bounds.low.y, 0.048f, 1e-4f);
}

}  // namespace
}  // namespace wellspring::test
