// SPDX-License-Identifier: Apache-2.0
// Lawns of a running show: who walks there bends them, they rise again, and cost nothing where
// there are none or nobody sees them.
#include "show/lawns/lit_lawns.h"

#include <gtest/gtest.h>

#include "show/state/renderer.h"
#include "show/state/visitor_picture.h"
#include "unit/show/show_stage.h"

namespace wellspring::test {
namespace {

// A lawn on the floor before the visitor, who stands at (-2, 1.6, 3) and looks to -z.
ExhibitLawn floor_lawn(float wind) {
  ExhibitLawn lawn;
  lawn.id = "lawn";
  lawn.description.low = {-3.5f, 0.5f}, lawn.description.high = {-1.6f, 3.5f};
  lawn.description.density = 300;
  lawn.description.height = 0.15f;
  lawn.wind.strength = wind;
  return lawn;
}

// The first viewpoint is so wide that it shows the floor.
Exhibit room_with_lawn(float wind) {
  Exhibit exhibit = make_tiny_exhibit();
  exhibit.viewpoints[0].view.fov = 1.9f;
  exhibit.lawns = {floor_lawn(wind)};
  return exhibit;
}

struct LitLawnsShow : testing::Test, ShowStage {
  void begin_with(float wind, const std::string& technique = "direct") {
    begin(room_with_lawn(wind), settings_for(technique));
    join(96, 64);
  }
  const LitLawns& lawns() const { return show->stage.lawns; }
  const LawnState& state() const { return *lawns().shown()[0].state; }
};

TEST_F(LitLawnsShow, AVisitorsFeetBendItAndItRisesAgain) {
  begin_with(0);
  ASSERT_TRUE(step_until([&] { return !state().active.empty(); })) << "where the visitor stands";
  EXPECT_TRUE(lawns().moves());
  const size_t standing = state().active.size();
  turn(0, 1);
  ASSERT_TRUE(step_until([&] { return state().active.size() > standing; })) << "a trail";
  turn(0, 0);
  const size_t walked = state().active.size();
  run(10);
  EXPECT_LT(state().active.size(), walked) << "the trail is gone";
  EXPECT_FALSE(state().active.empty()) << "the visitor still stands there";
}

TEST_F(LitLawnsShow, AStorytellersFeetBendIt) {
  Exhibit exhibit = room_with_lawn(0);
  exhibit.walk.reset();
  add_storyteller(exhibit, "anna", {-2.5, 0, 1.5});
  begin(std::move(exhibit), settings_for("direct"));
  join(96, 64);
  ASSERT_TRUE(step_until([&] { return !state().active.empty(); }));
  const LawnTile& tile = lawns().shown()[0].lawn->tile[size_t(state().active[0])];
  EXPECT_LT(tile.low.x, -2.2f);
  EXPECT_GT(tile.high.x, -2.8f);
}

TEST_F(LitLawnsShow, WindMovesItForAVisitorAtRest) {
  begin_with(1);
  ASSERT_TRUE(step_until([&] { return visitor().picture->backdrop && show->totals.posed > 3; }))
      << "drawn over the picture at rest";
  EXPECT_TRUE(visitor().lawns.sways);
  const Image8 before = last_image();
  const uint64_t moment = lawns().shown()[0].moment;
  run(1);
  EXPECT_GT(lawns().shown()[0].moment, moment);
  EXPECT_GT(mean_difference(before, last_image()), 0);
}

TEST_F(LitLawnsShow, OutOfSightNoTimePasses) {
  begin_with(1);
  ASSERT_TRUE(step_until([&] { return visitor().lawns.sways; }));
  order(R"({"type": "viewpoint", "seq": 9, "name": "corner"})");
  run(1);
  ASSERT_FALSE(visitor().lawns.seen);
  const uint64_t moment = lawns().shown()[0].moment;
  run(1);
  EXPECT_EQ(lawns().shown()[0].moment, moment);
  EXPECT_FALSE(visitor().lawns.sways);
}

TEST_F(LitLawnsShow, WithoutALawnThereIsNothing) {
  begin(make_tiny_exhibit(), settings_for("direct"));
  join(96, 64);
  run(1);
  EXPECT_TRUE(lawns().shown().empty());
  EXPECT_FALSE(lawns().moves());
  EXPECT_FALSE(visitor().lawns.seen);
}

// The lamp hangs over the other half of the room: the lawn's end that is nearer to it is brighter.
struct LawnsGround : LitLawnsShow {
  void expect_lamp_to_the_right(const std::string& technique) {
    begin_with(0, technique);
    ASSERT_TRUE(step_until([&] { return lawns().shown()[0].light != nullptr; }));
    const LawnLight& light = *lawns().shown()[0].light;
    double right = 0, left = 0;
    for (int y = 0; y < light.size.y; y++) {
      right += double(light.node[size_t(y * light.size.x + light.size.x - 2)].around.y);
      left += double(light.node[size_t(y * light.size.x + 1)].around.y);
    }
    EXPECT_GT(right, 1.2 * left);
    EXPECT_GT(right / light.size.y, 0.05);
  }
};
TEST_F(LawnsGround, LightsItAsSamplesFind) { expect_lamp_to_the_right("direct"); }
TEST_F(LawnsGround, LightsItAsMapsKnow) { expect_lamp_to_the_right("gather"); }

TEST_F(LitLawnsShow, TheSunOfAnotherHourIsItsLamp) {
  const Exhibit exhibit = room_with_lawn(0);
  const World world(exhibit.scene);
  LitLawns lawns;
  lawns.begin(exhibit, world);
  Lights lights = make_lights(world);
  const Technique& technique = *find_technique("direct");
  PunctualLight sun;
  sun.type = PunctualType::directional;
  sun.direction = vec3(0, -1, 0);
  sun.intensity = vec3(3);
  lawns.light(world, lights, technique, {&sun, 1}, 9.0);
  EXPECT_EQ(lawns.shown()[0].light->node[0].lamp, vec3(0)) << "the ceiling is before it";
  PunctualLight bulb;
  bulb.position = vec3(-1, 2, 2);
  bulb.intensity = vec3(10);
  lawns.light(world, lights, technique, {&bulb, 1}, 10.0);
  const LawnLight& light = *lawns.shown()[0].light;
  const LawnLight::Node& node = light.node[size_t(light.size.y / 2 * light.size.x)];
  EXPECT_GT(node.lamp.y, 0.1f);
  EXPECT_GT(node.to_lamp.x, 0.5f) << "from the left end the bulb is to the right";
  const auto first = lawns.shown()[0].light;
  lawns.light(world, lights, technique, {}, 9.0);
  lawns.light(world, lights, technique, {}, 10.0);
  EXPECT_EQ(lawns.shown()[0].light, first) << "what was found is kept";
}

}  // namespace
}  // namespace wellspring::test
