// SPDX-License-Identifier: Apache-2.0
// Animations of an exhibit: read from its package, played for its visitors, seen in their pictures.
#include "show/moving/exhibit_scene.h"

#include <cmath>
#include <utility>
#include <nlohmann/json.hpp>

#include "show/exhibit/exhibit_objects.h"
#include "show/state/renderer.h"
#include "show/state/in_view.h"
#include "show/state/visitor_world.h"
#include "unit/show/exhibit/room_package.h"
#include "unit/show/show_stage.h"
#include "world/motion/scene_motion.h"

namespace wellspring::test {
namespace {

constexpr vec3 weight_way(0, 0.8f, 0), door_way(1, 0, 0);

// A room whose clock's weight goes up and down by itself and whose red door slides when touched.
struct Movable : test::RoomPackage {
  Movable() : RoomPackage(asset()) {
    manifest["viewpoints"][0]["pitch_deg"] = -10;
    manifest["objects"] = {{"door", {{"node", "Door"}, {"title", {{"en", "Door"}}}}}};
    manifest["animations"] = {{{"id", "clock"}, {"clip", "Up"}},
                              {{"id", "door"},
                               {"clip", "Slide"},
                               {"play", "touch"},
                               {"object", "door"},
                               {"title", {{"en", "Open"}}}}};
  }
  Exhibit load() {
    Exhibit exhibit = read();
    EXPECT_EQ(told(), "");
    EXPECT_EQ(exhibit.scene.instances.size(), 4u) << "until it is played, all of it stands still";
    take_movers(exhibit);
    return exhibit;
  }
  static Asset asset() {
    Asset asset = test::room_asset();
    test::add_box(asset, "Weight", {-1.6f, 0.9f, -2}, {-1.3f, 1.2f, -1.7f}, false);
    test::add_clip(asset, "Up", int(asset.root["nodes"].size()) - 1, weight_way, true);
    test::add_box(asset, "Door", {0.3f, 0, -2.9f}, {1.1f, 2, -2.8f}, false);
    asset.root["materials"].back()["pbrMetallicRoughness"]["baseColorFactor"] = {0.8, 0.05, 0.05,
                                                                                 1};
    test::add_clip(asset, "Slide", int(asset.root["nodes"].size()) - 1, door_way, false);
    return asset;
  }
};

TEST(Movers, AreTakenOutOfTheSceneAndAreInItsStillPicture) {
  Movable package;
  Exhibit exhibit = package.load();
  ASSERT_EQ(exhibit.animations.size(), 2u);
  EXPECT_EQ(exhibit.animations[1].seconds, 1);
  EXPECT_EQ(exhibit.movers.size(), 2u);
  EXPECT_EQ(exhibit.scene.instances.size(), 2u) << "the room and the table";
  const Scene still = make_exhibit_scene(exhibit, 0.5);
  ASSERT_EQ(still.instances.size(), 4u);
  const Mesh& weight = still.meshes[size_t(still.instances[2].mesh)];
  float low = 9;
  for (vec3 p : weight.positions) low = std::min(low, p.y);
  EXPECT_NEAR(low, 0.9 + 0.5 * double(weight_way.y), 1e-4);
}

TEST(Movers, NoAnimationsNoMovers) {
  Movable package;
  package.manifest.erase("animations");
  Exhibit exhibit = package.load();
  EXPECT_TRUE(exhibit.scene.motions.empty());
  EXPECT_EQ(exhibit.scene.instances.size(), 4u);
}

TEST(Movers, MistakesAreNamedWithTheirPlace) {
  Movable package;
  json& animations = package.manifest["animations"];
  animations[0]["clip"] = "Upp";
  animations[1]["object"] = "dor";
  animations.push_back({{"id", "door"}, {"clip", "Slide"}, {"play", "sometimes"}});
  animations.push_back({{"id", "d"}, {"clip", "Slide"}, {"play", "touch"}});
  animations.push_back({{"id", "e"}, {"clip", "Slide"}, {"shared", false}, {"file", "x.glb"}});
  package.read();
  EXPECT_EQ(package.says("/animations/0/clip", "did you mean 'Up'"), 1) << package.told();
  EXPECT_EQ(package.says("/animations/1/object", "did you mean 'door'"), 1) << package.told();
  EXPECT_EQ(package.says("/animations/2/id", "taken"), 1) << package.told();
  EXPECT_EQ(package.says("/animations/2/play", "touch"), 1) << package.told();
  EXPECT_EQ(package.says("/animations/3/object", ""), 1) << package.told();
  EXPECT_EQ(package.says("/animations/4/shared", ""), 1) << package.told();
  EXPECT_EQ(package.says("/animations/4/clip", "'x.glb' has no animations"), 1) << package.told();
}

TEST(Play, GoesToItsEndAndBackFromWhereItIs) {
  ExhibitAnimation door{.start = ExhibitAnimation::Start::touch, .seconds = 2};
  Play play;
  EXPECT_EQ(time_of(door, play, 50), 0);
  EXPECT_FALSE(is_running(door, play, 50));
  set_on(door, true, 100, play);
  EXPECT_NEAR(time_of(door, play, 101.5), 1.5, 1e-9);
  EXPECT_TRUE(is_running(door, play, 101.5));
  EXPECT_EQ(time_of(door, play, 200), 2);
  EXPECT_FALSE(is_running(door, play, 200));
  set_on(door, false, 200, play);
  set_on(door, true, 201, play);
  EXPECT_NEAR(time_of(door, play, 201.25), 1.25, 1e-9);
  ExhibitAnimation clock{.seconds = 2};
  EXPECT_NEAR(time_of(clock, {}, 1e6 + 0.5), 0.5, 1e-6);
  EXPECT_TRUE(is_running(clock, {}, 1e6));
}

struct MovingThings : testing::Test, ShowStage {
  Movable package;
  void start(size_t visitors = 1, const std::string& technique = "gather") {
    tick_seconds = 0.02;
    begin(package.load(), settings_for(technique));
    for (size_t i = 0; i < visitors; i++) join(192, 128);
    run(0.1);
  }
  // Red over green where the place falls in the visitor's last picture: only the door is red.
  double red_at(vec3 place, size_t visitor = 0) {
    const Image8 image = last_image(visitor);
    const Projected at = project_point(show->visits.visitors.front().place.last_view, place);
    double sum = 0;
    for (int dy = -2; dy <= 2; dy++)
      for (int dx = -2; dx <= 2; dx++) {
        const uint8_t* c = &image.rgb[3 * size_t((int(at.y) + dy) * image.width + int(at.x) + dx)];
        sum += int(c[0]) - int(c[1]);
      }
    return sum / 25;
  }
  static constexpr vec3 shut{0.5f, 1.2f, -2.8f}, open{1.9f, 1.2f, -2.8f};
};

TEST_F(MovingThings, WhoTouchesTheDoorSeesItOpenAndNobodyElse) {
  start(2);
  run(2);
  EXPECT_GT(red_at(shut, 0), 15);
  EXPECT_LT(red_at(open, 0), 8);
  EXPECT_EQ(last("welcome", 0)["animations"][0]["object"], "door");
  order(R"({"type":"play","name":"door","on":true})", 0);
  run(3);
  EXPECT_EQ(last("state", 0)["animations"]["door"], true);
  EXPECT_EQ(last("state", 1)["animations"]["door"], false);
  EXPECT_LT(red_at(shut, 0), 8);
  EXPECT_GT(red_at(open, 0), 15);
  EXPECT_GT(red_at(shut, 1), 15);
  EXPECT_LT(red_at(open, 1), 8);
  order(R"({"type":"play","name":"door","on":false})", 0);
  run(3);
  EXPECT_GT(red_at(shut, 0), 15);
  order(R"({"type":"play","name":"clock","on":true})", 0);
  EXPECT_EQ(last("error", 0)["code"], "unknown_animation") << "it plays by itself";
}

TEST_F(MovingThings, WhatIsSharedMovesForAll) {
  package.manifest["animations"][1]["shared"] = true;
  start(2);
  order(R"({"type":"play","name":"door","on":true})", 1);
  run(3);
  EXPECT_EQ(last("state", 0)["animations"]["door"], true);
  EXPECT_GT(red_at(open, 0), 15);
}

TEST_F(MovingThings, AClickOnItStartsItAndAnotherSendsItBack) {
  start();
  run(1);
  const Projected at = project_point(visitor().place.last_view, shut);
  const json click = {{"type", "go"}, {"seq", 5}, {"at", {at.x / 192, at.y / 128}}};
  order(click.dump());
  EXPECT_EQ(last("went")["object"], "door");
  run(0.6);
  EXPECT_EQ(last("state")["animations"]["door"], true);
}

// Walking and standing: the picture is that of a scene that has everything where it is by then.
TEST_F(MovingThings, ThePictureIsRightWhileTheyMove) {
  start(1, "path");
  order(R"({"type":"play","name":"door","on":true})");
  run(4.3);
  for (bool stands : {true, false}) {
    if (!stands) turn(0, 0.05), run(0.4);
    const Image8 seen = last_image();
    const Image8 right = truth(visitor().place.last_view, 64);
    EXPECT_LT(mean_difference(seen, right), 12) << stands;
    const std::vector<Play> opened = std::exchange(visitor().plays, {});
    begin_world_of(*show, visitor());
    const Image8 shut = truth(visitor().place.last_view, 64);
    visitor().plays = opened;
    begin_world_of(*show, visitor());
    EXPECT_GT(mean_difference(seen, shut), mean_difference(seen, right) + 1.5) << stands;
  }
}

TEST_F(MovingThings, WhoSeesNothingMovePaysNothing) {
  start();
  visitor().place.view.yaw += pi;  // towards the door it came in by
  run(6);
  const uint64_t posed = show->totals.posed, turns = show->drawing->renderer.skin.turn;
  const size_t sent = pictures().size();
  run(3);
  EXPECT_EQ(show->totals.posed, posed);
  EXPECT_EQ(show->drawing->renderer.skin.turn, turns);
  EXPECT_LE(pictures().size() - sent, 24u) << "as of a scene where nothing moves";
}

TEST_F(MovingThings, ASceneWithoutAnimationsPaysNothing) {
  package.manifest.erase("animations");
  start();
  run(3);
  EXPECT_TRUE(show->cast.movers.empty());
  EXPECT_TRUE(show->stage.skin.places.empty());
  EXPECT_EQ(show->totals.posed, 0u);
  EXPECT_EQ(show->cast.pose_number, 1u);
}

TEST_F(MovingThings, ThePlanSaysWhatMoves) {
  start();
  EXPECT_NE(explain(show->stage.lights.tables->plan).find("moving triangles are lit afresh"),
            std::string::npos);
}

TEST_F(MovingThings, RunForHoursWithoutDrifting) {
  start();
  run(1);
  now += 1e6;
  run(2);
  const std::vector<double> times = animation_times(*show, visitor());
  EXPECT_NEAR(times[0], std::fmod(show->time, 2), 1e-6);
}

}  // namespace
}  // namespace wellspring::test
