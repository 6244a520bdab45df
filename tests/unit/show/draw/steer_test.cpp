// SPDX-License-Identifier: Apache-2.0
// Attention steers where samples go.
#include "show/draw/steer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "cache/point_cache.h"
#include "cache/point_image.h"
#include "show/http/answer.h"
#include "show/draw/pace.h"
#include "show/state/renderer.h"
#include "show/state/visitor_picture.h"
#include "unit/show/show_stage.h"

namespace wellspring::test {
namespace {

using nlohmann::json;
constexpr uint32_t left = 3, right = 4;  // objects

void add_cube(Exhibit& exhibit, vec3 middle, const char* name) {
  Mesh cube;
  float r = 0.25f;
  vec3 x(2 * r, 0, 0), y(0, 2 * r, 0), z(0, 0, 2 * r), corner = middle - vec3(r);
  add_quad(cube, corner, y, x), add_quad(cube, corner + z, x, y);
  add_quad(cube, corner, z, y), add_quad(cube, corner + x, y, z);
  add_quad(cube, corner, x, z), add_quad(cube, corner + y, z, x);
  Scene& scene = exhibit.scene;
  scene.meshes.push_back(cube);
  scene.objects.push_back(name);
  const uint32_t object = uint32_t(scene.objects.size()) - 1;
  scene.instances.push_back({int(scene.meshes.size()) - 1, mat4(1), object});
  exhibit.points.push_back({name, name, {object}, dvec3(middle), {}});
}

// Two cubes alike, left and right of the middle of the picture.
Exhibit make_cubes() {
  Exhibit exhibit = make_tiny_exhibit();
  exhibit.tours.clear();
  add_cube(exhibit, vec3(-2.8f, 1.6f, 1), "left");
  add_cube(exhibit, vec3(-1.2f, 1.6f, 1), "right");
  return exhibit;
}

struct Steering : testing::Test, ShowStage {
  void begin(int width = 160, int height = 90) {
    ShowSettings settings = settings_for("direct");
    settings.late_samples = false;
    browsers.clear(), seq = 0, now = 0;
    ShowStage::begin(make_cubes(), settings);
    join(width, height);
    tick_seconds = 0.05;
  }
  // 0 to 1, of the picture.
  vec2 place_of(uint32_t object) {
    const View& view = visitor().place.last_view;
    for (const PointOfInterest& point : show->stage.exhibit.points)
      if (point.objects.front() == object) {
        Projected at = project_point(view, vec3(point.place));
        return {at.x / float(view.width), at.y / float(view.height)};
      }
    return {};
  }
  void point_at(uint32_t object) {
    vec2 at = place_of(object);
    say(json{{"type", "input"}, {"seq", ++seq}, {"pointer", {at.x, at.y}}}.dump());
  }
  void ask_attention(const json& attention) {
    say(json{{"type", "settings"}, {"attention", attention}}.dump());
  }
  float weight(uint32_t object) {
    const auto& weights = visitor().looks.weights;
    return weights && object < weights->size() ? (*weights)[object] : 1;
  }
  // Counts the object's requests in so many pictures.
  double requests_of(uint32_t object, int pictures) {
    double count = 0;
    for (int i = 0; i < pictures; i++) {
      step();
      const RenderCache& cache = visitor().picture->cache;
      for (const Request& request : show->drawing->renderer.work.requests) {
        if (request.pixel >= cache.image().point.size()) continue;
        uint32_t point = cache.image().point[request.pixel];
        count += point != no_point && cache.points().color[point].object == object;
      }
    }
    return count;
  }
};

TEST_F(Steering, APointerOnAnObjectRaisesItsSamples) {
  double found[2] = {};
  for (uint32_t object : {left, right}) {
    begin();
    steps(20);
    ask_attention(1);
    point_at(object);
    steps(4);
    EXPECT_GT(weight(object), 1.5f * weight(left + right - object));
    found[object - left] = requests_of(left, 20);
  }
  EXPECT_GT(found[0], 1.5 * found[1]);
}

// One picture is analysed with and without a pointer.
TEST_F(Steering, TheSliderGoesFromTheEyeToTheTask) {
  begin();
  ask_attention(0.25);
  steps(10);
  point_at(left);
  steps(10);
  EXPECT_EQ(visitor().wants.task_weight, 0.25f);
  EXPECT_EQ(visitor().looks.cause.task_weight, 0.25f);
  ASSERT_EQ(visitor().looks.cause.hints.size(), 1u);
  AttentionAnalysis analysis;
  auto weights_of = [&](float task_weight, bool points) {
    analysis.cause = visitor().looks.cause;
    analysis.cause.task_weight = task_weight;
    if (!points) analysis.cause.hints.clear();
    analyse(analysis);
    return *analysis.weights;
  };
  EXPECT_EQ(weights_of(0, true), weights_of(0, false));
  EXPECT_EQ(weights_of(0.25f, true), *visitor().looks.weights);  // and again
  const ObjectWeights task = weights_of(1, true);
  for (float one : task) EXPECT_LE(one, task[left]);
  EXPECT_GT(task[left], 4 * weights_of(1, false)[left]);
}

TEST_F(Steering, OnlyWhereAttentionIsWanted) {
  begin();
  ask_attention(false);
  steps(20);
  EXPECT_EQ(show->totals.attention_analyses, 0u);
  EXPECT_FALSE(visitor().looks.weights);
  ask_attention(true);
  steps(20);
  EXPECT_GT(show->totals.attention_analyses, 0u);
  EXPECT_EQ(visitor().wants.task_weight, 0.5f);
}

TEST_F(Steering, RestsWhenThereIsNothingLeftToLearn) {
  begin(64, 48);
  // Nothing but a wall.
  say(json{{"type", "camera"}, {"seq", 1}, {"position", {-2.5, 1.6, 2}}, {"yaw", pi / 2}}.dump());
  ASSERT_TRUE(step_until([&] { return rests(*show, visitor()); }, 4000));
  steps(3);
  const uint64_t before = show->totals.attention_analyses;
  EXPECT_GT(before, 3u);
  for (int i = 0; i < 40; i++) {
    say(json{{"type", "input"}, {"seq", ++seq}, {"pointer", {0.5, 0.02 * i}}}.dump());
    step();
  }
  EXPECT_EQ(show->totals.attention_analyses, before);
  const std::string told = write_metrics(make_report(*show));
  EXPECT_NE(told.find("wellspring_attention_analyses_total " + std::to_string(before)),
            std::string::npos);
  turn(0.2);
  steps(10);
  EXPECT_GT(show->totals.attention_analyses, before);
}

TEST_F(Steering, GoesOnBesideDrawing) {
  begin();
  ASSERT_TRUE(step_until([&] { return visitor().picture->job.weights != nullptr; }));
  EXPECT_GT(show->totals.attention_analyses, 0u);
  point_at(right);
  ASSERT_TRUE(step_until([&] { return !visitor().looks.cause.hints.empty(); }));
  EXPECT_GT(weight(right), weight(left));
}

TEST_F(Steering, RefusesHintsThatAreNoNumbers) {
  begin();
  steps(10);
  const SeenPicture& seen = *visitor().looks.seen;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (vec2 place : {vec2(nan, 0.5f), vec2(0.5f, nan), vec2(nan, INFINITY)}) {
    visitor().looks.pointer = place, visitor().looks.pointed_at = show->time;
    EXPECT_TRUE(find_hints(*show, visitor(), seen).empty());
  }
  visitor().looks.pointer = vec2(0.5f);
  EXPECT_EQ(find_hints(*show, visitor(), seen).size(), 1u);
  visitor().looks.pointed_at = show->time - pointer_lifetime - 1;
  EXPECT_TRUE(find_hints(*show, visitor(), seen).empty());
}

TEST_F(Steering, AHeadBeforeAKioskTellsWhereItsEyesAre) {
  begin();
  steps(10);
  const SeenPicture& seen = *visitor().looks.seen;
  Person person{.position = vec3(0, 0, viewing_distance), .confidence = 1};
  auto hints_of = [&](float yaw, float pitch) {
    person.rotation = vec3(yaw, pitch, 0);
    show->kiosks.eyes.clear();
    Eye& eye = show->kiosks.eyes.emplace_back();
    eye.seen.state = Presence::person;
    eye.seen.people = {person};
    eye.received = show->time;
    return find_hints(*show, visitor(), seen);
  };
  EXPECT_TRUE(hints_of(0, 0).empty());  // a visitor at home
  visitor().kiosk = true;
  vec2 middle = 0.5f * vec2(float(seen.picture.width), float(seen.picture.height));
  ASSERT_EQ(hints_of(0, 0).size(), 1u);
  EXPECT_NEAR(hints_of(0, 0)[0].place.x, middle.x, 1);
  EXPECT_NEAR(hints_of(0, 0)[0].place.y, middle.y, 1);
  EXPECT_GT(hints_of(0.2f, 0)[0].place.x, middle.x + 5);
  EXPECT_LT(hints_of(0, 0.2f)[0].place.y, middle.y - 5);
  person.confidence = NAN;
  EXPECT_TRUE(hints_of(0, 0).empty());
  show->kiosks.eyes.clear();
}

TEST_F(Steering, WhatIsToldOfIsLookedAt) {
  begin();
  steps(10);
  const SeenPicture& seen = *visitor().looks.seen;
  show->cast.teller.voice.queue.emplace_back();
  EXPECT_TRUE(find_hints(*show, visitor(), seen).empty());
  show->cast.teller.voice.held.point = "right";
  std::vector<AttentionHint> hints = find_hints(*show, visitor(), seen);
  ASSERT_EQ(hints.size(), 1u);
  EXPECT_NEAR(hints[0].place.x / float(seen.picture.width), place_of(right).x, 0.02);
  EXPECT_NEAR(hints[0].place.y / float(seen.picture.height), place_of(right).y, 0.02);
  show->cast.teller.voice.queue.clear();
}

}  // namespace
}  // namespace wellspring::test
