// SPDX-License-Identifier: Apache-2.0
// An arm that holds something: fetched, held, brought back; the other arm goes on.
#include <gtest/gtest.h>

#include "avatar/body/hold.h"
#include "avatar/mind/storyteller.h"
#include "unit/avatar/figures.h"

namespace wellspring::test {
namespace {

const GestureLibrary& library = default_gestures();
const GestureClip& clip() { return library.clips[size_t(find_gesture("hold_up"))]; }
HeldThing thing(int number, int side = 1) { return {number, "hold_up", side}; }

void run(HoldState& state, const HeldThing& wanted, float seconds) {
  for (float t = 0; t < seconds; t += 0.01f) tick_hold(state, library, wanted, 0.01f);
}

TEST(Hold, TheThingIsInTheHandFromTheStrokeUntilItIsBroughtBack) {
  HoldState state;
  float before = 0;
  for (int i = 0; i < 300; i++) {
    tick_hold(state, library, thing(4), 0.01f);
    const float share = eval_held_share(state, library);
    EXPECT_EQ(share > 0, state.time > clip().stroke) << state.time;
    EXPECT_LE(std::abs(share - before), 0.011f / hold_appears + 1e-4f) << "it does not pop up";
    before = share;
  }
  EXPECT_EQ(state.time, clip().hold);
  EXPECT_TRUE(is_held_up(state, library));
  EXPECT_EQ(eval_hold(state, library).weight, 1);
  const float down = clip().seconds - clip().hold;
  run(state, {}, 0.05f);
  EXPECT_FALSE(is_held_up(state, library));
  EXPECT_EQ(state.held.thing, 4) << "it is on its way back";
  run(state, {}, down - clip().stroke);
  EXPECT_EQ(eval_held_share(state, library), 0);
  run(state, {}, clip().stroke);
  EXPECT_EQ(state.held.thing, -1);
  EXPECT_EQ(eval_hold(state, library).weight, 0);
}

TEST(Hold, BrokenOffOnTheWayUpItGoesBackTheSameWay) {
  HoldState state;
  run(state, thing(0), 1);
  const float reached = state.time;
  EXPECT_LT(reached, clip().hold);
  tick_hold(state, library, {}, 0.01f);
  EXPECT_NEAR(state.time, reached - 0.01f, 1e-5f);
  EXPECT_EQ(eval_held_share(state, library), 1);
  EXPECT_FALSE(is_held_up(state, library)) << "its light goes out at once";
  run(state, thing(0), 0.2f);
  EXPECT_NEAR(state.time, reached + 0.19f, 0.02f) << "wanted after all";
  run(state, {}, 2);
  EXPECT_EQ(state.clip, -1);
}

TEST(Hold, OneThingIsBroughtBackBeforeAnotherIsFetched) {
  HoldState state;
  run(state, thing(0), 3);
  float least = 1;
  int first_of_next = -1;
  for (int i = 0; i < 500; i++) {
    tick_hold(state, library, thing(1, 0), 0.01f);
    if (state.held.thing == 0) least = std::min(least, eval_held_share(state, library));
    if (state.held.thing == 1 && first_of_next < 0) first_of_next = i;
  }
  EXPECT_EQ(least, 0);
  EXPECT_GT(first_of_next, 100);
  EXPECT_EQ(state.held.side, 0);
  EXPECT_TRUE(is_held_up(state, library));
}

TEST(Hold, WhatTheLibraryLacksHoldsNothing) {
  HoldState state;
  run(state, {0, "no such gesture", 1}, 1);
  EXPECT_EQ(state.clip, -1);
  run(state, {0, "nod", 1}, 1);  // has no moment to hold
  EXPECT_EQ(state.clip, -1);
  for (float dt : {0.0f, 1e6f})
    for (int i = 0; i < 4; i++) tick_hold(state, library, thing(0), dt);
  EXPECT_TRUE(is_held_up(state, library));
}

struct HoldStage {
  Character character = test::load_text(test::whole_figure());
  Storyteller storyteller{&character, mat4(1)};
  StorytellerState state;
  StorytellerInput input;
  StorytellerEvents events;
  Pose pose;
  void run(double seconds) {
    input.humanlike = false;
    input.dt = 1 / 50.0f;
    for (double t = 0; t < seconds; t += 0.02) {
      input.time += 0.02;
      tick_storyteller(state, storyteller, input, pose, events);
    }
  }
  vec3 place(const char* joint) const {
    return eval_joint_frame(character, pose, find_joint(character, joint)).center;
  }
};

TEST(Hold, TheGripIsInTheFistAndFollowsIt) {
  for (int side : {0, 1}) {
    HoldStage stage;
    stage.input.story.held = thing(0, side);
    stage.run(4);
    const char* wrist = side == 0 ? "l_radiocarpal" : "r_radiocarpal";
    auto grip = eval_grip(stage.state, stage.storyteller, stage.pose);
    ASSERT_TRUE(grip);
    EXPECT_LT(glm::length(vec3((*grip)[3]) - stage.place(wrist)), 0.15f);
    EXPECT_GT((*grip)[1].y, 0.9f) << "what is held stands upright";
    EXPECT_GT((*grip)[3].y, stage.place("skullbase").y - 0.45f) << "near the shoulder's height";
    EXPECT_EQ((*grip)[3].x > 0, side == 0) << "on that hand's side";
    const vec3 still((*grip)[3]), hand = stage.place(wrist);
    stage.input.guests = {{1, {1.5f, 1.6f, 0.2f}, vec3(0), true}};  // the storyteller turns there
    stage.run(4);
    grip = eval_grip(stage.state, stage.storyteller, stage.pose);
    const float moved = glm::length(stage.place(wrist) - hand);
    EXPECT_GT(moved, 0.05f);
    EXPECT_NEAR(glm::length(vec3((*grip)[3]) - still), moved, 0.1f);
    EXPECT_LT(glm::length(vec3((*grip)[3]) - stage.place(wrist)), 0.15f);
    stage.input.story.held = {};
    stage.run(4);
    EXPECT_FALSE(eval_grip(stage.state, stage.storyteller, stage.pose));
  }
}

TEST(Hold, GesturesOfOneHandAreMadeByTheFreeOne) {
  HoldStage stage;
  stage.input.story.held = thing(0);
  stage.run(4);
  const vec3 holding = stage.place("r_radiocarpal"), free = stage.place("l_radiocarpal");
  stage.input.story.gesture = "point_up";  // the right hand's
  stage.run(0.02);
  stage.input.story.gesture.clear();
  stage.run(0.9);
  EXPECT_LT(glm::length(stage.place("r_radiocarpal") - holding), 0.03f);
  EXPECT_GT(stage.place("l_radiocarpal").y, free.y + 0.2f);
  stage.input.story.gesture = "open_arms";  // both hands'
  stage.run(0.02);
  stage.input.story.gesture.clear();
  stage.run(0.9);
  EXPECT_LT(glm::length(stage.place("r_radiocarpal") - holding), 0.03f);
}

}  // namespace
}  // namespace wellspring::test
