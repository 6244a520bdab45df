// SPDX-License-Identifier: Apache-2.0
#include "kiosk/station/glance.h"

#include <gtest/gtest.h>

#include "benchmark/kiosk/made_objects.h"

namespace wellspring::test {
namespace {

struct GlanceTest : testing::Test {
  Glance glance;
  double time = 0;
  cv::Mat room = make_room(3);
  void see(const cv::Mat& picture, double noise = 4) {
    glance.step(to_frame(picture, time, 0.7, noise, unsigned(time * 100)));
    time += 0.1;
  }
  void rest() {
    for (int i = 0; i < 5; i++) see(room);
    glance.note_vain();
  }
  cv::Mat with_card(float size, float x = 320) {
    cv::Mat picture = room.clone();
    Held held;
    held.size = size, held.x = x;
    put_face(picture, make_face(4), held);
    return picture;
  }
};

TEST_F(GlanceTest, everything_is_new_at_first) {
  see(room);
  EXPECT_TRUE(glance.changed());
}

TEST_F(GlanceTest, noise_and_other_light_are_nothing_new) {
  rest();
  for (int i = 0; i < 20; i++) {
    see(room, 6);
    EXPECT_FALSE(glance.changed());
    EXPECT_TRUE(glance.rests());
  }
  see(room + cv::Scalar::all(18));
  EXPECT_FALSE(glance.changed());
}

TEST_F(GlanceTest, a_card_is_new_until_it_was_looked_at) {
  for (const float size : {90.f, 200.f, 380.f}) {
    rest();
    see(with_card(size));
    EXPECT_TRUE(glance.changed()) << size;
    glance.note_vain();
    see(with_card(size));
    EXPECT_FALSE(glance.changed()) << size;
    rest();
  }
}

TEST_F(GlanceTest, what_moves_does_not_rest) {
  rest();
  for (float x = 200; x < 400; x += 40) {
    see(with_card(200, x)), see(with_card(200, x + 20));
    EXPECT_TRUE(glance.changed());
    EXPECT_FALSE(glance.rests());
  }
  for (int i = 0; i < 4; i++) see(with_card(200, 400));
  EXPECT_TRUE(glance.rests());
  EXPECT_TRUE(glance.changed());
}

TEST_F(GlanceTest, pictures_of_any_size_are_taken) {
  for (const int width : {640, 8, 320, 1}) {
    GrayFrame frame;
    frame.time = time += 1;
    frame.width = width, frame.height = std::max(1, width * 3 / 4);
    frame.pixels.assign(size_t(frame.width) * size_t(frame.height), 90);
    glance.step(frame);
    EXPECT_TRUE(glance.changed()) << "a picture of another size is new";
    glance.note_vain();
  }
}

}  // namespace
}  // namespace wellspring::test
