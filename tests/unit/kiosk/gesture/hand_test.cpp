// SPDX-License-Identifier: Apache-2.0
#include "kiosk/gesture/hand.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/rng.h"
#include "kiosk/gesture/skin.h"

namespace wellspring::test {
namespace {

constexpr int width = 320, height = 240;
constexpr vec2 face(160, 70);
constexpr float side = 40;

// A noisy grey-green room with discs of skin: the face, and a hand where there is one.
struct Room {
  std::vector<uint8_t> bgr = std::vector<uint8_t>(size_t(width * height * 3));
  ColorView view() const { return {width, height, bgr.data()}; }
  void disc(vec2 center, float radius, const int (&color)[3], Rng& rng) {
    for (int y = 0; y < height; y++)
      for (int x = 0; x < width; x++)
        if (glm::length(vec2{float(x), float(y)} - center) < radius)
          for (size_t c = 0; c < 3; c++)
            bgr[size_t(3 * (y * width + x)) + c] =
                uint8_t(std::clamp(color[c] + int(rng.next() % 17) - 8, 0, 255));
  }
};
constexpr int skin_color[3] = {120, 150, 205};  // blue, green, red

Room draw(std::optional<vec2> hand, uint64_t seed) {
  Room room;
  Rng rng(seed);
  for (uint8_t& byte : room.bgr) byte = uint8_t(100 + rng.next() % 25);
  room.disc(face, 0.6f * side, skin_color, rng);
  if (hand) room.disc(*hand, 16, skin_color, rng);
  return room;
}

TEST(MeanShift, a_moving_disc_of_skin_is_followed_to_a_pixel) {
  constexpr float radius = 18;
  vec2 place(60, 150);
  ChromaPicture picture;
  make_chroma(draw(place, 1).view(), picture);
  const ChromaHistogram model = make_histogram(picture, place, 14);
  float sum = 0;
  for (float p : model) sum += p;
  EXPECT_NEAR(sum, 1, 1e-4f);
  EXPECT_NEAR(bhattacharyya(model, model), 1, 1e-4f);
  int iterations = 0;
  vec2 truth = place;
  for (uint64_t frame = 2; frame < 60; frame++) {
    truth += vec2(3, frame % 2 ? 1.5f : -1);
    make_chroma(draw(truth, frame).view(), picture);
    const Shifted now = mean_shift(picture, model, place, radius);
    EXPECT_LT(glm::length(now.center - truth), 1) << frame;
    EXPECT_GT(now.similarity, 0.8f);
    place = now.center;
    iterations += now.iterations;
  }
  EXPECT_LE(iterations / 58.0, 6);  // the paper: 2.3 a frame
}

TEST(MeanShift, without_any_pixel_of_its_color_it_stays) {
  ChromaPicture picture;
  make_chroma(draw({}, 1).view(), picture);
  ChromaHistogram model{};
  model[0] = 1;
  const Shifted now = mean_shift(picture, model, vec2(100, 200), 15);
  EXPECT_EQ(now.center, vec2(100, 200));
  EXPECT_EQ(now.similarity, 0);
}

TEST(Skin, is_learnt_from_the_face) {
  ChromaPicture picture;
  make_chroma(draw(vec2(60, 150), 1).view(), picture);
  SkinColor skin;
  EXPECT_FALSE(skin.has(160, 110, 150));  // nothing is known yet
  skin.learn(picture, face, side);
  int hand = 0, wall = 0;
  for (int i = -5; i <= 5; i++) {
    const size_t on_hand = size_t((150 + i) * width + 60),
                 on_wall = size_t((150 + i) * width + 250);
    hand += skin.has(picture.y[on_hand], picture.cb[on_hand], picture.cr[on_hand]);
    wall += skin.has(picture.y[on_wall], picture.cb[on_wall], picture.cr[on_wall]);
  }
  EXPECT_GE(hand, 10);
  EXPECT_EQ(wall, 0);
}

// Returns the place of the hand, which goes round below the face from frame `from` on.
vec2 orbit(int frame) {
  return vec2(80, 160) + 30.f * vec2(std::cos(0.2f * float(frame)), std::sin(0.2f * float(frame)));
}

TEST(Hand, is_found_when_it_moves_lost_and_found_again) {
  HandTracker tracker;
  int seen = 0, lost = 0, back = 0;
  for (int frame = 0; frame < 90; frame++) {
    const bool there = frame < 40 || frame >= 60;
    const Room room = draw(there ? std::optional(orbit(frame)) : std::nullopt, uint64_t(frame));
    const auto hand = tracker.step(room.view(), {face, side}, frame / 20.0);
    if (hand) {
      ASSERT_TRUE(there) << frame;
      EXPECT_LT(glm::length(hand->pixel - orbit(frame)), 4) << frame;
    }
    if (frame >= 5 && frame < 40) seen += hand.has_value();
    if (frame >= 40 && frame < 60) lost += !hand;
    if (frame >= 65) back += hand.has_value();
  }
  EXPECT_GE(seen, 33);
  EXPECT_EQ(lost, 20);
  EXPECT_GE(back, 23);
}

TEST(Hand, its_place_is_told_as_the_visitor_sees_it) {
  for (bool mirrored : {false, true}) {
    HandTracker tracker(mirrored);
    std::optional<HandSeen> hand;
    for (int frame = 0; frame < 20; frame++)
      hand = tracker.step(draw(orbit(frame), uint64_t(frame)).view(), {face, side}, frame / 20.0);
    ASSERT_TRUE(hand);
    const vec2 off = (orbit(19) - face) / (shoulder_width * side);
    EXPECT_NEAR(hand->place.x, mirrored ? off.x : -off.x, 0.05f);
    EXPECT_NEAR(hand->place.y, off.y, 0.05f);
  }
}

TEST(Hand, a_still_room_and_a_face_alone_hold_no_hand) {
  HandTracker tracker;
  for (int frame = 0; frame < 30; frame++)
    EXPECT_FALSE(tracker.step(draw({}, uint64_t(frame)).view(), {face, side}, frame / 20.0));
}

TEST(Hand, views_that_cannot_be_used_hold_no_hand) {
  HandTracker tracker;
  const Room room = draw(orbit(0), 1);
  EXPECT_FALSE(tracker.step({}, {face, side}, 0));
  EXPECT_FALSE(tracker.step(room.view(), {face, 0}, 0));
  EXPECT_FALSE(tracker.step(room.view(), {vec2(NAN, 3), side}, 0));
  EXPECT_FALSE(tracker.step(room.view(), {vec2(-1e6f, 1e6f), side}, 0));
}

}  // namespace
}  // namespace wellspring::test
