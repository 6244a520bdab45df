// SPDX-License-Identifier: Apache-2.0
// A visitor points at the ground or at an object, and is led there.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "show/state/in_view.h"
#include "show/visit/good_view.h"
#include "unit/show/show_stage.h"

namespace wellspring::test {
namespace {

// A box on the floor between two corners, seen from outside.
void add_box(Scene& scene, const std::string& name, vec3 low, vec3 high, int material = 0) {
  Mesh box{.material = material};
  vec3 size = high - low, x(size.x, 0, 0), y(0, size.y, 0), z(0, 0, size.z);
  add_quad(box, low, y, x), add_quad(box, low + z, x, y);
  add_quad(box, low, z, y), add_quad(box, low + x, y, z);
  add_quad(box, low, x, z), add_quad(box, low + y, z, x);
  scene.meshes.push_back(box);
  scene.objects.push_back(name);
  scene.instances.push_back(
      {int(scene.meshes.size()) - 1, mat4(1), uint32_t(scene.objects.size()) - 1});
}

struct GoTest : testing::Test, ShowStage {
  dvec3 origin{1000, 0, -500};
  uint32_t last_seq = 0;

  // The tiny room, with a statue in its corner behind the wall, in a case of glass.
  Exhibit make_room() {
    Exhibit exhibit = make_tiny_exhibit(origin);
    exhibit.scene.materials.push_back({.metallic = 0, .roughness = 0, .transmission = 1});
    add_box(exhibit.scene, "statue", {-3.2f, 0.8f, -3.2f}, {-2.9f, 1.3f, -2.9f});
    add_box(exhibit.scene, "case", {-3.4f, 0.0f, -3.4f}, {-2.7f, 1.8f, -2.7f}, 2);
    PointOfInterest& statue = exhibit.points.emplace_back();
    statue.id = "statue";
    statue.objects = {3};
    statue.place = origin + dvec3(-3.05, 1.05, -3.05);
    statue.title = {{"en", "Statue"}};
    return exhibit;
  }
  void begin(Exhibit exhibit) {
    ShowSettings settings = settings_for("direct", 5);
    ShowStage::begin(std::move(exhibit), settings);
    join(96, 64);
    run(0.3);
  }
  void SetUp() override { begin(make_room()); }
  VisitorPlace& place() { return show->visits.visitors.front().place; }
  vec3 here() { return vec3(place().view.position - origin); }
  void go(nlohmann::json order) {
    order["type"] = "go";
    order["seq"] = ++last_seq;
    say(order.dump());
    step();
  }
  void arrive() {
    EXPECT_TRUE(step_until([&] { return !place().glide.path; }));
  }
  void stand_at(vec3 eye, float yaw, float pitch) {
    dvec3 at = origin + dvec3(eye);
    order(nlohmann::json{{"type", "camera"},
                         {"seq", ++last_seq},
                         {"position", {at.x, at.y, at.z}},
                         {"yaw", yaw},
                         {"pitch", pitch}}
              .dump());
    run(0.3);
  }
};

TEST_F(GoTest, GlidesAroundTheWallToWhereTheMapWasClicked) {
  dvec3 to = origin + dvec3(-2, 0, -1.5);
  go({{"to", {to.x, to.y, to.z}}});
  ASSERT_EQ(last("went")["seq"], last_seq);
  EXPECT_TRUE(last("went")["object"].is_null());
  EXPECT_GT(last("went")["seconds"], 2);
  const WalkMap& map = *show->stage.roads.map;
  float farthest_right = -10, least_clear = 10;
  EXPECT_TRUE(step_until([&] {
    farthest_right = std::max(farthest_right, here().x);
    least_clear = std::min(least_clear, clear_at(map, here() - vec3(0, 1.6f, 0)));
    return !place().glide.path;
  }));
  EXPECT_GT(farthest_right, 1) << "the wall is open there alone";
  EXPECT_GT(least_clear, 0.1f);
  EXPECT_LT(glm::length(here() - vec3(-2, 1.6f, -1.5f)), 0.05f);
  EXPECT_EQ(place().seq, last_seq);
}

TEST_F(GoTest, GoesToTheFloorThatIsSeenThere) {
  stand_at({-2, 1.6f, 3.5f}, 0, -0.5f);
  go({{"at", {0.5, 0.5}}});
  arrive();
  EXPECT_NEAR(here().x, -2, 0.02);
  EXPECT_NEAR(here().z, 3.5 - 1.6 / std::tan(0.5), 0.05);
  EXPECT_NEAR(here().y, 1.6, 0.02);
}

TEST_F(GoTest, AWallLeadsToTheFloorBeforeIt) {
  stand_at({-2, 1.6f, 3.5f}, 0, 0.2f);
  go({{"at", {0.5, 0.5}}});
  arrive();
  EXPECT_GT(here().z, 0.2);
  EXPECT_LT(here().z, 0.8);
  go({{"at", {0.5, 0.5}}});
  EXPECT_EQ(last("error")["code"], "no_way") << "it stands there";
}

TEST_F(GoTest, ComfortLeaps) {
  say(R"({"type":"settings","comfort":true})");
  dvec3 to = origin + dvec3(-2, 0, -1.5);
  uint32_t cuts = place().camera_cuts;
  go({{"to", {to.x, to.y, to.z}}});
  EXPECT_EQ(last("went")["seconds"], 0);
  EXPECT_LT(glm::length(here() - vec3(-2, 1.6f, -1.5f)), 0.05f);
  EXPECT_GT(place().camera_cuts, cuts);
}

TEST_F(GoTest, KeysAndDraggingTakeOver) {
  for (const char* input : {R"({"type":"input","seq":50,"move":[0,0,1],"look":[0,0]})",
                            R"({"type":"input","seq":51,"move":[0,0,0],"look":[0.1,0]})"}) {
    dvec3 to = origin + dvec3(-2, 0, -1.5);
    go({{"to", {to.x, to.y, to.z}}});
    EXPECT_TRUE(place().glide.path);
    say(input);
    step();
    EXPECT_FALSE(place().glide.path) << input;
    say(R"({"type":"input","seq":52,"move":[0,0,0]})");
    run(0.5);
  }
}

TEST_F(GoTest, LooksCloserThroughGlassWithAllOfItInThePicture) {
  stand_at({-3, 1.6f, -0.6f}, 0, -0.2f);
  go({{"at", {0.5, 0.5}}});
  ASSERT_EQ(last("went")["object"], "statue");
  EXPECT_EQ(place().closer, 0);
  arrive();
  View view = rest_view(show->stage, show->visits.visitors.front());
  for (int i = 0; i < 8; i++) {
    vec3 corner(i & 1 ? -3.2f : -2.9f, i & 2 ? 0.8f : 1.3f, i & 4 ? -3.2f : -2.9f);
    Projected seen = project_point(view, corner);
    EXPECT_GT(seen.depth, 0);
    EXPECT_TRUE(seen.x > 0 && seen.x < float(view.width) && seen.y > 0 &&
                seen.y < float(view.height))
        << seen.x << ", " << seen.y;
  }
  Hit hit = first_solid(*show->stage.world, view_ray(view, 48, 32));
  EXPECT_EQ(show->stage.world->object_of(hit.instance), 3u) << "and nothing before it";
  EXPECT_GE(clear_at(*show->stage.roads.map, here() - vec3(0, 1.6f, 0)), 0.2f);
  say(R"({"type":"input","seq":90,"move":[0,0,1]})");
  step();
  EXPECT_EQ(place().closer, -1) << "who walks off looks closer no more";
}

TEST_F(GoTest, AnObjectOfTheMapIsLookedAtFromBehindTheWallToo) {
  go({{"object", "statue"}});
  ASSERT_EQ(last("went")["object"], "statue");
  arrive();
  EXPECT_LT(here().z, 0) << "it is not seen from this side of the wall";
}

TEST_F(GoTest, SmallThingsNeedNoSteadyHand) {
  stand_at({-3.05f, 1.6f, -0.6f}, 0, -0.2f);
  View view = rest_view(show->stage, show->visits.visitors.front());
  Projected top = project_point(view, {-3.05f, 1.3f, -2.9f});
  Projected wall = project_point(view, {-3.05f, 1.35f, -4});
  auto near =
      point_at(show->stage.exhibit, *show->stage.world, view, vec2(top.x / 96, top.y / 64 - 0.01f));
  ASSERT_TRUE(near);
  EXPECT_EQ(near->point, 0);
  auto far = point_at(show->stage.exhibit, *show->stage.world, view, vec2(wall.x / 96, 0.1f));
  ASSERT_TRUE(far);
  EXPECT_EQ(far->point, -1);
}

TEST_F(GoTest, WhatCannotBeIsSaid) {
  for (const auto& [order, code] : std::vector<std::pair<nlohmann::json, std::string>>{
           {{{"object", "moon"}}, "unknown_object"},
           {nlohmann::json::object(), "bad_field"},
           {{{"object", "statue"}, {"at", {0.5, 0.5}}}, "bad_field"},
           {{{"to", {origin.x - 2, 0, origin.z + 3}}}, "no_way"}}) {
    go(order);
    EXPECT_EQ(last("error")["code"], code) << order;
    EXPECT_FALSE(place().glide.path);
  }
}

TEST_F(GoTest, ATourWaitsAndIsGoneOnWith) {
  say(R"({"type":"tour","action":"play"})");
  run(0.2);
  go({{"object", "statue"}});
  EXPECT_EQ(place().tour.state, TourRide::State::paused);
  EXPECT_TRUE(place().glide.path);
  arrive();
  say(R"({"type":"tour","action":"play"})");
  step();
  EXPECT_EQ(place().tour.state, TourRide::State::playing);
  EXPECT_EQ(place().closer, -1);
}

TEST_F(GoTest, WhereVisitorsFlyTheyFlyThere) {
  Exhibit exhibit = make_room();
  exhibit.walk.reset();
  exhibit.tours.clear();
  browsers.clear();
  show.reset();
  begin(std::move(exhibit));
  EXPECT_FALSE(last("welcome")["map"]);
  go({{"to", {origin.x + 2, 0, origin.z + 3}}});
  arrive();
  EXPECT_NEAR(here().x, 2 - 1.2, 0.02);
  EXPECT_NEAR(here().y, 1.6, 1e-4);
}

// Counts the pixels of the last picture's view that show the statue, and says whether they touch a
// side.
struct SeenStatue {
  int pixels = 0;
  bool cut = false;
};
SeenStatue see_statue(const Show& show, const View& view) {
  SeenStatue seen;
  for (int y = 0; y < view.height; y++)
    for (int x = 0; x < view.width; x++) {
      const Hit hit =
          first_solid(*show.stage.world, view_ray(view, float(x) + 0.5f, float(y) + 0.5f));
      if (!hit.valid() || show.stage.world->object_of(hit.instance) != 3) continue;
      seen.pixels++;
      seen.cut |= x == 0 || y == 0 || x == view.width - 1 || y == view.height - 1;
    }
  return seen;
}

TEST_F(GoTest, AnObjectIsLookedAtFromAllSidesThroughWhatStandsInTheWay) {
  go({{"object", "statue"}, {"around", true}});
  EXPECT_EQ(last("error")["code"], "no_way") << "the exhibit does not say so";
  show->stage.exhibit.points[0].around = true;
  stand_at({-2, 1.6f, 3}, 0, 0);  // behind the wall, where it cannot be seen
  const Viewpoint before = place().view;
  go({{"object", "statue"}, {"around", true}});
  run(1.5);
  EXPECT_EQ(last("state")["around"], "statue");
  EXPECT_EQ(place().view.position, before.position) << "the visitor stays";
  std::vector<vec3> eyes;
  for (int i = 0; i < 8; i++) {
    const View view = rest_view(show->stage, show->visits.visitors.front());
    const SeenStatue seen = see_statue(*show, view);
    EXPECT_GT(seen.pixels, 96 * 64 / 20) << i;
    EXPECT_FALSE(seen.cut) << i;
    eyes.push_back(view.position);
    say(R"({"type":"input","seq":70,"look":[0.39269908,0]})");  // turned by twice that
    run(1);
  }
  EXPECT_LT(glm::length(eyes[0] + eyes[4] - 2.0f * vec3(-3.05f, eyes[0].y, -3.05f)), 0.05f);
  for (vec3 eye : eyes) EXPECT_NEAR(eye.y, eyes[0].y, 1e-3);
  say(R"({"type":"input","seq":71,"look":[0,-9]})");
  run(1);
  EXPECT_FALSE(see_statue(*show, rest_view(show->stage, show->visits.visitors.front())).cut)
      << "from above";
  const float far =
      glm::length(rest_view(show->stage, show->visits.visitors.front()).position - eyes[0]);
  EXPECT_GT(far, 0.1f);
  const double far_away = place().around.distance;
  say(R"({"type":"input","seq":72,"move":[0,0,2]})");
  run(1);
  say(R"({"type":"input","seq":73,"move":[0,0,0]})");
  EXPECT_LT(place().around.distance, 0.5 * far_away);
  go({{"object", "statue"}, {"around", false}});
  run(2);
  EXPECT_TRUE(last("state")["around"].is_null());
  EXPECT_EQ(place().around.point, -1);
  EXPECT_EQ(rest_view(show->stage, show->visits.visitors.front()).near, 0);
  EXPECT_EQ(place().view.position, before.position);
}

TEST_F(GoTest, WhoGoesAwayFromAnObjectThatIsTurnedStandsWhereTheyStood) {
  show->stage.exhibit.points[0].around = true;
  stand_at({-2, 1.6f, 3}, 0, 0);
  const dvec3 before = place().view.position;
  go({{"object", "statue"}, {"around", true}});
  run(1);
  say(R"({"type":"input","seq":80,"move":[0,0,1]})");
  run(0.5);
  EXPECT_EQ(place().view.position, before) << "moving brings it nearer";
  dvec3 to = origin + dvec3(-2, 0, 2);
  go({{"to", {to.x, to.y, to.z}}});
  EXPECT_EQ(place().around.point, -1);
  go({{"to", {to.x, to.y, to.z}}, {"around", true}});
  EXPECT_EQ(last("error")["code"], "bad_field");
}

TEST_F(GoTest, TheStorytellerTurnsToWhatIsLookedAtInHerSight) {
  Exhibit exhibit = make_room();
  add_storyteller(exhibit, "anna", origin + dvec3(-2.2, 0, -2.4));
  browsers.clear();
  show.reset();
  begin(std::move(exhibit));
  const vec3 statue(-3.05f, 1.05f, -3.05f);
  auto off = [&] {
    auto at = last("agent")["looking_at"];
    return glm::length(vec3(dvec3(at[0], at[1], at[2]) - origin) - statue);
  };
  stand_at({-1, 1.6f, -0.6f}, 0.6f, -0.1f);
  ASSERT_TRUE(sees_head(show->cast, show->cast.teller,
                        rest_view(show->stage, show->visits.visitors.front())));
  run(1);
  EXPECT_GT(off(), 0.5f);
  place().closer = 0;
  run(1);
  EXPECT_LT(off(), 0.1f);
}

}  // namespace
}  // namespace wellspring::test
