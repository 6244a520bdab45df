// SPDX-License-Identifier: Apache-2.0
#include "show/lighting/day.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace wellspring::test {
namespace {

constexpr double frames = 60;  // a second

std::vector<float> brightness(const ChangingLight& light, double seconds) {
  std::vector<float> values;
  for (int i = 0; i < int(seconds * frames); i++)
    values.push_back(eval_light(light, i / frames).intensity.x);
  return values;
}

// Counts WCAG 2.2's general flashes, pairs of opposing changes of 10 % of the greatest or more: the
// most of them in any second.
int most_flashes(const std::vector<float>& values, float greatest) {
  std::vector<size_t> changes;              // frames at which a change becomes that large
  float low = values[0], high = values[0];  // since the last change
  int way = 0;
  for (size_t i = 0; i < values.size(); i++) {
    low = std::min(low, values[i]), high = std::max(high, values[i]);
    const bool rises = values[i] - low >= 0.1f * greatest,
               falls = high - values[i] >= 0.1f * greatest;
    if (way <= 0 && rises) changes.push_back(i), way = 1, high = values[i];
    else if (way >= 0 && falls) changes.push_back(i), way = -1, low = values[i];
  }
  size_t most = 0;
  for (size_t first = 0; first < changes.size(); first++) {
    size_t last = first;
    while (last < changes.size() && double(changes[last] - changes[first]) <= frames) last++;
    most = std::max(most, last - first);
  }
  return int(most / 2);
}

ChangingLight flame(const std::string& name, float depth, float hz) {
  return ChangingLight{.name = name, .flicker = {depth, hz}};
}

// The counter must see flashes where there are some.
TEST(ChangingLight, FlashesAreCounted) {
  std::vector<float> blinks;
  for (int i = 0; i < 600; i++) blinks.push_back(i / 5 % 2 ? 1.0f : 0.2f);  // 6 a second
  EXPECT_GE(most_flashes(blinks, 1), 5);
  EXPECT_LE(most_flashes(blinks, 1), 7);
  EXPECT_EQ(most_flashes(std::vector<float>(600, 1.0f), 1), 0);
}

TEST(ChangingLight, FlickersAboutItsOwnBrightnessWithinItsDepth) {
  for (float depth : {0.1f, 0.35f, 1.0f}) {
    const std::vector<float> values = brightness(flame("Fire", depth, 4), 600);
    double sum = 0, most = 0, step = 0;
    for (size_t i = 0; i < values.size(); i++) {
      sum += double(values[i]);
      most = std::max(most, std::abs(double(values[i]) - 1));
      if (i > 0) step = std::max(step, std::abs(double(values[i] - values[i - 1])));
    }
    // 2,400 knots, uniform over 2 depth: four standard errors of their mean.
    EXPECT_NEAR(sum / double(values.size()), 1, double(depth) * 4 / std::sqrt(3 * 2400));
    EXPECT_LE(most, double(depth) * 1.0001);
    EXPECT_GE(most, double(depth) * 0.9);
    // Smooth: of a knot's whole way, 2 depth, at most 1.5 times its share of the time.
    EXPECT_LE(step, 2 * double(depth) * 1.5 * 4 / frames * 1.01);
  }
}

TEST(ChangingLight, FlickersTheSameEachTimeAndOtherwiseThanItsNeighbour) {
  const std::vector<float> one = brightness(flame("Fire", 0.5f, 4), 10);
  EXPECT_EQ(one, brightness(flame("Fire", 0.5f, 4), 10));
  const std::vector<float> other = brightness(flame("Torch", 0.5f, 4), 10);
  size_t same = 0;
  for (size_t i = 0; i < one.size(); i++) same += std::abs(one[i] - other[i]) < 0.01f;
  EXPECT_LT(same, one.size() / 4);
  EXPECT_EQ(eval_flicker({0, 4}, 1, 3), 1);
}

TEST(ChangingLight, NeverFlashesMoreThanThreeTimesASecond) {
  for (const char* name : {"Fire", "Torch", "Candle"})
    EXPECT_LE(most_flashes(brightness(flame(name, 1, float(most_turns)), 900), 2), 3) << name;
  ChangingLight track;
  for (int i = 0; i <= 10; i++)
    track.track.push_back({i / most_turns, vec3(0), {0, 0, -1}, i % 2 ? 1.0f : 0.0f});
  EXPECT_LE(most_flashes(brightness(track, 20), 1), 3);
}

ChangingLight walk() {
  ChangingLight light;
  light.light.type = PunctualType::spot;
  light.track = {{0, {0, 1, 0}, {0, 0, -1}, 1},
                 {2, {2, 1, 0}, {1, 0, 0}, 0.5f},
                 {3, {2, 1, 4}, {0, 0, 1}, 2},
                 {6, {0, 1, 0}, {0, 0, -1}, 1}};
  light.track[2].direction = {0, 0, 1};
  return light;
}

TEST(ChangingLight, PassesThroughEveryKeyOfItsTrack) {
  const ChangingLight light = walk();
  for (const TrackKey& key : light.track)
    for (double round : {0.0, 6.0, 600.0}) {
      const TrackKey at = eval_track(light, key.time + round);
      EXPECT_LT(glm::length(at.position - key.position), 1e-4f) << key.time;
      EXPECT_LT(glm::length(at.direction - key.direction), 1e-4f) << key.time;
      EXPECT_NEAR(at.intensity, key.intensity, 1e-4f) << key.time;
    }
}

// No corners and no jumps, at the seam neither.
TEST(ChangingLight, MovesSmoothlyAndIsNeverBrighterThanItsKeys) {
  const ChangingLight light = walk();
  vec3 before = eval_track(light, 0).position, pace(0);
  for (int i = 1; i < 1400; i++) {
    const TrackKey at = eval_track(light, i * 0.01);
    const vec3 now = (at.position - before) * 100.0f;  // metres a second
    if (i > 1) EXPECT_LT(glm::length(now - pace), 0.6f) << i;
    EXPECT_NEAR(glm::length(at.direction), 1, 1e-5);
    EXPECT_LE(at.intensity, 2);
    EXPECT_GE(at.intensity, 0.5f);
    before = at.position, pace = now;
  }
}

TEST(ChangingLight, StaysAtTheEndOfATrackThatIsNoLoop) {
  ChangingLight light = walk();
  light.loop = false;
  light.track.back().position = {9, 9, 9};
  for (double time : {6.0, 7.0, 1e6}) EXPECT_EQ(eval_track(light, time).position, vec3(9)) << time;
  EXPECT_LT(glm::length(eval_track(light, 5.99).position - vec3(9)), 0.1f);
}

}  // namespace
}  // namespace wellspring::test
