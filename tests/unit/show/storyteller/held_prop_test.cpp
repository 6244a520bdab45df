// SPDX-License-Identifier: Apache-2.0
// A torch in a show: seen and shining for those whose storyteller holds it, for as long as the
// story says.
#include <gtest/gtest.h>

#include <deque>

#include "avatar/load/character_load.h"
#include "show/state/lamps.h"
#include "show/state/visitor_world.h"
#include "unit/show/show_stage.h"

namespace wellspring::test {
namespace {

// A rod from 0.1 m below the fist to 0.3 m above it, a flame on it, a light over that.
ExhibitProp make_torch(Flicker flicker) {
  ExhibitProp prop{.id = "torch", .flicker = flicker};
  Material wood, flame;
  wood.double_sided = flame.double_sided = true;
  flame.emission = vec3(4);
  prop.scene.materials = {wood, flame};
  prop.scene.objects = {"", "rod", "flame"};
  Mesh rod, fire;
  add_quad(rod, {-0.02f, -0.1f, 0}, {0.04f, 0, 0}, {0, 0.4f, 0});
  add_quad(fire, {-0.03f, 0.3f, 0}, {0.06f, 0, 0}, {0, 0.1f, 0});
  fire.material = 1;
  prop.scene.meshes = {rod, fire};
  prop.scene.instances = {{0, mat4(1), 1}, {1, mat4(1), 2}};
  PunctualLight light{.position = {0, 0.45f, 0}, .intensity = vec3(7, 4, 2)};
  prop.scene.lights = {light};
  return prop;
}

struct HeldPropTest : testing::Test, ShowStage {
  void begin(Flicker flicker = {}) {
    Exhibit exhibit = make_tiny_exhibit();
    static const Character character =
        load_character(std::string(WELLSPRING_SOURCE) + "/content/castle/figures/storyteller.x3d");
    for (const char* id : {"anna", "otto"})
      add_storyteller(exhibit, id, dvec3(id[0] == 'a' ? -2 : 2, 0, 2)).character = character;
    exhibit.props = {make_torch(flicker)};
    auto story = [&](const char* id, const char* text) {
      StoryText& one = exhibit.stories.emplace_back();
      one.id = id;
      one.text["en"] = read_story(text, id).lines;
    };
    story("dark", "A story without any light at all. It goes on for some time, like this.");
    story("torch",
          "<hold name='torch'/>It was dark, so she took a torch and held it up high. "
          "And this is all that there is to be told about it, to the end.");
    story("put_away",
          "<hold name='torch'/>She took a torch and held it up high in the dark. "
          "<hold name='nothing'/>Then she put it away, and told the rest of it all "
          "without a light, which took her a long while.");
    tick_seconds = 0.1;
    ShowStage::begin(std::move(exhibit), settings_for("direct", 25));
  }
  // Somebody new, who looks away, so that their pictures cost little.
  void join() {
    ShowStage::join(32, 32);
    step();
    show->visits.visitors.back().place.view.yaw = pi;
  }
  Visitor& visitor_number(size_t i) { return *std::next(show->visits.visitors.begin(), long(i)); }
  DynamicLights lights(size_t i = 0) {
    return dynamic_lights_of(*show, visitor_number(i), show->time);
  }
  float brightness(size_t i = 0) {
    float sum = 0;
    for (const DynamicLight& one : lights(i)) sum += one.light.intensity.x;
    return sum;
  }
  void tell(const char* story, size_t i = 0) {
    say(std::string(R"({"type":"storyteller","story":")") + story + "\"}", i);
  }
  // Parts of the torch that the visitor sees: their middles.
  std::vector<vec3> seen(size_t i = 0) {
    begin_world_of(*show, visitor_number(i));
    std::vector<vec3> places;
    const uint32_t first = uint32_t(show->stage.exhibit.scene.instances.size());
    for (const PropPart& part : show->cast.props[0].parts) {
      const uint32_t instance = first + uint32_t(part.moving);
      if (!show->stage.world->is_visible(instance)) continue;
      vec3 middle(0);
      const Mesh& mesh = show->stage.world->mesh_of(instance);
      for (const vec3& p : mesh.positions) middle += p / float(mesh.positions.size());
      places.push_back(middle);
    }
    return places;
  }
  vec3 wrist(size_t i = 0) {
    const Teller& teller = teller_of(show->cast, show->visits, visitor_number(i));
    const Character& character = *teller.storyteller.character;
    JointFrame frame =
        eval_joint_frame(character, teller.pose, find_joint(character, "r_radiocarpal"));
    return vec3(teller.storyteller.placement * vec4(frame.center, 1));
  }
};

TEST_F(HeldPropTest, ItIsInTheHandAndItsLightIsOverIt) {
  begin();
  join();
  EXPECT_TRUE(lights().empty());
  EXPECT_TRUE(seen().empty());
  tell("torch");
  ASSERT_TRUE(step_until([&] { return brightness() == 7; }));
  for (int i = 0; i < 5; i++) {
    run(0.2);
    ASSERT_EQ(lights().size(), 1u);
    const DynamicLight light = lights()[0];
    EXPECT_EQ(light.light.intensity, vec3(7, 4, 2));
    EXPECT_NEAR(glm::length(light.light.position - wrist()), 0.45f, 0.15f);
    EXPECT_GT(light.light.position.y, wrist().y + 0.3f);
    const std::vector<vec3> parts = seen();
    ASSERT_EQ(parts.size(), 2u);
    EXPECT_LT(glm::length(parts[0] - wrist()), 0.25f);
    EXPECT_LT(glm::length(parts[1] - light.light.position), 0.15f) << "the flame is below it";
  }
}

TEST_F(HeldPropTest, LightComesAndGoesSlowlyWhateverEndsTheStory) {
  const std::vector<std::string> ends = {
      "",  // it is told to its end
      R"({"type":"storyteller","action":"stop"})",
      R"({"type":"storyteller","story":"dark"})",
      R"({"type":"storyteller","teller":"otto"})",
      R"({"type":"storyteller","visible":false})",
      R"({"type":"ask","text":"What is this?"})",
  };
  begin();
  for (const std::string& end : ends) {
    join();
    const size_t i = show->visits.visitors.size() - 1;
    tell("torch", i);
    std::vector<float> course = {brightness(i)};
    auto watch = [&](auto&& until) {
      return step_until([&] {
        course.push_back(brightness(i));
        return until();
      });
    };
    ASSERT_TRUE(watch([&] { return course.back() == 7; })) << end;
    if (!end.empty()) say(end, i);
    ASSERT_TRUE(watch([&] { return course.back() == 0; })) << end;
    ASSERT_TRUE(step_until([&] { return seen(i).empty(); })) << end;
    const float most = 7 * 1.5f * float(tick_seconds) / glow_seconds + 1e-3f;
    for (size_t k = 1; k < course.size(); k++)
      EXPECT_LE(std::abs(course[k] - course[k - 1]), most) << end << " " << k;
    say(R"({"type":"bye"})", i);
    ASSERT_TRUE(step_until([&] { return show->visits.visitors.empty(); }));
    browsers.clear();
  }
}

TEST_F(HeldPropTest, ItIsPutAwayWhereTheStorySaysSo) {
  begin();
  join();
  tell("put_away");
  ASSERT_TRUE(step_until([&] { return brightness() == 7; }));
  ASSERT_TRUE(step_until([&] { return seen().empty(); }));
  EXPECT_EQ(brightness(), 0);
  EXPECT_EQ(show->visits.visitors.front().own_teller->voice.story, "put_away") << "which goes on";
}

TEST_F(HeldPropTest, OfTwoVisitorsEachSeesTheirOwn) {
  begin();
  join();
  join();
  tell("torch", 0);
  tell("dark", 1);
  ASSERT_TRUE(step_until([&] { return brightness(0) == 7; }));
  for (int k = 0; k < 3; k++) {
    EXPECT_EQ(lights(1).size(), 0u);
    EXPECT_TRUE(seen(1).empty());
    EXPECT_EQ(seen(0).size(), 2u);
    step();
  }
  tell("torch", 1);
  say(R"({"type":"storyteller","story":"dark"})", 0);
  ASSERT_TRUE(step_until([&] { return brightness(1) == 7 && brightness(0) == 0; }));
  EXPECT_TRUE(step_until([&] { return seen(0).empty(); }));
  EXPECT_EQ(seen(1).size(), 2u);
}

TEST_F(HeldPropTest, ItGoesOutWhileNobodyLooks) {
  begin();
  join();
  tell("torch");
  ASSERT_TRUE(step_until([&] { return brightness() == 7; }));
  say(R"({"type":"storyteller","action":"stop"})");
  EXPECT_TRUE(step_until([&] { return brightness() == 0; }));
}

// WCAG 2.2, 2.3.1: pairs of opposing changes of a tenth or more.
TEST(HeldProp, AFlameFlickersAtMostThreeTimesASecond) {
  Exhibit exhibit = make_tiny_exhibit();
  exhibit.props = {make_torch({0.3f, float(most_turns)})};
  HeldProp held{0, 1, 1, mat4(1)};
  std::deque<double> flashes;  // the last second's
  size_t all = 0;
  float turning = 0, least = 1e9f, most = 0;
  int way = 0;
  vec3 last_place(0);
  for (int k = 0; k < 60 * 60 * 10; k++) {
    const double time = k / 60.0;
    DynamicLights lights, again;
    add_held_lights(exhibit, held, time, 5, lights);
    add_held_lights(exhibit, held, time, 5, again);
    ASSERT_EQ(lights.size(), 1u);
    const float now = lights[0].light.intensity.x / 7;
    ASSERT_EQ(now, again[0].light.intensity.x / 7) << "it depends on time alone";
    if (k > 0) {
      EXPECT_LT(glm::length(lights[0].light.position - last_place), 0.004f) << "it does not jump";
    }
    last_place = lights[0].light.position;
    least = std::min(least, now), most = std::max(most, now);
    if (k == 0) turning = now;
    // `turning`: the extreme since the last change of a tenth.
    if (way > 0 && now > turning) turning = now;
    if (way < 0 && now < turning) turning = now;
    if (std::abs(now - turning) < 0.1f * most) continue;
    way = now > turning ? 1 : -1;
    turning = now;
    flashes.push_back(time);
    all++;
    while (time - flashes.front() > 1) flashes.pop_front();
    EXPECT_LE(flashes.size(), 6u) << "changes in the second before " << time;
  }
  EXPECT_GT(all, 100u) << "it flickers";
  EXPECT_GT(least, 0.6f);
  EXPECT_LT(most, 1.4f);
}

}  // namespace
}  // namespace wellspring::test
