// SPDX-License-Identifier: Apache-2.0
// The gesture library as data, and how clips pass over into each other.
#include <gtest/gtest.h>

#include <bit>
#include <limits>

#include "avatar/body/gesture.h"
#include "base/load_error.h"
#include "base/rng.h"

namespace wellspring::test {
namespace {

const std::array<ArmPose, 2> rest = {hanging_arm(0.15f), hanging_arm(0.15f)};

GestureRow row_of(const GestureMotion& motion) { return std::bit_cast<GestureRow>(motion); }

TEST(GestureLibrary, HasTheWordsOfBodyLanguage) {
  const GestureLibrary& library = default_gestures();
  EXPECT_GE(library.clips.size(), 25u);
  for (const char* name :
       {"greet",       "wave",         "point_near",  "point_far", "count_one",    "count_two",
        "count_three", "invite",       "think",       "bow",       "farewell",     "listen",
        "nod",         "shake_head",   "shrug",       "explain",   "large",        "small",
        "heart",       "wonder",       "hush",        "beckon",    "present_left", "present_right",
        "clap",        "hands_folded", "look_around", "laugh",     "sigh",         "open_arms",
        "emphasize",   "stop",         "hold_up"})
    EXPECT_GE(find_gesture(name), 0) << name;
  EXPECT_EQ(find_gesture("no such gesture"), -1);
  for (const GestureClip& clip : library.clips) {
    EXPECT_FALSE(clip.about.empty()) << clip.name;
    EXPECT_GE(clip.stroke, 0) << clip.name;
    EXPECT_LE(clip.stroke, clip.seconds) << clip.name;
  }
}

TEST(GestureLibrary, ClipsBeginAndEndAtRestAndStayWithinHumanLimits) {
  for (const GestureClip& clip : default_gestures().clips) {
    for (float t : {0.0f, clip.seconds}) {
      GestureMotion motion = eval_gesture(clip, t);
      EXPECT_EQ(motion.weight[0], 0) << clip.name;
      EXPECT_EQ(motion.weight[1], 0) << clip.name;
      EXPECT_LT(glm::length(motion.head) + glm::length(motion.chest), 1e-6f) << clip.name;
    }
    for (float t = 0; t < clip.seconds; t += 0.02f) {
      GestureMotion motion = eval_gesture(clip, t);
      for (const ArmPose& arm : motion.arm) {
        ArmPose limited = limit_arm(arm);
        EXPECT_TRUE((std::bit_cast<std::array<float, 13>>(limited) ==
                     std::bit_cast<std::array<float, 13>>(arm)))
            << clip.name << " at " << t << ": the data ask for more than an arm can";
      }
      EXPECT_LT(std::abs(motion.head.x), 45_deg) << clip.name;
      EXPECT_LT(std::abs(motion.head.y), 25_deg) << clip.name;
    }
  }
}

TEST(GestureLibrary, BadFilesAreRefusedWithTheirPlace) {
  struct Case {
    const char *text, *where;
  } cases[] = {
      {"", ""},
      {"[]", ""},
      {"{\"format\":\"other\",\"version\":1}", "/format"},
      {"{\"format\":\"wellspring-gestures\",\"version\":2}", "/version"},
      {"{\"format\":\"wellspring-gestures\",\"version\":1,\"gesture\":[]}", "/gesture"},
      {"{\"format\":\"wellspring-gestures\",\"version\":1,\"gestures\":{}}", "/gestures"},
      {"{\"format\":\"wellspring-gestures\",\"version\":1,\"gestures\":[{}]}", "/gestures/0/name"},
      {R"({"format":"wellspring-gestures","version":1,"gestures":[{"name":"a","keys":[{"time":0}]}]})",
       "/gestures/0/keys"},
      {R"({"format":"wellspring-gestures","version":1,"gestures":[{"name":"a","keys":[{"time":0},{"time":0}]}]})",
       "/gestures/0/keys/1/time"},
      {R"({"format":"wellspring-gestures","version":1,"gestures":[{"name":"a","keys":[{"time":0},{"time":1,"right":{"knee":3}}]}]})",
       "/gestures/0/keys/1/right/knee"},
      {R"({"format":"wellspring-gestures","version":1,"gestures":[{"name":"a","keys":[{"time":0},{"time":1,"head":{"nod":1e9}}]}]})",
       "/gestures/0/keys/1/head/nod"},
      {R"({"format":"wellspring-gestures","version":1,"gestures":[{"name":"a","keys":[{"time":0},{"time":1,"head":{"nod":5}}]}]})",
       "/gestures/0/keys"},
      {R"({"format":"wellspring-gestures","version":1,"gestures":[{"name":"a","mirror_of":"b"}]})",
       "/gestures/0/mirror_of"},
      {R"({"format":"wellspring-gestures","version":1,"gestures":[{"name":"a","keys":[{"time":0},{"time":1}],"swings":[{"channel":"right.weight","degrees":3}]}]})",
       "/gestures/0/swings/0/channel"},
  };
  for (const Case& bad : cases) try {
      read_gestures(bad.text, "bad.json");
      ADD_FAILURE() << "accepted: " << bad.text;
    } catch (const LoadError& error) {
      EXPECT_EQ(error.where, bad.where) << error.what();
      EXPECT_EQ(error.file, "bad.json");
    }
  EXPECT_THROW(read_gestures(std::string(100000, '['), "deep.json"), LoadError);
  EXPECT_THROW(load_gestures("/no/such/file.json"), LoadError);
}

// Largest change of speed between two ticks of 5 ms, over all channels; weights in their own unit.
float roughest(GestureState& state, const std::vector<std::pair<int, GestureOrder>>& orders,
               int ticks) {
  const float dt = 0.005f;
  GestureRow last{}, speed{};
  float worst = 0;
  for (int i = 0; i < ticks; i++) {
    GestureOrder order;
    for (const auto& [tick, given] : orders)
      if (tick == i) order = given;
    GestureRow row = row_of(tick_gesture(state, default_gestures(), order, rest, dt));
    if (i == 0) last = row;
    for (size_t c = 0; c < 26; c++) {  // the arms
      float now = (row[c] - last[c]) / dt;
      if (i > 1) worst = std::max(worst, std::abs(now - speed[c]));
      speed[c] = now;
    }
    last = row;
  }
  return worst;
}

TEST(Gesture, PassesOverIntoAnyOtherWithoutAJump) {
  const GestureLibrary& library = default_gestures();
  Rng rng(11);
  float worst_alone = 0;
  for (size_t a = 0; a < library.clips.size(); a++) {
    GestureState state;
    worst_alone = std::max(worst_alone, roughest(state, {{1, {.clip = int(a), .lead = -1}}}, 900));
  }
  for (int trial = 0; trial < 300; trial++) {
    int a = int(rng.next() % library.clips.size()), b = int(rng.next() % library.clips.size());
    int when = 20 + int(rng.next() % 400);
    GestureState state;
    float worst = roughest(
        state, {{1, {.clip = a, .lead = -1}}, {when, {.clip = b, .size = 0.7f, .lead = 0.4f}}},
        900);
    // A jump of one degree within a tick would be a change of speed of 3.5 rad/s.
    EXPECT_LT(worst, worst_alone + 0.6f) << library.clips[size_t(a)].name << " -> "
                                         << library.clips[size_t(b)].name << " at " << when;
  }
}

TEST(Gesture, DoesNotDependOnTheTickRate) {
  auto after = [](float dt) {
    GestureState state;
    GestureMotion motion;
    int ticks = int(std::lround(1.8f / dt)), second = int(std::lround(0.6f / dt));
    for (int i = 0; i < ticks; i++) {
      GestureOrder order;
      if (i == 0) order = {.clip = find_gesture("wave"), .lead = -1};
      if (i == second) order = {.clip = find_gesture("explain"), .lead = -1};
      motion = tick_gesture(state, default_gestures(), order, rest, dt);
    }
    return row_of(motion);
  };
  GestureRow at10 = after(0.1f), at30 = after(1 / 30.0f), at120 = after(1 / 120.0f);
  for (size_t c = 0; c < gesture_channels; c++) {
    EXPECT_NEAR(at10[c], at120[c], 2e-3f) << c;
    EXPECT_NEAR(at30[c], at120[c], 2e-3f) << c;
  }
}

TEST(Gesture, TheStrokeMeetsItsWord) {
  for (float lead : {0.0f, 0.3f, 1.0f, 3.0f}) {
    GestureState state;
    const GestureLibrary& library = default_gestures();
    int clip = find_gesture("count_two");
    tick_gesture(state, library, {.clip = clip, .lead = lead}, rest, 0);
    tick_gesture(state, library, {}, rest, lead);
    float stroke = library.clips[size_t(clip)].stroke;
    EXPECT_LE(std::abs(state.time - stroke), lead < 0.15f ? 0.151f : 1e-4f) << lead;
  }
}

TEST(Gesture, HoldsAsLongAsItIsAskedTo) {
  GestureState state;
  const GestureLibrary& library = default_gestures();
  int clip = find_gesture("point_far");
  tick_gesture(state, library, {.clip = clip, .lead = -1, .seconds = 20}, rest, 0);
  GestureMotion motion = tick_gesture(state, library, {}, rest, 17);
  EXPECT_EQ(motion.weight[1], 1);
  tick_gesture(state, library, {}, rest, 3.1f);
  EXPECT_EQ(state.clip, -1);
}

TEST(Gesture, MirroredItIsTheOtherHand) {
  const GestureLibrary& library = default_gestures();
  for (size_t i = 0; i < library.clips.size(); i++) {
    GestureState a, b;
    tick_gesture(a, library, {.clip = int(i), .lead = -1}, rest, 0);
    tick_gesture(b, library, {.clip = int(i), .lead = -1, .mirrored = true}, rest, 0);
    GestureMotion x = tick_gesture(a, library, {}, rest, 0.7f);
    GestureMotion y = tick_gesture(b, library, {}, rest, 0.7f);
    for (size_t s = 0; s < 2; s++)
      EXPECT_EQ((std::bit_cast<std::array<float, 13>>(x.arm[s])),
                (std::bit_cast<std::array<float, 13>>(y.arm[1 - s])));
    EXPECT_EQ(x.head.x, -y.head.x);
    EXPECT_EQ(x.head.y, y.head.y);
  }
}

TEST(Gesture, AnyOrderAndTimeStepIsSafe) {
  GestureState state;
  Rng rng(3);
  const float odd[] = {0, 1e-9f, 0.03f, 5, 1e6f, NAN, INFINITY, -1};
  for (int i = 0; i < 5000; i++) {
    GestureOrder order;
    auto any = [&] { return odd[rng.next() % 8]; };
    if (rng.uniform() < 0.3f)
      order = {int(rng.next() % 50) - 5, any(), any(), any(), rng.uniform() < 0.5f};
    float dt = odd[rng.next() % 5];
    GestureMotion motion = tick_gesture(state, default_gestures(), order, rest, dt);
    for (float v : row_of(motion)) ASSERT_TRUE(std::isfinite(v)) << i;
  }
}

}  // namespace
}  // namespace wellspring::test
