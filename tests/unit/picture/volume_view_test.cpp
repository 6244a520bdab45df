// SPDX-License-Identifier: Apache-2.0
#include "picture/laid_view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <tuple>

#include "unit/volume/draw_made.h"

namespace wellspring::test {
namespace {

// Light that comes alike from everywhere, and is not stopped: what is seen is the preset's colour.
const VolumeLight even_light{.to_lamp = {0, 1, 0}, .lamp = vec3(0), .around = vec3(1)};

std::shared_ptr<const ShownVolume> made(glm::ivec3 size,
                                        const std::function<float(glm::vec3)>& value) {
  return std::make_shared<ShownVolume>(make_shown_volume(made_volume(size, value)));
}

PlacedVolume placed_at(vec3 position, std::shared_ptr<const ShownVolume> volume,
                       const Preset& preset) {
  PlacedVolume placed{.volume = volume, .position = position, .object = 7};
  placed.look.preset = std::make_shared<DrawnPreset>(*volume, preset, even_light);
  return placed;
}

// A cube of 40 mm of which a millimetre stops one hundredth.
PlacedVolume glass_cube(vec3 position, double density = 0.01) {
  return placed_at(position, made({40, 40, 40}, [](glm::vec3) { return 1.0f; }),
                   {"even", VolumeMode::density, {{0.0, vec3(1), density}}});
}

// A ball of 10 mm, whose front half is red.
PlacedVolume ball(vec3 position) {
  const vec3 red(1, 0, 0), blue(0, 0, 1);
  return placed_at(
      position,
      made({32, 32, 32}, [](glm::vec3 p) { return length(p) > 10 ? 1.5f
                                                  : p.z > 0      ? 3.0f
                                                                 : 0.0f; }),
      {"ball",
       VolumeMode::density,
       {{0.0, blue, 9}, {1.2, blue, 9}, {1.4, blue, 0}, {1.6, red, 0}, {1.8, red, 9}}});
}

// Looks along -Z from the origin; its middle pixel is (8, 8), at the sampling place (0, 0).
View straight(vec3 eye = vec3(0), float tan_half_fov = 0.02f) {
  View view;
  view.position = eye;
  view.width = view.height = 16;
  view.tan_half_fov = tan_half_fov;
  return view;
}

Laid middle_of(const std::vector<PlacedVolume>& volumes, const View& view,
               float surface = INFINITY) {
  return VolumeView(volumes, view, true, 0).look(8, 8, vec2(0), all_lanes(surface));
}

TEST(VolumeView, ShowsWhatTheVolumeLetsThrough) {
  const Laid laid = middle_of({glass_cube({0, 0, -0.5f})}, straight());
  EXPECT_NEAR(laid.clear[0], std::exp(-0.4f), 0.004f);
  EXPECT_EQ(laid.depth[0], INFINITY);
  EXPECT_NEAR(laid.light.x[0], 1 - laid.clear[0], 0.2f);
}

TEST(VolumeView, ASurfaceHidesWhatIsBehindIt) {
  const std::vector<PlacedVolume> volumes{glass_cube({0, 0, -0.5f})};
  EXPECT_EQ(middle_of(volumes, straight(), 0.4f).clear[0], 1);
  EXPECT_NEAR(middle_of(volumes, straight(), 0.5f).clear[0], std::exp(-0.2f), 0.006f);
}

TEST(VolumeView, TheFrontFacesAsAFigureDoes) {
  // A yaw of 0 faces -Z, away from an eye at the origin.
  for (auto [yaw, turn, red] : {std::tuple(0.0f, 0.0f, false), std::tuple(pi, 0.0f, true),
                                std::tuple(0.0f, pi, true), std::tuple(pi, pi, false)}) {
    PlacedVolume placed = ball({0, 0, -0.3f});
    placed.yaw = yaw, placed.look.turn = turn;
    const Laid laid = middle_of({placed}, straight());
    EXPECT_LT(laid.clear[0], 0.01f);
    EXPECT_EQ(laid.light.x[0] > laid.light.z[0], red) << yaw << " " << turn;
    EXPECT_NEAR(laid.depth[0], 0.29f, 0.0015f);
    EXPECT_EQ(laid.object[0], 7u);
  }
}

TEST(VolumeView, TurnsToTheLeft) {
  // The front faces the eye, and turned by a quarter to the left its own left, which is to +X of
  // who looks at it, is away from the eye: the red half lies on the eye's right.
  PlacedVolume placed = ball({0, 0, -0.3f});
  placed.yaw = pi, placed.look.turn = pi / 2;
  const VolumeView seen(std::span(&placed, 1), straight(), true, 0);
  const auto color = [&](float x) { return seen.look(8, 8, vec2(x, 0), all_lanes(INFINITY)); };
  const Laid right = color(0.25f), left = color(-0.25f);
  EXPECT_GT(right.light.x[0], right.light.z[0]);
  EXPECT_LT(left.light.x[0], left.light.z[0]);
}

TEST(VolumeView, AScaledVolumeLooksTheSameFromAsMuchFartherAway) {
  PlacedVolume large = glass_cube({0, 0, -50});
  large.scale = 100;
  EXPECT_NEAR(middle_of({large}, straight()).clear[0],
              middle_of({glass_cube({0, 0, -0.5f})}, straight()).clear[0], 1e-4f);
}

TEST(VolumeView, StandsFarFromTheOrigin) {
  const vec3 far(1e5f, -2e4f, 3e5f);
  PlacedVolume placed = ball(far + vec3(0, 0, -2));
  placed.scale = 40;
  const Laid laid = middle_of({placed}, straight(far));
  EXPECT_LT(laid.clear[0], 0.01f);
  EXPECT_NEAR(laid.depth[0], 2 - 0.4f, 0.07f);  // a step of coordinates is 0.03 m there
}

TEST(VolumeView, TheEyeMayBeInside) {
  const Laid laid = middle_of({glass_cube(vec3(0))}, straight());
  EXPECT_NEAR(laid.clear[0], std::exp(-0.2f), 0.005f);
}

TEST(VolumeView, NothingIsBehindTheEye) {
  EXPECT_TRUE(VolumeView(std::vector{glass_cube({0, 0, 1})}, straight(), true, 0).window().empty());
  const std::vector<PlacedVolume> beside{glass_cube({3, 0, -0.5f})};
  const VolumeView view(beside, straight(), true, 0);
  EXPECT_FALSE(view.shows(0, 0, 16));
}

TEST(VolumeView, WhatHasNoPresetIsNotLookedFor) {
  PlacedVolume placed = glass_cube({0, 0, -0.5f});
  placed.look.preset = nullptr;
  EXPECT_TRUE(VolumeView(std::span(&placed, 1), straight(), true, 0).window().empty());
}

TEST(VolumeView, TheNearerVolumeIsSeenBeforeTheOther) {
  const PlacedVolume red = ball({0, 0, -0.3f});
  PlacedVolume blue = ball({0, 0, -0.5f});
  PlacedVolume front = red;
  front.yaw = pi;
  for (const auto& volumes : {std::vector{front, blue}, std::vector{blue, front}})
    EXPECT_GT(middle_of(volumes, straight()).light.x[0], middle_of(volumes, straight()).light.z[0]);
}

TEST(VolumeView, VolumesInOnePlaceStopAsMuchAsBoth) {
  const Laid both =
      middle_of({glass_cube({0, 0, -0.5f}), glass_cube({0, 0, -0.5f}, 0.02)}, straight());
  const Laid one = middle_of({glass_cube({0, 0, -0.5f}, 0.03)}, straight());
  EXPECT_NEAR(both.clear[0], one.clear[0], 0.02f);
}

TEST(VolumeView, WhatIsInsideAnotherIsSeenThroughIt) {
  // A red ball in the middle of a cube that stops a tenth on the way to it.
  PlacedVolume red = ball({0, 0, -0.5f});
  red.yaw = pi;
  const Laid laid = middle_of({glass_cube({0, 0, -0.5f}, 0.01), red}, straight());
  EXPECT_NEAR(laid.depth[0], 0.49f, 0.002f);
  EXPECT_EQ(laid.object[0], 7u);
  EXPECT_GT(laid.light.x[0], laid.light.z[0]);
  EXPECT_GT(laid.light.z[0], 0.02f) << "the cube before the ball is white";
}

TEST(VolumeView, ASecondPresetIsMixedIn) {
  PlacedVolume placed = glass_cube({0, 0, -0.5f}, 0.1);
  placed.look.over = std::make_shared<DrawnPreset>(
      *placed.volume, Preset{"thin", VolumeMode::density, {{0.0, vec3(1), 0.0}}}, even_light);
  placed.look.share = 0.25f;
  EXPECT_NEAR(middle_of({placed}, straight()).clear[0], 0.25f + 0.75f * std::exp(-4.0f), 0.004f);
}

TEST(VolumeView, CutsTakeAwayWhatLiesBeforeThem) {
  PlacedVolume placed = glass_cube({0, 0, -0.5f});
  placed.yaw = pi;  // its axes are the scene's
  placed.look.cuts = {{vec3(0, 0, -1), 0}};
  EXPECT_NEAR(middle_of({placed}, straight()).clear[0], std::exp(-0.2f), 0.004f);
}

TEST(VolumeView, AGrazingRayIsSound) {
  const PlacedVolume placed = glass_cube({0, 0, -0.5f});
  const VolumeView view(std::span(&placed, 1), straight(vec3(0, 0.02f, 0)), true, 0);
  for (int y = 0; y < 16; y++)
    for (int x = 0; x < 16; x += lane_count) {
      const Laid laid = view.look(x, y, vec2(0.5f), all_lanes(INFINITY));
      for (int k = 0; k < lane_count; k++) {
        EXPECT_GE(laid.clear[k], 0) << x << " " << y;
        EXPECT_LE(laid.clear[k], 1);
        EXPECT_TRUE(is_finite(laid.light.at(k)));
      }
    }
}

Frame grey_frame(const View& view, float depth) {
  Frame frame;
  fit_frame(view.width, view.height, frame);
  std::ranges::fill(frame.color, vec3(0.5f));
  std::ranges::fill(frame.depth, depth);
  std::ranges::fill(frame.object, 1u);
  return frame;
}

TEST(LaidLayer, LaysTheMeanOverAFrameAtRest) {
  const std::vector<PlacedVolume> volumes{ball({0, 0, -0.3f})};
  const View view = straight(vec3(0), 0.05f);
  LaidLayer layer;
  LaidWork work;
  Frame frame;
  for (int i = 0; i < 3; i++) {
    frame = grey_frame(view, 2);
    layer.lay_over({volumes, {}}, view, 1, work, frame);
  }
  const size_t middle = 8 * 16 + 8, corner = 0;
  EXPECT_GT(frame.color[middle].z, 0.2f);
  EXPECT_LT(frame.color[middle].x, 0.05f);
  EXPECT_NEAR(frame.depth[middle], 0.29f, 0.003f);
  EXPECT_EQ(frame.object[middle], 7u);
  EXPECT_EQ(frame.color[corner], vec3(0.5f));
  EXPECT_EQ(frame.depth[corner], 2);
  // An edge pixel shows some of both.
  int edges = 0;
  for (size_t x = 0; x < 16; x++) {
    const float red = frame.color[8 * 16 + x].x;
    edges += red > 0.06f && red < 0.44f;
  }
  EXPECT_GE(edges, 1) << "no pixel of the edge is antialiased";
}

TEST(LaidLayer, MorePlacesAtOnceAreTheSameAsOneAfterTheOther) {
  const std::vector<PlacedVolume> volumes{glass_cube({0, 0, -0.5f})};
  const View view = straight();
  LaidLayer one, all;
  LaidWork work;
  Frame a = grey_frame(view, 2), b;
  all.lay_over({volumes, {}}, view, 5, work, a);
  for (int i = 0; i < 5; i++)
    b = grey_frame(view, 2), one.lay_over({volumes, {}}, view, 1, work, b);
  for (size_t i = 0; i < a.color.size(); i++) EXPECT_EQ(a.color[i], b.color[i]) << i;
}

TEST(LaidLayer, BeginsAnewForAnotherLook) {
  std::vector<PlacedVolume> volumes{glass_cube({0, 0, -0.5f}, 1)};
  const View view = straight();
  LaidLayer layer;
  LaidWork work;
  Frame frame = grey_frame(view, 2);
  layer.lay_over({volumes, {}}, view, 4, work, frame);
  EXPECT_LT(frame.depth[8 * 16 + 8], 0.5f);
  volumes[0].look.preset = nullptr;
  frame = grey_frame(view, 2);
  layer.lay_over({volumes, {}}, view, 1, work, frame);
  EXPECT_EQ(frame.color[8 * 16 + 8], vec3(0.5f));
  EXPECT_EQ(frame.depth[8 * 16 + 8], 2);
}

}  // namespace
}  // namespace wellspring::test
