// SPDX-License-Identifier: Apache-2.0
// Recognition and spotting on persons that no model has seen. Seeds are fixed, so results are.
#include "kiosk/gesture/spot.h"

#include <gtest/gtest.h>

#include <cmath>

#include "judge/score.h"
#include "kiosk/gesture/train.h"
#include "kiosk/gesture/writer.h"

namespace wellspring::test {
namespace {

const GestureModels& models() {
  static const GestureModels trained = train_gestures(write_set(WriterGroup::training, 21, 2, 1));
  return trained;
}

// Returns models that are trained with the digits alone.
const GestureModels& digits() {
  static const GestureModels trained = [] {
    auto paths = write_set(WriterGroup::training, 21, 2, 1);
    std::erase_if(paths, [](const HandPath& path) { return path.label.size() > 1; });
    return train_gestures(paths);
  }();
  return trained;
}

SpotCounts spot_sequences(const GestureModels& known, size_t labels, int count) {
  SpotCounts counts;
  for (int i = 0; i < count; i++) {
    Rng rng(mix64(4000 + uint64_t(i)));
    std::vector<std::string> asked;
    for (int k = 1 + int(rng.next() % 3); k > 0; k--)
      asked.push_back(gesture_labels()[rng.next() % labels]);
    const HandWriter writer = make_writer(WriterGroup::held_out, 2000 + uint64_t(i % 14));
    const WrittenPath written = write_gestures(writer, asked, 9000 + uint64_t(i));
    counts += count_spotted(written.gestures, spot_path(known, {}, written.path));
  }
  return counts;
}

TEST(Spot, isolated_gestures_of_others_are_recognised) {
  int right = 0, tests = 0;
  for (const HandPath& path : write_set(WriterGroup::held_out, 9, 1, 2000)) {
    if (path.label.empty()) continue;
    tests++;
    right += recognise(models(), path) == path.label;
  }
  EXPECT_EQ(tests, 144);
  EXPECT_GE(recognition_ratio(right, tests), 0.97);
}

TEST(Spot, digits_are_found_in_continuous_motion) {
  const SpotCounts counts = spot_sequences(digits(), 10, 60);
  EXPECT_GT(counts.tests, 100);
  EXPECT_GE(reliability(counts), 0.9);
}

TEST(Spot, all_gestures_are_found_in_continuous_motion) {
  EXPECT_GE(reliability(spot_sequences(models(), 16, 60)), 0.65);  // swipes are hard to tell
}

TEST(Spot, other_motion_is_seldom_a_gesture) {
  int found = 0;
  for (uint64_t i = 0; i < 5; i++)
    found += int(
        spot_path(models(), {}, write_other(make_writer(WriterGroup::held_out, 2000 + i), 60, i))
            .size());
  EXPECT_LE(found, 8);  // in five minutes
}

TEST(Spot, a_digit_is_told_once_with_its_times) {
  const HandWriter writer = make_writer(WriterGroup::training, 3);
  const WrittenPath written = write_gestures(writer, {"8"}, 12);
  const auto found = spot_path(models(), {}, written.path);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].label, "8");
  EXPECT_NEAR(found[0].begin, written.gestures[0].begin, 0.35);
  EXPECT_NEAR(found[0].end, written.gestures[0].end, 0.6);
}

TEST(Spot, places_that_are_no_numbers_change_nothing) {
  const HandWriter writer = make_writer(WriterGroup::training, 3);
  const HandPath path = write_gestures(writer, {"8"}, 12).path;
  GestureSpotter spotter(models());
  int found = 0;
  const vec2 bad[3] = {{NAN, 0}, {1e30f, 0}, {0, -INFINITY}};
  for (size_t i = 0; i < path.places.size(); i++) {
    const auto [time, place] = path.places[i];
    found += spotter.step(time, place).has_value();
    found += spotter.step(time + 1e-3, bad[i % 3]).has_value();
    found += spotter.step(NAN, place).has_value();
    found += spotter.step(time - 5, place).has_value();  // time runs backwards
  }
  EXPECT_EQ(found, 1);
}

TEST(Spot, a_hand_that_leaves_ends_its_motion) {
  const HandWriter writer = make_writer(WriterGroup::training, 3);
  const WrittenPath written = write_gestures(writer, {"8"}, 12);
  GestureSpotter spotter(models());
  std::string told;
  for (const auto& [time, place] : written.path.places) {
    const bool seen = time < written.gestures[0].end;
    if (auto found = spotter.step(time, seen ? std::optional(place) : std::nullopt))
      told += found->label;
  }
  EXPECT_EQ(told, "8");
}

TEST(Spot, memory_stays_level_over_hours) {
  // After two hours a spotter answers like a new one.
  const HandWriter writer = make_writer(WriterGroup::training, 3);
  const HandPath minutes = write_other(writer, 600, 4);
  GestureSpotter old(models());
  double time = 0;
  size_t most = 0;
  for (int round = 0; round < 12; round++) {
    for (const HandPlace& seen : minutes.places) old.step(time + seen.time, seen.place);
    time += 601;
    if (round == 0) most = old.memory_bytes();
    EXPECT_LE(old.memory_bytes(), 2 * most) << round;
  }
  const WrittenPath written = write_gestures(writer, {"8"}, 12);
  int found = 0;
  for (const HandPlace& seen : written.path.places) {
    const auto told = old.step(time + seen.time, seen.place);
    found += told && told->label == "8";
  }
  EXPECT_EQ(found, 1);
}

TEST(Spot, a_vocabulary_of_one_gesture_works) {
  std::vector<HandPath> paths;
  for (uint64_t i = 0; i < 10; i++)
    paths.push_back(write_gesture(make_writer(WriterGroup::training, i), "3", i));
  const GestureModels one = train_gestures(paths);
  ASSERT_EQ(one.gestures.size(), 1u);
  EXPECT_EQ(recognise(one, paths[0]), "3");
}

TEST(Spot, nothing_to_learn_from_makes_no_models) {
  EXPECT_TRUE(train_gestures({}).gestures.empty());
  const std::vector<HandPath> still{{"3", "", {{0, vec2(0)}, {1, vec2(0)}, {2, vec2(0)}}}};
  EXPECT_TRUE(train_gestures(still).gestures.empty());
}

}  // namespace
}  // namespace wellspring::test
