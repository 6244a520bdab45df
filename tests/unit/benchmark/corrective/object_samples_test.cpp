// SPDX-License-Identifier: Apache-2.0
// Which samples are let in, and when they grow too old.
#include "benchmark/corrective/object_samples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "unit/benchmark/corrective/stage.h"

namespace wellspring::test {
namespace {

using test::Stage;

constexpr float degree = pi / 180;

// An eye that looks at the origin from 100 m, `angle` round +Y from the Z axis.
View eye_at(float angle) { return view_of_balls(64, 64, angle, 100); }

// `count` samples at the origin. Seen from eye_at(0) their cosine is 1; if they are steady, it is 0
// from everywhere in the plane of the eyes, and never changes.
void add_at_origin(SampleStore& store, int count, bool steady, uint32_t age = 0, int level = 1,
                   uint32_t object = 1) {
  CorrectiveSample sample{object, level, vec3(0), steady ? vec3(0, 1, 0) : vec3(0, 0, 1), {}};
  std::vector<CorrectiveSample> samples(static_cast<size_t>(count), sample);
  ASSERT_EQ(add_samples(store, eye_at(0), age, samples), count);
}

int count_age(const SampleStore& store, uint32_t object, uint32_t age) {
  int sum = 0;
  for (const ObjectSamples& samples : store.objects)
    for (const LevelSamples& list : samples.levels)
      if (samples.object == object) sum += int(std::count(list.age.begin(), list.age.end(), age));
  return sum;
}

TEST(ObjectSamples, WhatIsNotFiniteOrBelongsNowhereIsRefused) {
  const float nan = NAN, infinite = std::numeric_limits<float>::infinity();
  CorrectiveSample good{1, 1, vec3(0), vec3(0, 0, 1), {}};
  std::vector<CorrectiveSample> bad(10, good);
  bad[0].position.x = nan, bad[1].position.y = infinite, bad[2].normal.z = nan;
  bad[3].normal = vec3(0);
  bad[4].object = 0, bad[5].level = 0, bad[6].level = 5;
  bad[7].position = vec3(0, 0, 101);     // behind the eye
  bad[8].position = eye_at(0).position;  // in it
  bad[9].normal = vec3(infinite, 0, 0);
  SampleStore store;
  EXPECT_EQ(add_samples(store, eye_at(0), 0, bad), 0);
  EXPECT_EQ(store.count(), 0);
  EXPECT_EQ(add_samples(store, eye_at(0), 0, {&good, 1}), 1);
  EXPECT_EQ(store.count(), 1);
}

TEST(ObjectSamples, DeltaGrowsWithRoughnessWithinThePapersRange) {
  EXPECT_FLOAT_EQ(delta_of(0), 0.05f);
  EXPECT_FLOAT_EQ(delta_of(1), 0.2f);
  EXPECT_FLOAT_EQ(delta_of(0.5f), 0.125f);
  EXPECT_FLOAT_EQ(delta_of(-3), 0.05f);
  EXPECT_FLOAT_EQ(delta_of(7), 0.2f);
  EXPECT_FLOAT_EQ(delta_of(NAN), 0.05f);
}

// The cosine falls from 1 to cos(angle).
TEST(ObjectSamples, SamplesDieAtTheAngleWhereTheCosineHasChangedByDelta) {
  for (float delta : {0.05f, 0.1f, 0.2f})
    for (float sign : {-1.0f, 1.0f}) {
      float limit = std::acos(1 - delta);
      SampleStore store;
      set_delta(store, 1, delta);
      add_at_origin(store, 20, false);
      AgeingStats stats = age_samples(store, eye_at(sign * (limit - 0.1f * degree)).position, 1);
      EXPECT_EQ(stats.checked, 20);
      EXPECT_EQ(stats.invalid, 0);
      EXPECT_EQ(store.count(), 20);
      stats = age_samples(store, eye_at(sign * (limit + 0.1f * degree)).position, 2);
      EXPECT_EQ(stats.invalid, 20);
      EXPECT_EQ(stats.dropped, 20);
      EXPECT_EQ(store.count(), 0);
    }
}

TEST(ObjectSamples, AnAgeDiesWhenMoreThanHalfOfItIsInvalid) {
  for (int invalid : {9, 10, 11}) {
    SampleStore store;
    add_at_origin(store, invalid, false);
    add_at_origin(store, 20 - invalid, true);
    add_at_origin(store, 3, true, 0, 4);  // another level of that age
    AgeingStats stats = age_samples(store, eye_at(60 * degree).position, 1);
    EXPECT_EQ(stats.checked, 20);
    EXPECT_EQ(stats.invalid, invalid);
    EXPECT_EQ(store.count(), invalid > 10 ? 0 : 23);
  }
}

TEST(ObjectSamples, OnlyThatAgeOfThatObjectDies) {
  SampleStore store;
  for (uint32_t object : {1u, 2u})
    for (uint32_t age : {3u, 4u}) {
      bool dies = object == 1 && age == 3;
      add_at_origin(store, 13, !dies, age, 2, object);
      add_at_origin(store, 40, true, age, 3, object);
    }
  EXPECT_EQ(age_samples(store, eye_at(1).position, 9).dropped, 53);
  EXPECT_EQ(count_age(store, 1, 3), 0);
  EXPECT_EQ(count_age(store, 1, 4), 53);
  EXPECT_EQ(count_age(store, 2, 3), 53);
  EXPECT_EQ(count_age(store, 2, 4), 53);
}

TEST(ObjectSamples, TheFirstLevelWithTenSamplesDecides) {
  SampleStore store;
  add_at_origin(store, 9, false, 0, 1);
  add_at_origin(store, 10, true, 0, 2);
  add_at_origin(store, 50, false, 0, 3);
  EXPECT_EQ(age_samples(store, eye_at(1).position, 1).checked, 10);
  EXPECT_EQ(store.count(), 69);
  add_at_origin(store, 1, false, 0, 1);
  EXPECT_EQ(age_samples(store, eye_at(1).position, 1).dropped, 70);
  // If no level has ten, all are asked.
  add_at_origin(store, 3, false, 0, 1);
  add_at_origin(store, 4, false, 0, 2);
  EXPECT_EQ(age_samples(store, eye_at(1).position, 1).checked, 7);
  EXPECT_EQ(store.count(), 0);
}

TEST(ObjectSamples, NothingGrowsOlderThanTheMaximum) {
  SampleStore store;
  add_at_origin(store, 20, true, 5);
  add_at_origin(store, 20, true, 6);
  AgeingSettings settings{.max_age = 10};
  age_samples(store, eye_at(0).position, 15, settings);
  EXPECT_EQ(store.count(), 40);
  age_samples(store, eye_at(0).position, 16, settings);
  EXPECT_EQ(count_age(store, 1, 5), 0);
  EXPECT_EQ(count_age(store, 1, 6), 20);
  // An age from the future is one of now.
  age_samples(store, eye_at(0).position, 2, settings);
  EXPECT_EQ(store.count(), 20);
}

// Against the paper's pseudo-code in double precision, round two balls.
TEST(ObjectSamples, AgesDieRoundABallAsComputedSampleBySample) {
  Stage stage = two_balls();
  for (int i = 0; i <= 12; i++) {
    SampleStore store;
    View before = view_of_balls(60, 60), now = view_of_balls(60, 60, 0.05f * float(i));
    std::vector<CorrectiveSample> samples = stage.trace_all(before, store.grid);
    for (uint32_t object : {1u, 2u}) set_delta(store, object, delta_of(0));
    add_samples(store, before, 0, samples);
    AgeingStats stats = age_samples(store, now.position, 1);
    int expected_invalid = 0, expected_dropped = 0;
    for (uint32_t object : {1u, 2u}) {
      int first = 1, count = 0, total = 0, invalid = 0;
      auto in_level = [&](const CorrectiveSample& s) {
        return s.object == object && s.level == first;
      };
      while ((count = int(std::count_if(samples.begin(), samples.end(), in_level))) < 10) first++;
      for (const CorrectiveSample& s : samples) {
        total += s.object == object;
        if (!in_level(s)) continue;
        dvec3 n(s.normal), then = normalize(dvec3(before.position) - dvec3(s.position));
        dvec3 here = normalize(dvec3(now.position) - dvec3(s.position));
        invalid += std::abs(dot(n, here) - dot(n, then)) > 0.05;
      }
      expected_invalid += invalid;
      expected_dropped += 2 * invalid > count ? total : 0;
    }
    EXPECT_EQ(stats.invalid, expected_invalid) << i;
    EXPECT_EQ(stats.dropped, expected_dropped) << i;
    EXPECT_EQ(store.count(), int(samples.size()) - expected_dropped);
    EXPECT_EQ(stats.invalid == 0, i == 0);
    EXPECT_TRUE(i < 12 || store.count() == 0);
  }
}

TEST(ObjectSamples, OverABoundTheOldestGoFirst) {
  SampleStore store{.limits = {160, 320}};
  for (uint32_t age : {1u, 2u, 3u}) add_at_origin(store, 60, true, age);
  EXPECT_LE(store.count(), 160);
  EXPECT_EQ(count_age(store, 1, 1), 30);  // a sixteenth more than it must
  EXPECT_EQ(count_age(store, 1, 2), 60);
  EXPECT_EQ(count_age(store, 1, 3), 60);
  add_at_origin(store, 160, true, 2, 1, 2);
  add_at_origin(store, 40, true, 4, 1, 3);
  EXPECT_EQ(store.count(), 300);
  EXPECT_EQ(count_age(store, 1, 1), 0);  // the oldest of all objects
  EXPECT_EQ(count_age(store, 1, 3), 60);
  EXPECT_EQ(count_age(store, 3, 4), 40);
}

TEST(ObjectSamples, OfOneAgeTheFinestGoFirst) {
  SampleStore store{.limits = {64, 1000}};
  add_at_origin(store, 40, true, 1, 4);
  add_at_origin(store, 30, true, 1, 2);
  EXPECT_EQ(store.objects[0].levels[1].count(), 30);
  EXPECT_EQ(store.objects[0].levels[3].count(), 30);
  store.limits.most_of_object = 0;
  add_at_origin(store, 1, true, 1, 2);
  EXPECT_EQ(store.count(), 0);
}

TEST(ObjectSamples, WithoutObjectsNothingIsDone) {
  SampleStore store;
  AgeingStats stats = age_samples(store, vec3(0), 1);
  EXPECT_EQ(stats.checked + stats.invalid + stats.dropped, 0);
  EXPECT_EQ(add_samples(store, eye_at(0), 1, {}), 0);
}

}  // namespace
}  // namespace wellspring::test
