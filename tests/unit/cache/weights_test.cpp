// SPDX-License-Identifier: Apache-2.0
// Weights of objects: where a visitor's samples go besides where they are needed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "cache/attention.h"
#include "cache/plan.h"
#include "cache/point_cache.h"
#include "cache/point_image.h"
#include "unit/cache/visit.h"

namespace wellspring::test {
namespace {

const View view = look_at(vec3(0, 1.2f, 3), vec3(0, 1, 0), 60, 160, 90);

// A visit of the room in which every pixel has been seen.
struct Weights : testing::Test {
  Visit visit;
  void SetUp() override { fill(visit); }
  static void fill(Visit& visit) {
    for (int i = 0; i < 3; i++) visit.step(view, 160 * 90);
  }
  static void plan(Visit& visit, int budget) {
    visit.begin(view);
    visit.cache.plan(view, budget, visit.tick++, visit.requests);
  }
  static uint32_t object_at(const Visit& visit, uint32_t pixel) {
    uint32_t point = visit.cache.image().point[pixel];
    return point == no_point ? 0 : visit.cache.points().color[point].object;
  }
  // Makes so many plans and counts each object's requests, which are not answered.
  std::map<uint32_t, double> requests(int plans, int budget) {
    std::map<uint32_t, double> found;
    for (int i = 0; i < plans; i++) {
      plan(visit, budget);
      for (const Request& r : visit.requests) found[object_at(visit, r.pixel)]++;
    }
    return found;
  }
  // Returns the object with the second most pixels: it has neighbours, and is not most of the
  // picture.
  uint32_t find_object() {
    std::map<uint32_t, int> pixels;
    for (uint32_t i = 0; i < 160 * 90; i++) pixels[object_at(visit, i)]++;
    pixels.erase(0);
    std::multimap<int, uint32_t> by_size;
    for (auto [object, count] : pixels) by_size.insert({count, object});
    return std::next(by_size.rbegin())->second;
  }
};

TEST_F(Weights, OfOneEverywhereChangeNoBit) {
  Visit other;
  fill(other);
  other.cache.set_weights(std::vector<float>(300, 1.0f));
  for (int i = 0; i < 3; i++) {
    visit.step(view, 900), other.step(view, 900);
    ASSERT_EQ(visit.requests.size(), other.requests.size());
    for (size_t k = 0; k < visit.requests.size(); k++) {
      EXPECT_EQ(visit.requests[k].pixel, other.requests[k].pixel);
      EXPECT_EQ(visit.requests[k].seed, other.requests[k].seed);
      EXPECT_EQ(visit.requests[k].resample, other.requests[k].resample);
    }
    EXPECT_EQ(visit.frame.color, other.frame.color);
  }
  EXPECT_TRUE(other.cache.image().weight.empty());
}

// The requests are a small part of the pixels, so that the odds change as the weight says.
TEST_F(Weights, ChangeTheShareOfSamplesAsComputed) {
  uint32_t object = find_object();
  auto odds = [&](float weight) {
    std::vector<float> weights(object + 1, 1.0f);
    weights[object] = weight;
    visit.cache.set_weights(weights);
    auto found = requests(60, 400);
    double all = 0;
    for (auto [number, count] : found) all += count;
    EXPECT_EQ(all, 60 * 400);
    return found[object] / (all - found[object]);
  };
  double even = odds(1);
  EXPECT_NEAR(odds(2) / even, 2, 0.2);
  EXPECT_NEAR(odds(4) / even, 4, 0.4);
  EXPECT_NEAR(odds(8) / even, 8, 1);
  EXPECT_NEAR(odds(0.25f) / even, 0.25, 0.05);
}

TEST_F(Weights, AreBoundedSoThatNobodyIsForgotten) {
  uint32_t object = find_object();
  auto weights_of = [&](float weight) {
    std::vector<float> weights(object + 1, 1.0f);
    weights[object] = weight;
    visit.cache.set_weights(weights);
    plan(visit, 400);
    const std::vector<uint8_t>& found = visit.cache.image().weight;
    if (found.empty()) return 1.0f;
    auto [least, most] = std::minmax_element(found.begin(), found.end());
    return float(weight < 1 ? *least : *most) / weight_one;
  };
  EXPECT_EQ(weights_of(0), RenderCache::least_weight);
  EXPECT_EQ(weights_of(-3), RenderCache::least_weight);
  EXPECT_EQ(weights_of(1e9f), RenderCache::most_weight);
  EXPECT_EQ(weights_of(NAN), 1);
  EXPECT_EQ(weights_of(INFINITY), 1);
  std::vector<float> least(300, 0.0f);
  visit.cache.set_weights(least);
  plan(visit, 400);
  EXPECT_EQ(visit.requests.size(), 400u);
}

TEST_F(Weights, CountNothingWhileAttentionIsOff) {
  visit.cache.set_weights(std::vector<float>(300, 4.0f));
  visit.cache.set_attention(false);
  plan(visit, 400);
  EXPECT_TRUE(visit.cache.image().weight.empty());
}

// Pictures whose sides are no multiples of a cell's, and pixels without a point.
TEST(WeightCells, CoverOddPicturesAndWhatIsEmpty) {
  PointCache points;
  resize_points(points, 64);
  PointImage image;
  resize_image(image, 7, 5);
  points.color[3].object = 9;
  image.point[4 * 7 + 6] = 3;
  std::vector<uint8_t> weights(10, uint8_t(weight_one));
  weights[9] = 4 * weight_one;
  for (uint32_t turn = 0; turn < 20; turn++) {
    weigh(points, weights, turn, image);
    EXPECT_EQ(image.weight, (std::vector<uint8_t>{16, 16, 16, 64}));
  }
  std::fill(image.priority.begin(), image.priority.end(), uint8_t(100));
  std::vector<Request> requests;
  plan_requests(points, look_at(vec3(0), vec3(0, 0, -1), 60, 7, 5), {35, 1, false}, image,
                requests);
  EXPECT_EQ(requests.size(), 35u);
}

}  // namespace
}  // namespace wellspring::test
