// SPDX-License-Identifier: Apache-2.0
// The lights that a visitor's pictures are given beside what stands still.
#include "show/state/lamps.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "unit/show/show_stage.h"
#include "world/load/lamp.h"

namespace wellspring::test {
namespace {

using nlohmann::json;

ChangingLight flame(const char* name, int lamp) {
  ChangingLight light{.name = name};
  light.light.intensity = vec3(2);
  light.lamp = lamp;
  light.flicker = {0.4f, 4};
  return light;
}

struct DynamicLightsOfAShow : testing::Test, ShowStage {
  void begin_with(std::vector<ChangingLight> lights) {
    Exhibit exhibit = make_tiny_exhibit();
    add_lamp({"hearth", {}, {}}, exhibit.scene);
    exhibit.lamps = {{"hearth", {{"en", "Hearth"}}}};
    exhibit.lights = std::move(lights);
    begin(std::move(exhibit), settings_for("direct"));
    join(64, 48), join(64, 48);
    run(0.5);
  }
  DynamicLights of(size_t visitor, double time) {
    return dynamic_lights_of(*show, *std::next(show->visits.visitors.begin(), long(visitor)), time);
  }
};

TEST_F(DynamicLightsOfAShow, AreNoneWhereTheExhibitHasNone) {
  begin_with({});
  EXPECT_TRUE(of(0, 1).empty());
}

TEST_F(DynamicLightsOfAShow, AreAsTheyAreAtThatTimeAndKeepTheirNumbers) {
  ChangingLight black = flame("black", -1);
  black.light.intensity = vec3(0);
  begin_with({flame("fire", 0), black, flame("torch", -1)});
  for (double time : {1.0, 1.3, 99.0}) {
    const DynamicLights lights = of(0, time);
    ASSERT_EQ(lights.size(), 2u) << "a black one is left out";
    for (size_t i : {0, 1}) {
      const size_t entry = 2 * i;
      EXPECT_EQ(lights[i].id, first_changing_light + entry);
      EXPECT_EQ(lights[i].light.intensity,
                eval_light(show->stage.exhibit.lights[entry], time).intensity);
    }
    EXPECT_NE(lights[0].light.intensity, lights[1].light.intensity);
  }
}

// Its lamp switches it, for whoever does, when the light follows.
TEST_F(DynamicLightsOfAShow, GoOutWithTheirLamp) {
  begin_with({flame("fire", 0), flame("torch", -1)});
  say(json{{"type", "lamp"}, {"name", "hearth"}, {"on", false}}.dump(), 1);
  run(0.5);
  EXPECT_EQ(of(0, 2).size(), 2u);
  ASSERT_EQ(of(1, 2).size(), 1u);
  EXPECT_EQ(of(1, 2)[0].id, first_changing_light + 1);
  say(json{{"type", "lamp"}, {"name", "hearth"}, {"on", true}}.dump(), 1);
  run(0.5);
  EXPECT_EQ(of(1, 2).size(), 2u);
}

}  // namespace
}  // namespace wellspring::test
