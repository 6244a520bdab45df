// SPDX-License-Identifier: Apache-2.0
// Hands are followed from their own landmarks, and found where they may be.
#include "kiosk/hand/hands.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "base/load_error.h"
#include "unit/folder.h"
#include "unit/kiosk/hand/made_hand.h"

namespace wellspring::test {
namespace {

// A network that reads whichever made hand's wrist and fingers lie in the square.
struct Scene {
  HandTracks tracks{Mount{}};
  std::vector<MadeHand> hands;
  int reads = 0;

  std::vector<Hand> step(double time, std::span<const Cut> places) {
    const HandLook look{time, hand_picture_width, hand_picture_height, vec3(0, 0.1f, 0.9f), places};
    return tracks.step(look, [&](const Cut& square) {
      reads++;
      HandMarks best;
      for (const MadeHand& hand : hands) {
        const HandMarks marks = marks_of(hand);
        const vec2 off = vec2(marks.points[middle_root_point]) - square.middle;
        if (glm::length(off) < 0.4f * square.width) return marks;
      }
      return best;
    });
  }
};

Cut place_of(const MadeHand& hand) {
  const HandMarks marks = marks_of(hand);
  return hand_cut_of_place(
      vec2(marks.points[middle_root_point]),
      0.1f * focal_length(Mount{}, hand_picture_width, hand_picture_width) / hand.palm.z);
}

TEST(Hands, AHandIsFoundAndFollowedWithoutFurtherPlaces) {
  Scene scene;
  scene.hands.emplace_back();
  const Cut place = place_of(scene.hands[0]);
  ASSERT_EQ(scene.step(0, std::span(&place, 1)).size(), 1u);
  for (double t = 0.07; t < 2; t += 0.07) {
    scene.hands[0].palm.x += 0.03f;
    if (scene.hands[0].palm.x > 0.3f) scene.hands[0].palm.x = 0.3f;
    const auto found = scene.step(t, {});
    ASSERT_EQ(found.size(), 1u) << t;
    EXPECT_EQ(found[0].fingers, std::optional(5));
    EXPECT_EQ(found[0].pose, HandPose::open);
  }
  EXPECT_NEAR(scene.step(2.1, {})[0].position.x, 0.3f, 0.05f);
  scene.hands.clear();
  for (double t = 2.2; t < 2.7; t += 0.07) scene.step(t, {});
  EXPECT_TRUE(scene.step(2.8, {}).empty());
  EXPECT_FALSE(scene.tracks.index_tip());
}

TEST(Hands, TwoHandsAreTwoAndTheHigherIsFirst) {
  Scene scene;
  scene.hands.resize(2);
  scene.hands[0].palm = {-0.25f, -0.2f, 0.6f}, scene.hands[1].palm = {0.25f, 0, 0.6f};
  const std::vector<Cut> places = {place_of(scene.hands[0]), place_of(scene.hands[1]),
                                   place_of(scene.hands[1])};
  const auto found = scene.step(0, places);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_GT(found[0].position.x, 0);
  // Never more than two reads a frame.
  const int before = scene.reads;
  scene.step(0.07, places);
  EXPECT_EQ(scene.reads, before + 2);
}

TEST(Hands, OneHandIsNotTwo) {
  Scene scene;
  scene.hands.resize(1);
  Cut near = place_of(scene.hands[0]);
  near.middle.x += 20;
  const std::vector<Cut> places = {place_of(scene.hands[0]), near};
  for (double t = 0; t < 1; t += 0.07) EXPECT_EQ(scene.step(t, places).size(), 1u);
}

TEST(Hands, APlaceWithoutAHandIsNotReadInEveryFrame) {
  Scene scene;
  const Cut place{{100, 100}, 80, 80, 0};
  for (double t = 0; t < 2; t += 0.05) EXPECT_TRUE(scene.step(t, std::span(&place, 1)).empty());
  EXPECT_LE(scene.reads, 6);
}

TEST(Hands, AHandOutOfReachBelongsToSomebodyElse) {
  Scene scene;
  scene.hands.resize(1);
  scene.hands[0].palm = {0, 0, 2.4f};
  const Cut place = place_of(scene.hands[0]);
  EXPECT_TRUE(scene.step(0, std::span(&place, 1)).empty());
}

TEST(Hands, APointingHandPointsAlongTheLineFromTheEye) {
  Scene scene;
  scene.hands.resize(1);
  MadeHand& hand = scene.hands[0];
  hand.stretched = {false, true, false, false, false};
  hand.pitch = 0.9f, hand.palm = {0.1f, -0.1f, 0.6f};
  const Cut place = place_of(hand);
  scene.step(0, std::span(&place, 1));
  const auto found = scene.step(0.07, {});
  ASSERT_EQ(found.size(), 1u);
  ASSERT_EQ(found[0].pose, HandPose::point);
  ASSERT_TRUE(found[0].points_at);
  // The eye is 0.3 m behind a fingertip that is a little below and beside it.
  const vec3 tip = camera_to_screen(
      Mount{}, screen_to_camera(Mount{}, hand.palm) + metres_of(hand)[index_tip_point]);
  const auto wanted = point_on_screen({0, 0.1f, 0.9f}, tip);
  ASSERT_TRUE(wanted);
  EXPECT_NEAR(found[0].points_at->x, wanted->x, 0.08f);
  EXPECT_NEAR(found[0].points_at->y, wanted->y, 0.12f);
  hand.stretched = {true, true, true, true, true};
  scene.step(0.14, {});
  EXPECT_FALSE(scene.step(0.21, {})[0].points_at);
}

TEST(Hands, AHandAtTheRimIsFollowed) {
  Scene scene;
  scene.hands.resize(1);
  scene.hands[0].palm = {-0.33f, -0.1f, 0.6f};
  const Cut place = place_of(scene.hands[0]);
  EXPECT_EQ(scene.step(0, std::span(&place, 1)).size(), 1u);
  EXPECT_EQ(scene.step(0.07, {}).size(), 1u);
}

TEST(Hands, AClockThatRunsBackwardsForgetsThem) {
  Scene scene;
  scene.hands.resize(1);
  const Cut place = place_of(scene.hands[0]);
  EXPECT_EQ(scene.step(5, std::span(&place, 1)).size(), 1u);
  EXPECT_TRUE(scene.step(1, {}).empty());
  EXPECT_EQ(scene.step(1.1, std::span(&place, 1)).size(), 1u);
  EXPECT_TRUE(scene.step(NAN, std::span(&place, 1)).empty());
}

TEST(Hands, TheSquareIsTurnedAsTheHandIs) {
  MadeHand hand;
  for (float roll : {-1.f, 0.f, 0.6f}) {
    hand.roll = roll;
    const HandMarks marks = marks_of(hand);
    const Cut cut = hand_cut_of_marks(marks);
    // Upright fingers lie above the wrist in the square.
    EXPECT_NEAR(std::remainder(cut.angle + roll, 2 * pi), 0, 0.2f);
    for (vec3 point : marks.points)
      EXPECT_LT(glm::length(vec2(point) - cut.middle), 0.75f * cut.width);
  }
  // A forearm that points to image right turns the upper side there.
  const Cut cut = hand_cut_of_arm({100, 100}, {150, 100}, 30);
  EXPECT_GT(cut.middle.x, 150);
  EXPECT_NEAR(cut_to_picture(cut, {0.5f, 0}).x, cut.middle.x + cut.width / 2, 1e-3f);
}

TEST(Hands, FilesThatAreCutOffAreRefused) {
  namespace fs = std::filesystem;
  const fs::path weights = fs::path(WELLSPRING_WEIGHTS_FOLDER) / "human";
  if (!fs::exists(weights)) GTEST_SKIP() << weights << " is not here; ./wellspring installs it";
  const Folder folder;
  for (const char* name : {"handlandmark-lite.json", "handlandmark-lite.bin"})
    fs::copy_file(weights / name, folder.file(name));
  fs::resize_file(folder.file("handlandmark-lite.bin"), 100000);
  EXPECT_THROW(HandReader(folder.file("")), LoadError);
}

}  // namespace
}  // namespace wellspring::test
