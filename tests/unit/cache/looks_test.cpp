// SPDX-License-Identifier: Apache-2.0
// Looks: exact shape and reflectance where a few points cannot tell, lit by the points around.
#include "cache/looks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "unit/cache/visit.h"

namespace wellspring {
namespace {

constexpr int width = 160, height = 90;

// Without the lamp, whose edges no two looks can tell: it is many times as bright as white.
View stroll(int frame) {
  float s = float(frame) / 30;
  return look_at(vec3(-1 + s, 1.6f, 4 - 0.5f * s), vec3(-0.2f + 0.3f * s, 0.3f, -1), 50, width,
                 height);
}

// Root mean square difference, of all pixels or of those chosen.
double difference(const Frame& a, const Frame& b, const std::vector<bool>& of = {}) {
  double sum = 0, count = 0;
  for (size_t i = 0; i < a.color.size(); i++) {
    if (!of.empty() && !of[i]) continue;
    vec3 d = min(a.color[i], vec3(2)) - min(b.color[i], vec3(2));
    sum += double(dot(d, d)), count++;
  }
  return std::sqrt(sum / count);
}

std::vector<bool> edges_of(const Room& room, const View& view) {
  View fine = view;
  fine.width *= 4, fine.height *= 4;
  Frame frame = render_room(room, fine, 1);
  std::vector<bool> edge(size_t(view.width * view.height));
  for (size_t i = 0; i < frame.object.size(); i++) {
    size_t x = i % size_t(fine.width), y = i / size_t(fine.width);
    size_t first = y / 4 * 4 * size_t(fine.width) + x / 4 * 4;
    if (frame.object[i] != frame.object[first]) edge[y / 4 * size_t(view.width) + x / 4] = true;
  }
  return edge;
}

TEST(Looks, EdgesAreCloserToTheConvergedPictureInMotion) {
  // Without noise all error is shape, reflectance and place.
  Visit plain, looked;
  plain.room.noisy = looked.room.noisy = false;
  looked.most_looks = 2 * width * height / 4;
  for (int i = 0; i < 40; i++) plain.step(stroll(i), 400), looked.step(stroll(i), 400);
  View view = stroll(39);
  Frame truth = render_room(plain.room, view, 64);
  std::vector<bool> edges = edges_of(plain.room, view);
  EXPECT_LT(difference(looked.frame, truth, edges), 0.7 * difference(plain.frame, truth, edges));
  EXPECT_LT(difference(looked.frame, truth), 0.8 * difference(plain.frame, truth));
}

TEST(Looks, EveryPixelLookedAtShowsTheRightSurface) {
  Visit visit;
  visit.most_looks = looks_a_pixel * width * height;
  View view = stroll(0);
  for (int i = 0; i < 20; i++) visit.step(view = stroll(i), 400);
  ASSERT_EQ(visit.looks.size(), size_t(looks_a_pixel * width * height));
  for (int y = 0; y < height; y++)
    for (int x = 0; x < width; x++) {
      size_t at = size_t(y * width + x);
      bool right = false;
      for (size_t k = 0; k < looks_a_pixel; k++)
        right |= visit.frame.object[at] == visit.seen[at * looks_a_pixel + k].object;
      ASSERT_TRUE(right) << x << ", " << y;
    }
}

TEST(Looks, AreChosenByWhatTheyGainAndNeverTooMany) {
  PointImage image;
  resize_image(image, 64, 48);
  for (size_t i = 0; i < image.priority.size(); i++) image.priority[i] = uint8_t(i % 200);
  std::vector<uint32_t> pixels, other;
  for (size_t most : {0, 1, 17, 500, 3000}) {
    choose_looks(image, most, 7, pixels);
    EXPECT_LE(pixels.size(), most);
    EXPECT_TRUE(std::is_sorted(pixels.begin(), pixels.end()));
    int least = 255, left = 0;
    std::vector<bool> chosen(image.priority.size());
    for (uint32_t pixel : pixels) {
      EXPECT_GT(image.priority[pixel], 0);
      least = std::min<int>(least, image.priority[pixel]);
      chosen[pixel] = true;
    }
    for (size_t i = 0; i < chosen.size(); i++)
      if (!chosen[i]) left = std::max<int>(left, image.priority[i]);
    EXPECT_LE(left, least);
  }
  choose_looks(image, 17, 8, other);
  choose_looks(image, 17, 7, pixels);
  EXPECT_NE(pixels, other);  // of equals, each time others
  choose_looks(image, 64 * 48, 7, pixels);
  EXPECT_EQ(pixels.size(), size_t(64 * 48));
}

TEST(Looks, NothingKnownIsBlackAndFinite) {
  Visit visit;
  visit.most_looks = looks_a_pixel * width * height;
  visit.step(stroll(0), 0);
  for (size_t i = 0; i < visit.frame.color.size(); i++) {
    vec3 c = visit.frame.color[i];
    ASSERT_TRUE(is_finite(c) && c.x >= 0 && c.y >= 0 && c.z >= 0) << i;
    ASSERT_GT(visit.frame.depth[i], 0) << i;
  }
}

TEST(Looks, AnswersThatAreMissingOrTooManyDoNoHarm) {
  Visit visit;
  visit.step(stroll(0), 2000);
  visit.cache.survey(stroll(0), 1000, visit.frame, visit.looks);
  see_room(visit.room, visit.looks, visit.seen);
  visit.seen.resize(visit.seen.size() / 3);
  visit.cache.reconstruct(stroll(0), visit.seen, visit.frame);
  visit.cache.survey(stroll(0), 1000, visit.frame, visit.looks);
  visit.seen.assign(visit.looks.size() + 100, Seen{});  // nothing that makes sense
  visit.cache.reconstruct(stroll(0), visit.seen, visit.frame);
  for (vec3 c : visit.frame.color) ASSERT_TRUE(is_finite(c) && c.x >= 0 && c.y >= 0 && c.z >= 0);
}

TEST(Looks, AtRestThePicturesOwnMeanTakesOver) {
  Visit plain, looked;
  looked.most_looks = 2 * width * height / 4;
  for (int i = 0; i < 150; i++) plain.step(stroll(0), 4000), looked.step(stroll(0), 4000);
  Frame truth = render_room(plain.room, stroll(0), 64);
  EXPECT_LT(looked.looks.size(), size_t(looks_a_pixel * width * height / 50));
  EXPECT_LT(difference(looked.frame, truth), 1.05 * difference(plain.frame, truth));
}

}  // namespace
}  // namespace wellspring
