// SPDX-License-Identifier: Apache-2.0
// Lawns are laid over pictures where they are nearer than what is drawn, in the light of their
// ground.
#include "picture/grass_view.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/rng.h"
#include "picture/laid_view.h"
#include "scenes/build.h"
#include "unit/lawn/made.h"

namespace wellspring::test {
namespace {

using namespace scenes;

constexpr int side = 64;

// A meadow of 4 x 4 m, dense enough to hide its ground, seen from its edge.
struct Meadow {
  Scene scene = empty_scene();
  World world{scene};
  LawnDescription description = small_meadow();
  Lawn lawn;
  LawnState state;
  ShownLawn shown;
  LaidWork work;
  View view;

  explicit Meadow(float density = 3000, float transmission = 0.35f) {
    description.density = density;
    description.colors.transmission = transmission;
    lawn = make_lawn(description);
    state = make_lawn_state(lawn);
    shown.lawn = &lawn, shown.state = &state, shown.object = 7;
    shown.wind.strength = 0;
    for (const LawnTile& tile : lawn.tile)
      shown.bounds.low = min(shown.bounds.low, tile.low),
      shown.bounds.high = max(shown.bounds.high, tile.high);
    light({1, 1}, {{vec3(1), vec3(0), vec3(0, 1, 0), true}});
    view.position = {0, 1.2f, 2.6f};
    view.forward = normalize(vec3(0, -0.5f, -1));
    view.up = cross(view.right, view.forward);
    view.width = view.height = side;
  }
  void light(ivec2 size, std::vector<LawnLight::Node> nodes) {
    shown.light = std::make_shared<LawnLight>(LawnLight{size, std::move(nodes)});
  }
  LaidThings things() const { return laid_things(world, nullptr, nullptr, 1, {&shown, 1}); }
  // Eight pixels of the middle row from x on.
  Laid look(int x, float surface = INFINITY) {
    const LaidView laid(things(), view, vec2(0.5f), false, 0, work);
    return laid.shows(x, side / 2, lane_count) ? laid.look(x, side / 2, all_lanes(surface))
                                               : Laid{};
  }
  // The mean light and clearness of all pixels of some columns.
  vec4 mean(int from, int to) {
    const LaidView laid(things(), view, vec2(0.5f), false, 0, work);
    vec4 sum(0);
    for (int y = 0; y < side; y++)
      for (int x = from; x < to; x += lane_count) {
        const Laid one = laid.look(x, y, all_lanes(INFINITY));
        for (int k = 0; k < lane_count; k++) sum += vec4(one.light.at(k), one.clear[k]);
      }
    return sum / float(side * (to - from));
  }
};

TEST(GrassView, GrassHidesWhatIsBehindAndIsHiddenByWhatIsBefore) {
  Meadow meadow;
  const Laid free = meadow.look(side / 2);
  ASSERT_LT(free.clear[0], 0.5f);
  const float depth = free.depth[0];
  EXPECT_NEAR(depth, 2.6f, 0.8f);
  EXPECT_EQ(free.object[0], 7u);
  EXPECT_GT(free.light.at(0).y, 0);
  const Laid before_wall = meadow.look(side / 2, depth + 0.5f);
  EXPECT_EQ(before_wall.clear[0], free.clear[0]);
  const Laid behind_wall = meadow.look(side / 2, depth - 0.5f);
  EXPECT_EQ(behind_wall.clear[0], 1);
  EXPECT_EQ(behind_wall.light.at(0), vec3(0));
  EXPECT_EQ(behind_wall.depth[0], INFINITY);
}

TEST(GrassView, BladesCoverPixelsInPart) {
  Meadow meadow(250);
  int part = 0;
  for (int x = 0; x < side; x += lane_count) {
    const Laid laid = meadow.look(x);
    for (int k = 0; k < lane_count; k++) part += laid.clear[k] > 0.02f && laid.clear[k] < 0.98f;
  }
  EXPECT_GT(part, side / 8);
}

TEST(GrassView, TheMeanOfExactPicturesIsAboutThePictureInPart) {
  Meadow meadow(400);
  const vec4 part = meadow.mean(0, side);
  vec4 exact(0);
  constexpr int places = 16;
  const std::vector<float> before(side * side, INFINITY);
  for (int i = 0; i < places; i++) {
    const LaidView laid(meadow.things(), meadow.view, spread_in_pixel(i), true, 0, meadow.work,
                        before);
    for (int y = 0; y < side; y++)
      for (int x = 0; x < side; x += lane_count) {
        const Laid one = laid.look(x, y, all_lanes(INFINITY));
        for (int k = 0; k < lane_count; k++)
          exact += vec4(one.light.at(k), one.clear[k]) / float(places * side * side);
      }
  }
  for (int c = 0; c < 4; c++) EXPECT_NEAR(part[c], exact[c], 0.12f * exact[c]) << c;
}

// Returns how grass sways in a keyframe that shows the meadow before a wall at that depth.
SwayImage sway_before(Meadow& meadow, float wall) {
  const LaidView laid(meadow.things(), meadow.view, vec2(0.5f), false, 0, meadow.work);
  Keyframe keyframe;
  const std::vector<float> depth(side * side, wall);
  make_keyframe(meadow.view, {side, side, std::vector<uint8_t>(3 * side * side)}, depth, keyframe);
  return find_sway({&meadow.shown, 1}, meadow.work.lawns, keyframe);
}
float sum_of(const SwayImage& sway) {
  float sum = 0;
  for (const uint8_t code : sway.code) sum += code;
  return sum;
}

TEST(GrassView, DisplaysAreToldHowFarGrassSways) {
  Meadow meadow;
  EXPECT_TRUE(sway_before(meadow, INFINITY).code.empty()) << "no wind";
  meadow.shown.wind.strength = 1;
  meadow.state.time = 7.5;
  const SwayImage sway = sway_before(meadow, INFINITY);
  EXPECT_EQ(sway.columns, side / SwayImage::block);
  EXPECT_EQ(sway.rows, side / SwayImage::block);
  EXPECT_EQ(sway.time, 7.5);
  // Tips of 18 cm move 6 cm, 1.4 m away; the meadow begins below the horizon.
  const float focal = 0.5f * side / meadow.view.tan_half_fov;
  const uint8_t most = *std::ranges::max_element(sway.code);
  EXPECT_GT(float(most), 0.01f * focal / 2);
  EXPECT_LT(float(most), 0.09f * focal / 1.2f);
  EXPECT_EQ(sway.code[0], 0);
  meadow.shown.wind.strength = 2;
  EXPECT_GT(sum_of(sway_before(meadow, INFINITY)), 1.5f * sum_of(sway));
}

TEST(GrassView, WhatIsHiddenDoesNotSway) {
  Meadow meadow;
  meadow.shown.wind.strength = 1;
  const float all = sum_of(sway_before(meadow, INFINITY));
  EXPECT_EQ(sum_of(sway_before(meadow, 0.5f)), 0);
  const float some = sum_of(sway_before(meadow, 2.6f));
  EXPECT_GT(some, 0.1f * all);
  EXPECT_LT(some, 0.9f * all);
}

TEST(GrassView, GrassIsBrighterWhereTheGroundIs) {
  Meadow meadow;
  const vec3 up(0, 1, 0);
  meadow.light({2, 1}, {{vec3(0.1f), vec3(0), up, true}, {vec3(1), vec3(0), up, true}});
  EXPECT_GT(meadow.mean(side - 16, side).y, 3 * meadow.mean(0, 16).y);
}

TEST(GrassView, NodesOfBareGroundDarkenNothing) {
  Meadow meadow;
  const vec4 even = meadow.mean(0, side);
  meadow.light({2, 1}, {{vec3(0), vec3(0), vec3(0), false}, {vec3(1), vec3(0), {0, 1, 0}, true}});
  EXPECT_NEAR(meadow.mean(0, side).y, even.y, 1e-4f);
}

TEST(GrassView, BladesLetLightThroughFromBehind) {
  const vec3 behind = normalize(vec3(0, 0.2f, -1));
  float light[2];
  for (const int through : {0, 1}) {
    Meadow meadow(3000, float(through));
    meadow.light({1, 1}, {{vec3(0), vec3(1), behind, true}});
    light[through] = meadow.mean(0, side).y;
  }
  EXPECT_GT(light[1], 1.3f * light[0]);
}

TEST(GrassView, NothingIsDrawnOfALawnBehindAWall) {
  Meadow meadow;
  EXPECT_TRUE(sees_lawns(meadow.world, {&meadow.shown, 1}, meadow.view));
  Scene walled = empty_scene();
  add_quad(walled, diffuse(vec3(0.5f)), {-9, -9, 2.2f}, {18, 0, 0}, {0, 18, 0}, "wall");
  const World world(walled);
  EXPECT_FALSE(sees_lawns(world, {&meadow.shown, 1}, meadow.view));
  LawnWork work;
  EXPECT_FALSE(
      GrassView({&meadow.shown, 1}, {.world = &world}, meadow.view, vec2(0.5f), {}, work).any());
  View away = meadow.view;
  away.forward = -away.forward, away.right = -away.right;
  EXPECT_FALSE(sees_lawns(meadow.world, {&meadow.shown, 1}, away));
}

TEST(GrassView, AFrameAtRestShowsItUntilBladesMove) {
  Meadow meadow;
  LaidLayer layer;
  auto picture = [&] {
    Frame frame;
    fit_frame(side, side, frame);
    std::ranges::fill(frame.color, vec3(0)), std::ranges::fill(frame.depth, INFINITY);
    layer.lay_over(meadow.things(), meadow.view, 4, meadow.work, frame);
    return frame.color[size_t(side) * (side / 2) + side / 2];
  };
  const vec3 first = picture();
  EXPECT_GT(first.y, 0);
  meadow.light({1, 1}, {{vec3(0), vec3(0), vec3(0, 1, 0), true}});
  EXPECT_EQ(picture(), vec3(0)) << "the mean of before shows another light";
}

}  // namespace
}  // namespace wellspring::test
