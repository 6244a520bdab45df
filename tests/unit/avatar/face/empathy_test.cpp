// SPDX-License-Identifier: Apache-2.0
// Perlin's face, the answer to a visitor's face, and how much of all this runs at which distance.
#include <gtest/gtest.h>

#include <cstring>

#include "avatar/mind/storyteller.h"
#include "unit/avatar/figures.h"

namespace wellspring::test {
namespace {

// Perlin's face after `seconds` with a target that changes at a third of them.
PerlinFace perlin_after(double seconds, double dt, float stir) {
  PerlinFace face;
  int ticks = int(std::lround(seconds / dt));
  for (int i = 0; i < ticks; i++) {
    for (size_t f = 0; f < flex_count; f++)
      set_target(face, Flex(f), i * 3 < ticks ? 0.5f : -0.3f * float(f));
    tick_perlin(face, stir, perlin_settle_seconds, 100 + (i + 1) * dt, float(dt));
  }
  return face;
}

TEST(PerlinFace, SettlesByItsRuleAtAnyTickRate) {
  // 95 % of the way after the settle time.
  PerlinFace face;
  set_target(face, Flex::smile, 2);
  for (int i = 0; i < 30; i++) tick_perlin(face, 0, 1, 0, 1 / 30.0f);
  EXPECT_NEAR(face.at(Flex::smile, 0).sum(), 1.9f, 1e-4f);
  tick_perlin(face, 0, 1, 0, 1);
  EXPECT_NEAR(face.at(Flex::smile, 1).sum(), 1.995f, 1e-4f);
  // With noise the integral's error is what remains: below 0.001 of a flex.
  PerlinFace at10 = perlin_after(6, 0.1, 1), at30 = perlin_after(6, 1 / 30.0, 1),
             at120 = perlin_after(6, 1 / 120.0, 1), at1000 = perlin_after(6, 0.001, 1);
  bool stirred = false;
  for (size_t f = 0; f < flex_count; f++)
    for (size_t side = 0; side < 2; side++) {
      float exact = at1000.flex[f][side].sum();
      for (const PerlinFace* other : {&at10, &at30, &at120})
        EXPECT_NEAR(other->flex[f][side].sum(), exact, 1e-3f) << flex_names[f];
      stirred = stirred || std::abs(at1000.flex[f][side].noise) > 0.05f;
    }
  EXPECT_TRUE(stirred);
}

TEST(PerlinFace, HugeStepsAreSafeAndForgetTheDistantPast) {
  PerlinFace face;
  set_target(face, Flex::brows, 0.4f);
  for (float dt : {0.0f, 1e-9f, 3600.0f, 1e6f, 0.01f}) {
    tick_perlin(face, 1, 1, 5e6, dt);
    for (auto& sides : face.flex)
      for (auto& value : sides) EXPECT_LT(std::abs(value.sum()), 5) << dt;
  }
  // A day in one step is the same as its last seconds.
  PerlinFace one, slow;
  tick_perlin(one, 1, 1, 86400, 86400);
  for (int i = 1; i <= 1500; i++) tick_perlin(slow, 1, 1, 86370 + i * 0.02, 0.02f);
  EXPECT_NEAR(one.at(Flex::brows, 0).noise, slow.at(Flex::brows, 0).noise, 1e-3f);
  set_target(face, Flex::brows, NAN);
  EXPECT_EQ(face.at(Flex::brows, 0).target, 0);
}

TEST(PerlinFace, WithoutNoiseNothingIsDrawnAndItComesToRest) {
  PerlinFace face;
  EXPECT_GT(tick_perlin(face, 1, 1, 5, 1), 0);
  for (int i = 0; i < 300; i++) EXPECT_EQ(tick_perlin(face, 0, 1, 6 + i * 0.05, 0.05f), 0);
  for (auto& sides : face.flex)
    for (auto& value : sides) EXPECT_EQ(value.noise, 0);
}

TEST(Empathy, AnswersByItsFormula) {
  Emotions joy;
  joy[Emotion::joy] = 1;
  Emotions goal = answer_to(joy);
  EXPECT_NEAR(goal[Emotion::joy], 0.9f, 1e-6f);
  // A critically damped step: 1 - (1 + x) e^-x.
  for (float dt : {0.01f, 1 / 30.0f, 0.25f}) {
    EmpathyState state;
    Emotions felt;
    int ticks = int(std::lround(1 / dt));
    for (int i = 0; i < ticks; i++) felt = tick_empathy(state, &joy, dt);
    float x = empathy_rate * dt * float(ticks);
    EXPECT_NEAR(felt[Emotion::joy], 0.9f * (1 - (1 + x) * std::exp(-x)), 1e-4f);
    for (int i = 0; i < 20; i++) felt = tick_empathy(state, nullptr, 1);
    EXPECT_NEAR(felt[Emotion::joy], 0, 1e-4f);
  }
}

TEST(Empathy, NeverGivesAngerOrDisgustBackAndIgnoresDoubt) {
  for (size_t i = 0; i < emotion_count; i++) {
    Emotions seen;
    seen.weight[i] = 1;
    Emotions answer = answer_to(seen);
    EXPECT_EQ(answer[Emotion::anger], 0);
    EXPECT_EQ(answer[Emotion::disgust], 0);
    seen.weight[i] = 0.2f;
    EXPECT_EQ(answer_to(seen), Emotions{});
    seen.weight[i] = NAN;
    EXPECT_EQ(answer_to(seen), Emotions{});
  }
}

TEST(Detail, WallsHaveTwoSides) {
  Detail detail = Detail::none;
  std::vector<Detail> seen;
  auto walk = [&](float from, float to) {
    float step = to > from ? 0.01f : -0.01f;
    for (float d = from; (to - d) * step > 0; d += step) {
      Detail next = next_detail(detail, d);
      if (next != detail) seen.push_back(next);
      detail = next;
    }
  };
  walk(12, 0.5f);
  EXPECT_EQ(seen, (std::vector<Detail>{Detail::medium, Detail::full}));
  seen.clear();
  walk(0.5f, 12);
  EXPECT_EQ(seen, (std::vector<Detail>{Detail::medium, Detail::none}));
  // Somebody who sways on a wall, by less than its thickness to either side.
  for (float wall : {3.0f, 8.0f}) {
    detail = next_detail(Detail::full, wall);
    int changes = 0;
    for (int i = 0; i < 1000; i++) {
      Detail next = next_detail(detail, wall + 0.24f * std::sin(float(i)));
      changes += next != detail;
      detail = next;
    }
    EXPECT_EQ(changes, 0) << wall;
  }
  EXPECT_EQ(next_detail(Detail::medium, NAN), Detail::medium);
  EXPECT_EQ(next_detail(Detail::full, INFINITY), Detail::none);
}

struct Stage {
  Character character = test::load_text(test::whole_figure());
  Storyteller storyteller{&character, mat4(1)};
  StorytellerState state;
  StorytellerInput input;
  StorytellerEvents events;
  Pose pose;
  void run(double seconds, float dt = 1 / 30.0f) {
    for (double t = 0; t < seconds; t += double(dt)) {
      input.dt = dt;
      tick_storyteller(state, storyteller, input, pose, events);
    }
  }
  float displacer(const char* name) const {
    return pose.displacers[size_t(find_displacer(character, name))];
  }
};

TEST(Detail, WhatIsNotNeededIsNotComputed) {
  auto work_at = [](float distance) {
    Stage stage;
    stage.input.viewer_distance = distance;
    stage.input.speaking = 1;
    stage.input.story.emotion = "joy";
    stage.input.story.emotion_weight = 1;
    stage.input.guests = {{1, {0, 1.6f, 1.2f}, vec3(0.4f, 0, 0), true, Emotions{}, ""}};
    stage.run(5);
    return stage.state.work;
  };
  StorytellerWork far = work_at(20), middle = work_at(5), near = work_at(1);
  EXPECT_EQ(far.ticks, near.ticks);
  StorytellerWork nothing{.ticks = far.ticks};
  EXPECT_EQ(far, nothing) << "far away the body alone moves";
  for (uint64_t StorytellerWork::*none :
       {&StorytellerWork::saccades, &StorytellerWork::flex_noise, &StorytellerWork::expressions,
        &StorytellerWork::mirror, &StorytellerWork::empathy})
    EXPECT_EQ(middle.*none, 0u);
  for (uint64_t StorytellerWork::*some :
       {&StorytellerWork::fingers, &StorytellerWork::eyes, &StorytellerWork::blinks,
        &StorytellerWork::visemes, &StorytellerWork::flexes, &StorytellerWork::body_noise}) {
    EXPECT_GT(middle.*some, 0u);
    EXPECT_GT(near.*some, 0u);
  }
  for (uint64_t StorytellerWork::*all :
       {&StorytellerWork::saccades, &StorytellerWork::flex_noise, &StorytellerWork::expressions,
        &StorytellerWork::mirror, &StorytellerWork::empathy})
    EXPECT_GT(near.*all, 0u);
}

TEST(Detail, AFaceIsThereInTheMiddleAndGoneFarAway) {
  for (auto [distance, least, most] : {std::tuple(1.0f, 0.4f, 1.0f), std::tuple(5.0f, 0.4f, 1.0f),
                                       std::tuple(20.0f, 0.0f, 0.0f)}) {
    Stage stage;
    stage.input.humanlike = false;
    stage.input.viewer_distance = distance;
    stage.input.story.emotion = "joy";
    stage.input.story.emotion_weight = 1;
    stage.run(4);
    EXPECT_GE(stage.displacer("smile_l"), least) << distance;
    EXPECT_LE(stage.displacer("smile_l"), most) << distance;
  }
}

TEST(Storyteller, TheVisitorsSmileIsAnsweredAndSadnessIsNotLaughedAt) {
  auto smile = [](const char* seen, const char* told) {
    Stage stage;
    stage.input.humanlike = false;
    Emotions face;
    if (*seen) face.weight[size_t(find_emotion(seen))] = 1;
    stage.input.guests = {{1, {0, 1.6f, 1.2f}, vec3(0), true, face, ""}};
    stage.input.story.emotion = told;
    stage.input.story.emotion_weight = *told ? 1.0f : 0.0f;
    stage.run(8);
    return stage.displacer("smile_l");
  };
  float plain = smile("", "");
  EXPECT_GT(smile("joy", ""), plain + 0.2f);
  EXPECT_LT(smile("sadness", ""), plain - 0.1f);
  EXPECT_EQ(smile("", "sadness"), 0) << "a sad story is told without the smile of the situation";
}

TEST(Storyteller, StoryEmotionsRepeatIdenticallyWithoutNoise) {
  auto play = [] {
    Stage stage;
    stage.input.humanlike = false;
    std::vector<float> all;
    for (int i = 0; i < 400; i++) {
      stage.input.telling = true;
      stage.input.story.emotion = i < 100 ? "fear" : i < 250 ? "joy" : "";
      stage.input.story.emotion_weight = 0.8f;
      stage.input.story.gesture = i == 30 ? "wonder" : i == 130 ? "explain" : "";
      stage.input.story.beat = i % 40 == 0 ? 1.0f : 0.0f;
      stage.run(1 / 30.0, 1 / 30.0f);
      all.insert(all.end(), stage.pose.displacers.begin(), stage.pose.displacers.end());
      for (quat q : stage.pose.rotations) all.insert(all.end(), {q.x, q.y, q.z, q.w});
    }
    return all;
  };
  std::vector<float> a = play(), b = play();
  ASSERT_EQ(a.size(), b.size());
  EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(float)), 0);
}

TEST(Storyteller, AFarewellOverridesTheStorysFace) {
  Stage stage;
  stage.input.humanlike = false;
  stage.input.telling = true;
  stage.input.story.emotion = "sadness";
  stage.input.story.emotion_weight = 1;
  stage.input.guests = {{1, {0, 1.6f, 1.2f}, vec3(0), true}};
  stage.run(8);
  EXPECT_EQ(stage.displacer("smile_l"), 0);
  stage.input.guests.clear();
  for (int i = 0; i < 60 * 5 && stage.state.mood != Mood::farewell; i++)
    stage.run(1 / 60.0, 1 / 60.0f);
  ASSERT_EQ(stage.state.mood, Mood::farewell);
  EXPECT_EQ(stage.state.gesture.clip, find_gesture("farewell"));
  stage.input.story.gesture = "shrug";
  stage.run(2);
  EXPECT_EQ(stage.state.gesture.clip, find_gesture("farewell")) << "nothing is combined with it";
  EXPECT_GT(stage.displacer("smile_l"), 0.3f);
}

TEST(Storyteller, WaitsPatientlyAndInvitesAFewTimes) {
  Stage stage;
  stage.input.humanlike = false;
  stage.input.guests = {{1, {0, 1.6f, 1.2f}, vec3(0), true}};
  int invite = find_gesture("invite"), invited = 0, before = -1;
  double first = -1;
  for (int i = 0; i < 300 * 30; i++) {
    stage.run(1 / 30.0, 1 / 30.0f);
    int now = stage.state.gesture.clip;
    if (now == invite && before != invite) {
      if (invited++ == 0) first = stage.state.clock;
    }
    before = now;
  }
  EXPECT_EQ(invited, most_invitations);
  EXPECT_NEAR(first, 0.25 + greeting_seconds + patience_seconds, 0.6);
  // A visitor who waves is waved at, once.
  Stage other;
  other.input.humanlike = false;
  other.input.guests = {{1, {0, 1.6f, 1.2f}, vec3(0), true, {}, ""}};
  other.run(5);
  other.input.guests[0].gesture = "wave";
  other.run(0.1);
  EXPECT_EQ(other.state.gesture.clip, find_gesture("wave"));
  other.run(4);
  EXPECT_EQ(other.state.gesture.clip, -1);
}

}  // namespace
}  // namespace wellspring::test
