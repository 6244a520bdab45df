// SPDX-License-Identifier: Apache-2.0
// Attention to objects: the slider between picture and task, and who wins in which order.
#include "attention/task.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "base/rng.h"

namespace wellspring::test {
namespace {

std::vector<int> order_of(const std::vector<float>& attention, int shares) {
  AttentionOrder work;
  std::vector<int> order;
  plan_order(attention, shares, work, order);
  return order;
}

std::vector<SeenObject> two_objects() {
  std::vector<SeenObject> seen(2);
  seen[0].saliency = 0.8f, seen[0].importance = 0.1f, seen[0].pixels = 100;
  seen[1].saliency = 0.2f, seen[1].importance = 0.9f, seen[1].pixels = 300;
  return seen;
}

TEST(Attended, TheSliderGoesFromPictureToTask) {
  std::vector<float> attention;
  eval_attention(two_objects(), 0, attention);
  EXPECT_EQ(attention, (std::vector<float>{0.8f, 0.2f}));
  eval_attention(two_objects(), 1, attention);
  EXPECT_EQ(attention, (std::vector<float>{0.1f, 0.9f}));
  eval_attention(two_objects(), 0.25f, attention);
  EXPECT_FLOAT_EQ(attention[0], 0.75f * 0.8f + 0.25f * 0.1f);
  EXPECT_FLOAT_EQ(attention[1], 0.75f * 0.2f + 0.25f * 0.9f);
  eval_attention(two_objects(), 7, attention);  // ends are ends
  EXPECT_EQ(attention, (std::vector<float>{0.1f, 0.9f}));
  eval_attention({}, 0.5f, attention);
  EXPECT_TRUE(attention.empty());
}

// a: 1 .9 .81 .729 .6561 .590 .531 .478   b: .95 .855 .770 .693 .623 .561 .505 .454   c: .5 .45
TEST(Attended, TheOrderByHand) {
  EXPECT_EQ(order_of({1, 0.95f, 0.5f}, 17),
            (std::vector<int>{0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 2, 0, 1}));
}

TEST(Attended, TheOrderIsThatOfAttentionMultiplied) {
  std::vector<float> attention;
  for (uint64_t i = 0; i < 40; i++) attention.push_back(0.2f + float(mix64(i) % 997) / 1000);
  std::vector<int> order = order_of(attention, 600);
  std::vector<double> left(attention.begin(), attention.end());
  for (int winner : order) {
    auto best = std::max_element(left.begin(), left.end());
    ASSERT_NEAR(left[size_t(winner)], *best, 1e-9 * *best);
    left[size_t(winner)] *= 0.9;
  }
}

TEST(Attended, EverybodyWinsBeforeAnybodyWinsTwentyTimes) {
  std::vector<float> attention;
  for (uint64_t i = 0; i < 700; i++) attention.push_back(i < 5 ? 0 : float(mix64(i) % 1000) / 999);
  attention[300] = 1;
  std::vector<int> wins(attention.size());
  int waiting = int(wins.size()), most = 0;
  for (int winner : order_of(attention, 20 * 700)) {
    if (wins[size_t(winner)]++ == 0) waiting--;
    most = std::max(most, wins[size_t(winner)]);
    ASSERT_TRUE(waiting == 0 || most < 20);
  }
  EXPECT_EQ(waiting, 0);
}

// Multiplied by 0.9 that often, attention would be 0 and the first object would always win.
TEST(Attended, ALongOrderStaysFair) {
  std::vector<int> wins(3);
  for (int winner : order_of({1, 0.6f, 0.3f}, 60000)) wins[size_t(winner)]++;
  for (int count : wins) EXPECT_NEAR(count, 20000, 20);
}

TEST(Attended, NoAttentionMeansTurns) {
  EXPECT_EQ(order_of({0, 0, 0}, 7), (std::vector<int>{0, 1, 2, 0, 1, 2, 0}));
  EXPECT_EQ(order_of({NAN, 0.4f, -INFINITY}, 2), (std::vector<int>{1, 1}));
  EXPECT_EQ(order_of({0.3f}, 3), (std::vector<int>{0, 0, 0}));
  EXPECT_TRUE(order_of({}, 5).empty());
  AttentionOrder none;
  EXPECT_EQ(none.next(), -1);
}

TEST(Attended, SamplesAPixelAreInProportionToAttention) {
  std::vector<SampleShare> shares;
  std::vector<float> attention{0.8f, 0.2f};
  eval_sample_shares(two_objects(), attention, shares);
  // 100 pixels of 0.8 and 300 of 0.2: 80 against 60 parts.
  EXPECT_FLOAT_EQ(shares[0].share, 80 / 140.0f);
  EXPECT_FLOAT_EQ(shares[1].share, 60 / 140.0f);
  EXPECT_FLOAT_EQ(shares[0].factor, (80 / 140.0f) / (100 / 400.0f));
  EXPECT_FLOAT_EQ(shares[1].factor, (60 / 140.0f) / (300 / 400.0f));
}

TEST(Attended, NobodyIsLeftWithoutSamples) {
  std::vector<SampleShare> shares;
  std::vector<float> attention{0, 1};
  eval_sample_shares(two_objects(), attention, shares);
  EXPECT_FLOAT_EQ(shares[0].factor / shares[1].factor, least_attention);
  attention = {0, 0};
  eval_sample_shares(two_objects(), attention, shares);
  EXPECT_FLOAT_EQ(shares[0].factor, 1);
  EXPECT_FLOAT_EQ(shares[1].share, 0.75f);
  eval_sample_shares({}, {}, shares);
  EXPECT_TRUE(shares.empty());
}

TEST(Attended, WeightsAreSharperThanShares) {
  std::vector<float> attention{0.8f, 0.4f}, weights;
  std::vector<SeenObject> seen = two_objects();
  seen[0].object = 4, seen[1].object = 2;
  eval_weights(seen, attention, weights);
  // 100 pixels of 1 and 300 of an eighth, but for the least attention.
  float less = std::max(1 / 8.0f, least_attention), mean = (100 + 300 * less) / 400;
  ASSERT_EQ(weights.size(), 5u);
  EXPECT_FLOAT_EQ(weights[4], 1 / (mean * mean));
  EXPECT_FLOAT_EQ(weights[2], less * less / (mean * mean));
  EXPECT_EQ(weights[3], 1);  // not seen
  eval_weights(seen, std::vector<float>{0, 0}, weights);
  EXPECT_EQ(weights, (std::vector<float>{1, 1, 1, 1, 1}));
  eval_weights({}, {}, weights);
  EXPECT_TRUE(weights.empty());
}

}  // namespace
}  // namespace wellspring::test
