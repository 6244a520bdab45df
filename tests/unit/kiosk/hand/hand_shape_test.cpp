// SPDX-License-Identifier: Apache-2.0
// Poses, counted fingers, places and pointing, from landmarks that are made up.
#include "kiosk/hand/hand_shape.h"

#include <gtest/gtest.h>

#include "unit/kiosk/hand/made_hand.h"

namespace wellspring::test {
namespace {

const Mount level;

MadeHand showing(std::array<bool, 5> stretched, float roll = 0, float pitch = 0) {
  MadeHand hand;
  hand.stretched = stretched, hand.roll = roll, hand.pitch = pitch;
  return hand;
}

TEST(HandShape, FingersAreCountedHoweverTheHandIsTurned) {
  const std::pair<std::array<bool, 5>, int> hands[] = {
      {{false, false, false, false, false}, 0}, {{false, true, false, false, false}, 1},
      {{true, false, false, false, false}, 1},  {{false, true, true, false, false}, 2},
      {{true, true, false, false, false}, 2},   {{true, true, true, false, false}, 3},
      {{false, true, true, true, true}, 4},     {{true, true, true, true, true}, 5}};
  for (const auto& [stretched, count] : hands)
    for (float roll : {-1.2f, 0.f, 0.7f})
      for (float pitch : {-0.6f, 0.f, 0.9f}) {
        const HandShape shape = shape_of(marks_of(showing(stretched, roll, pitch)));
        EXPECT_EQ(shape.stretched, stretched) << count << " at " << roll << ", " << pitch;
        EXPECT_EQ(shape.fingers, count);
      }
}

TEST(HandShape, PosesHaveNames) {
  EXPECT_EQ(shape_of(marks_of(showing({true, true, true, true, true}))).pose, HandPose::open);
  EXPECT_EQ(shape_of(marks_of(showing({false, false, false, false, false}))).pose, HandPose::fist);
  EXPECT_EQ(shape_of(marks_of(showing({false, true, false, false, false}))).pose, HandPose::point);
  EXPECT_EQ(shape_of(marks_of(showing({false, true, true, false, false}))).pose, HandPose::other);
  // Thumb and index are a two.
  EXPECT_EQ(shape_of(marks_of(showing({true, true, false, false, false}))).pose, HandPose::other);
  MadeHand pinch = showing({true, true, true, true, true});
  pinch.pinched = true;
  EXPECT_EQ(shape_of(marks_of(pinch)).pose, HandPose::pinch);
}

TEST(HandShape, SignsAreHeldUp) {
  EXPECT_TRUE(shape_of(marks_of(showing({true, true, true, true, true}))).upright);
  EXPECT_FALSE(shape_of(marks_of(showing({true, true, true, true, true}, 1.5f))).upright);
  // A finger that points to the screen is not held up.
  EXPECT_FALSE(shape_of(marks_of(showing({false, true, false, false, false}, 0, 1.2f))).upright);
  EXPECT_NEAR(shape_of(marks_of(showing({true, true, true, true, true}, 0.4f))).roll, 0.4f, 1e-3f);
}

TEST(HandShape, ThePlaceFollowsFromTheSize) {
  for (float z : {0.4f, 0.8f, 2.f})
    for (float pitch : {0.f, 0.8f}) {
      MadeHand hand = showing({true, true, true, true, true}, 0, pitch);
      hand.palm = {0.1f, -0.05f, z};
      const auto place =
          place_hand(marks_of(hand), focal_length(level, hand_picture_width, hand_picture_width),
                     hand_picture_width, hand_picture_height);
      ASSERT_TRUE(place);
      const vec3 palm = camera_to_screen(level, place->palm);
      EXPECT_NEAR(palm.z, z, 0.12f * z + 0.05f) << pitch;
      EXPECT_NEAR(palm.x, 0.1f, 0.05f);
    }
}

TEST(HandShape, DamagedLandmarksHaveNoPlace) {
  HandMarks marks = marks_of(MadeHand{});
  marks.metres[middle_root_point] = marks.metres[wrist_point];
  EXPECT_FALSE(place_hand(marks, 500, 640, 480));
  EXPECT_FALSE(place_hand(HandMarks{}, 500, 640, 480));
  marks = marks_of(MadeHand{});
  marks.points[index_root_point].x = NAN;
  EXPECT_FALSE(place_hand(marks, 500, 640, 480));
}

TEST(HandShape, ARayMeetsTheScreen) {
  const auto place = point_on_screen({0, 0.3f, 1}, {0.1f, 0.2f, 0.5f});
  ASSERT_TRUE(place);
  EXPECT_NEAR(place->x, 0.2f, 1e-5f);
  EXPECT_NEAR(place->y, 0.1f, 1e-5f);
  EXPECT_FALSE(point_on_screen({0, 0, 0.5f}, {0, 0, 1}));      // away from it
  EXPECT_FALSE(point_on_screen({0, 0, 1}, {1, 0, 0.99f}));     // along it
  EXPECT_FALSE(point_on_screen({0, 0, 1}, {0.9f, 0, 0.75f}));  // far beside it
  EXPECT_FALSE(point_on_screen({0, 0, 1}, {NAN, 0, 0.5f}));
}

}  // namespace
}  // namespace wellspring::test
