// SPDX-License-Identifier: Apache-2.0
#include "show/visit/place.h"

#include <gtest/gtest.h>

#include <cmath>

#include "picture/warp_picture.h"

namespace wellspring::test {
namespace {

View facing(float yaw, vec3 place = vec3(0)) {
  return View{.position = place,
              .right = vec3(std::cos(yaw), 0, -std::sin(yaw)),
              .up = vec3(0, 1, 0),
              .forward = vec3(-std::sin(yaw), 0, -std::cos(yaw)),
              .tan_half_fov = 0.52f,
              .width = 320,
              .height = 180};
}
float yaw_of(const View& view) { return std::atan2(-view.forward.x, -view.forward.z); }

// 60 ticks a second; the visitor's input arrives with every `every`-th.
TEST(Heading, GoesOnAsItWent) {
  for (int every : {1, 2}) {
    Heading heading;
    View view;
    for (int i = 0; i <= 30; i++) {
      int seen = i / every * every;
      view = facing(0.02f * float(seen), vec3(0, 0, -0.03f * float(seen)));
      EXPECT_FALSE(note_view(heading, i / 60.0, view));
    }
    View ahead = expected_view(heading, view, 0.1);
    EXPECT_NEAR(yaw_of(ahead) - yaw_of(view), 0.12f, every == 1 ? 1e-4f : 0.05f);
    EXPECT_NEAR(ahead.position.z - view.position.z, -0.18f, every == 1 ? 1e-4f : 0.07f);
    EXPECT_NEAR(expected_turn(heading, view, 0.1), std::abs(yaw_of(ahead) - yaw_of(view)), 1e-3f);
  }
}

// Ticks come later than the time over which motion is measured.
TEST(Heading, GoesOnAsItWentWhereTicksAreFew) {
  Heading heading;
  View view;
  for (int i = 0; i <= 4; i++) note_view(heading, i * 0.08, view = facing(0.1f * float(i)));
  EXPECT_NEAR(expected_turn(heading, view, 0.16), 0.2f, 1e-3f);
  note_view(heading, 0.32 + 0.6, view = facing(0.5f));  // nobody knows what was in between
  EXPECT_EQ(expected_turn(heading, view, 0.16), 0.0f);
}

TEST(Heading, WhoStopsIsExpectedToStaySoon) {
  Heading heading;
  View view = facing(0.6f);
  for (int i = 0; i <= 30; i++) note_view(heading, i / 60.0, facing(0.02f * float(i)));
  for (int i = 31; i <= 34; i++) note_view(heading, i / 60.0, view);
  EXPECT_EQ(expected_view(heading, view, 0.2), view);
  EXPECT_EQ(expected_turn(heading, view, 0.2), 0.0f);
}

TEST(Heading, AfterACameraCutTheViewIsExpectedToStay) {
  Heading heading;
  for (int i = 0; i < 5; i++)
    EXPECT_FALSE(note_view(heading, i / 60.0, facing(0, vec3(0.02f * float(i), 0, 0))));
  View there = facing(2, vec3(9, 0, 0));
  EXPECT_TRUE(note_view(heading, 5 / 60.0, there));
  EXPECT_EQ(expected_view(heading, there, 1), there);
  EXPECT_EQ(expected_view(Heading{}, there, 1), there);
}

// The share of `wanted` that a keyframe of the view `drawn` does not show, where all is far away.
float missing_share(const View& drawn, const View& wanted) {
  const size_t pixels = size_t(drawn.width) * size_t(drawn.height);
  Keyframe keyframe;
  make_keyframe(drawn, {drawn.width, drawn.height, std::vector<uint8_t>(3 * pixels, 128)},
                std::vector<float>(pixels, INFINITY), keyframe);
  WarpScratch scratch;
  Image8 out;
  return warp_picture(keyframe, wanted, 1, scratch, out);
}

// A keyframe drawn wide for a turn shows all of the view that the turn leads to.
TEST(Heading, MarginsAreAsWideAsTheTurn) {
  for (float turn : {0.0f, 0.01f, 0.05f}) {
    View wide = keyframe_view(facing(0), turn);
    EXPECT_LE(wide.width, 320 + 2 * 32);
    for (float yaw : {-turn, turn}) EXPECT_EQ(missing_share(wide, facing(yaw)), 0.0f) << turn;
  }
  EXPECT_EQ(keyframe_view(facing(0), 3).width,
            320 + 2 * 32);  // quicker turns are not followed farther
  EXPECT_EQ(keyframe_view(facing(0), NAN).width, keyframe_view(facing(0)).width);
}

// A visitor who turns by nearly half a radian while the next wide view is on its way sees no
// border; a step to the side does not need another wide view, several do.
TEST(WideView, HoldsWhatAPageMayTurnTo) {
  const View now = facing(0.7f, vec3(1, 2, 3));
  const View wide = wide_view(now);
  EXPECT_LT(wide.width * wide.height, now.width * now.height / 7);
  for (float turn : {-0.45f, -0.3f, 0.0f, 0.45f})
    EXPECT_EQ(missing_share(wide, facing(0.7f + turn, vec3(1, 2, 3))), 0) << turn;
  EXPECT_FALSE(is_elsewhere(wide, now));
  EXPECT_FALSE(is_elsewhere(wide, facing(0.9f, vec3(1.4f, 2, 3))));
  EXPECT_TRUE(is_elsewhere(wide, facing(1.6f, vec3(1, 2, 3))));
  EXPECT_TRUE(is_elsewhere(wide, facing(0.7f, vec3(1, 2, 5.5f))));
}

}  // namespace
}  // namespace wellspring::test
