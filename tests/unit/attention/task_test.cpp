// SPDX-License-Identifier: Apache-2.0
// What the task makes of objects: nearness to the middle, size, and what somebody points at.
#include "attention/task.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <cmath>

#include "base/rng.h"
#include "unit/attention/saliency_at.h"

namespace wellspring::test {
namespace {

// A view's objects, and what is found in it.
struct View {
  int width, height;
  std::vector<uint32_t> object = std::vector<uint32_t>(size_t(width) * size_t(height));
  SaliencyMap saliency{};
  void put(uint32_t number, ivec2 low, ivec2 size) {
    for (int y = low.y; y < low.y + size.y; y++)
      for (int x = low.x; x < low.x + size.x; x++)
        object[size_t(y) * size_t(width) + size_t(x)] = number;
  }
  std::vector<SeenObject> seen(const std::vector<AttentionHint>& hints = {}) const {
    TaskWork work;
    std::vector<SeenObject> found;
    eval_objects(object, width, height, saliency, hints, work, found);
    return found;
  }
};

uint32_t most_important(const std::vector<SeenObject>& seen) {
  return std::max_element(
             seen.begin(), seen.end(),
             [](const SeenObject& a, const SeenObject& b) { return a.importance < b.importance; })
      ->object;
}

// Equal objects left, in the middle and right.
View three_objects() {
  View view{300, 100};
  view.put(7, {20, 40}, {20, 20});
  view.put(3, {140, 40}, {20, 20});
  view.put(9, {260, 40}, {20, 20});
  return view;
}

TEST(Task, MeasuresByHand) {
  View view{40, 30};
  view.put(4000000000u, {0, 0}, {4, 3});
  view.put(5, {10, 5}, {20, 20});
  view.put(5, {30, 24}, {1, 1});
  auto seen = view.seen();
  ASSERT_EQ(seen.size(), 2u);  // sorted, without 0
  EXPECT_EQ(seen[0].object, 5u);
  EXPECT_EQ(seen[0].pixels, 401);
  EXPECT_EQ(seen[0].low, ivec2(10, 5));
  EXPECT_EQ(seen[0].high, ivec2(30, 24));
  EXPECT_FLOAT_EQ(seen[0].coverage, 401.0f / 1200);
  EXPECT_FLOAT_EQ(seen[0].distance, 0.5f / 25);  // half the diagonal is 25
  EXPECT_EQ(seen[1].object, 4000000000u);
  EXPECT_FLOAT_EQ(seen[1].distance, std::hypot(18.0f, 13.5f) / 25);
  EXPECT_FLOAT_EQ(seen[1].coverage, 0.01f);
  EXPECT_FLOAT_EQ(seen[1].importance, 0.5f * (1 - 0.9f) + 0.5f * 0.1f);
  EXPECT_TRUE((View{40, 30}.seen().empty()));
  EXPECT_TRUE((View{0, 0}.seen().empty()));
}

TEST(Task, TheMiddleIsMoreImportantThanTheCorner) {
  View view{200, 150};
  view.put(1, {0, 0}, {20, 20});
  view.put(2, {90, 65}, {20, 20});
  view.put(3, {180, 130}, {20, 20});
  auto seen = view.seen();
  EXPECT_EQ(most_important(seen), 2u);
  EXPECT_NEAR(seen[0].importance, seen[2].importance, 1e-6f);
}

TEST(Task, TheLargerIsMoreImportant) {
  View view{200, 150};
  view.put(1, {20, 65}, {20, 20});
  view.put(2, {155, 60}, {30, 30});  // its middle is as far away
  auto seen = view.seen();
  EXPECT_FLOAT_EQ(seen[0].distance, seen[1].distance);
  EXPECT_GT(seen[1].importance, seen[0].importance);
}

TEST(Task, ImportanceStaysBetweenNoneAndOne) {
  View view{64, 64};
  view.put(1, {0, 0}, {64, 64});
  EXPECT_FLOAT_EQ(view.seen()[0].importance, 1);
  EXPECT_FLOAT_EQ(view.seen({{{3, 3}, 9, 1}, {{30, 3}, 9, 1}})[0].importance, 1);
  EXPECT_EQ(eval_importance(1, 0), 0);
}

TEST(Task, AHintMovesTheWinner) {
  View view = three_objects();
  EXPECT_EQ(most_important(view.seen()), 3u);
  EXPECT_EQ(most_important(view.seen({{{265, 45}, 10, 0.9f}})), 9u);       // on it
  EXPECT_EQ(most_important(view.seen({{{15, 45}, 40, 0.9f}})), 7u);        // beside it
  EXPECT_EQ(most_important(view.seen({{{15, 45}, 4, 0.9f}})), 3u);         // out of its reach
  EXPECT_EQ(most_important(view.seen({{{265, 45}, 10, 0}})), 3u);          // without weight
  EXPECT_EQ(most_important(view.seen({{{265.5f, 45.5f}, 0, 0.9f}})), 9u);  // a single pixel
}

TEST(Task, HintsByHand) {
  View view = three_objects();
  float none = view.seen()[1].importance;
  // Object 7 begins at x = 20: a place 5 pixels left of it is half way to a radius of 10.
  float half = view.seen({{{15, 50}, 10, 0.8f}})[1].importance;
  EXPECT_FLOAT_EQ(1 - half, (1 - none) * (1 - 0.8f * 0.5f));
  float both = view.seen({{{15, 50}, 10, 0.8f}, {{25, 50}, 10, 0.5f}})[1].importance;
  EXPECT_FLOAT_EQ(1 - both, (1 - none) * (1 - 0.8f * 0.5f) * (1 - 0.5f));
  EXPECT_FLOAT_EQ(view.seen({{{25, 50}, 10, 70}})[1].importance, 1);  // weights end at 1
}

TEST(Task, HintsThatAreNotFiniteCountNothing) {
  View view = three_objects();
  float none = view.seen()[1].importance;
  for (AttentionHint hint : {AttentionHint{{NAN, 50}, 10, 1},
                             {{25, INFINITY}, 10, 1},
                             {{25, 50}, NAN, 1},
                             {{25, 50}, 10, NAN},
                             {{25, 50}, 10, -1}})
    EXPECT_EQ(view.seen({hint})[1].importance, none);
}

TEST(Task, AnObjectIsAsSalientAsItsPixelsOnAverage) {
  View view{64, 32};
  // 0 on the left half, 1 on the right, a slope between the columns 1 and 2.
  view.saliency.map = {4, 2, {0, 0, 1, 1, 0, 0, 1, 1}};
  view.saliency.offset = vec2(-0.46875f);  // sizes halve evenly
  view.put(1, {0, 0}, {20, 32});
  view.put(2, {44, 0}, {20, 32});
  view.put(3, {20, 0}, {24, 32});
  auto seen = view.seen();
  EXPECT_EQ(seen[0].saliency, 0);
  EXPECT_EQ(seen[1].saliency, 1);
  EXPECT_NEAR(seen[2].saliency, 0.5f, 1e-4f);
  float sum = 0;
  for (int x = 0; x < 20; x++) sum += test::eval_saliency_at(view.saliency, vec2(float(x + 12), 3));
  view.object.assign(view.object.size(), 0);
  view.put(4, {12, 3}, {20, 1});
  EXPECT_NEAR(view.seen()[0].saliency, sum / 20, 1e-4f);
}

TEST(Task, TheSameForAnyNumberOfThreads) {
  View view{500, 333};
  for (size_t i = 0; i < view.object.size(); i++)
    view.object[i] = uint32_t(mix64(i / 7) % 900) * 77777u;
  Plane map{32, 21, {}};
  for (size_t i = 0; i < 32 * 21; i++) map.value.push_back(float(mix64(i) % 1000) / 1000);
  view.saliency.map = map;
  std::vector<AttentionHint> hints{{{100, 90}, 50, 0.7f}, {{300, 200}, 90, 0.2f}};
  auto all = view.seen(hints);
  oneapi::tbb::global_control one(oneapi::tbb::global_control::max_allowed_parallelism, 1);
  auto again = view.seen(hints);
  ASSERT_EQ(all.size(), 899u);
  for (size_t i = 0; i < all.size(); i++) {
    ASSERT_EQ(all[i].object, again[i].object);
    ASSERT_EQ(all[i].pixels, again[i].pixels);
    ASSERT_EQ(all[i].saliency, again[i].saliency);
    ASSERT_EQ(all[i].importance, again[i].importance);
  }
}

TEST(Task, NothingOfAnEarlierViewIsLeft) {
  TaskWork work;
  std::vector<SeenObject> found;
  View full = three_objects();
  eval_objects(full.object, 300, 100, {}, {}, work, found);
  View small{20, 10};
  small.put(5, {3, 3}, {2, 2});
  std::vector<AttentionHint> hints(3);
  eval_objects(small.object, 20, 10, {}, hints, work, found);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].pixels, 4);
  EXPECT_EQ(found[0].saliency, 0);  // there is no map
}

}  // namespace
}  // namespace wellspring::test
