// SPDX-License-Identifier: Apache-2.0
#include "kiosk/gesture/trajectory.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kiosk/gesture/writer.h"

namespace wellspring::test {
namespace {

HandPath straight(vec2 from, vec2 to, double seconds, double rate) {
  HandPath path;
  for (double time = 0; time <= seconds + 1e-9; time += 1 / rate)
    path.places.push_back({time, from + (to - from) * float(time / seconds)});
  return path;
}

TEST(Trajectory, codes_are_sectors_of_20_degrees_with_y_down) {
  for (int code = 0; code < orientation_codes; code++)
    for (float off : {-9.f, 0.f, 9.f}) {
      const float angle = (20.f * float(code) + off) * pi / 180;
      EXPECT_EQ(orientation_code({std::cos(angle), std::sin(angle)}), code) << off;
    }
  EXPECT_EQ(orientation_code({0.1f, 1}), 4);  // down
}

TEST(Trajectory, codes_do_not_depend_on_speed_or_rate) {
  for (double seconds : {0.4, 2.0})
    for (double rate : {15.0, 60.0}) {
      HandPath path = straight({0, 0.5f}, {0.9f, 0.5f}, seconds, rate);
      // One more place at the end: the middle one of three is coded.
      path.places.push_back({seconds + 0.1, vec2(0.9f, 0.5f)});
      const auto steps = code_path(path);
      EXPECT_NEAR(double(steps.size()), 0.9 / code_step, 1.01) << seconds << ' ' << rate;
      for (const CodedStep& step : steps) EXPECT_EQ(step.code, 0);
    }
}

TEST(Trajectory, a_trembling_hand_makes_no_steps) {
  OrientationCoder coder;
  std::vector<CodedStep> steps;
  Rng rng(4);
  for (int i = 0; i < 300; i++)
    coder.step({0.05 * i, 0.01f * vec2(normal(rng), normal(rng))}, steps);
  EXPECT_TRUE(steps.empty());
  EXPECT_GT(coder.resting(15), 14);
}

TEST(Trajectory, a_rest_parts_two_motions) {
  HandPath path = straight({0, 0}, {0.6f, 0}, 0.5, 20);
  for (int i = 1; i <= 20; i++) path.places.push_back({0.5 + 0.05 * i, vec2(0.6f, 0)});
  for (int i = 1; i <= 10; i++) path.places.push_back({1.5 + 0.05 * i, vec2(0.6f, 0.06f * i)});
  path.places.push_back({2.1, vec2(0.6f, 0.6f)});
  const auto motions = code_motions(path);
  ASSERT_EQ(motions.size(), 2u);
  EXPECT_EQ(motions[0][4].code, 0);
  EXPECT_NEAR(motions[1][4].code, 4.5, 0.5);
  EXPECT_GT(motions[1][0].begin, 1.3);
}

TEST(Trajectory, a_leap_begins_a_new_motion) {
  OrientationCoder coder;
  std::vector<CodedStep> steps;
  EXPECT_TRUE(coder.step({0, vec2(0)}, steps));
  EXPECT_FALSE(coder.step({0.05, vec2(0.1f, 0)}, steps));
  EXPECT_TRUE(coder.step({0.10, vec2(2, 0)}, steps));     // 38 shoulder widths a second
  EXPECT_TRUE(coder.step({0.80, vec2(2.1f, 0)}, steps));  // out of sight in between
}

TEST(Trajectory, places_that_are_no_numbers_or_too_far_are_passed_over) {
  OrientationCoder coder;
  std::vector<CodedStep> steps;
  coder.step({0, vec2(0)}, steps);
  for (vec2 bad : {vec2(NAN, 0), vec2(0, INFINITY), vec2(1e20f, 0), vec2(0, -5)})
    EXPECT_FALSE(coder.step({0.05, bad}, steps));
  EXPECT_FALSE(coder.step({INFINITY, vec2(0)}, steps));
  EXPECT_FALSE(coder.step({0.05, vec2(0.01f, 0)}, steps));  // goes on as if nothing had been
  EXPECT_TRUE(steps.empty());
}

TEST(Writer, the_same_seed_gives_the_same_movement) {
  for (WriterGroup group : {WriterGroup::training, WriterGroup::held_out}) {
    const auto one = write_set(group, 2, 1, 5), again = write_set(group, 2, 1, 5),
               other = write_set(group, 2, 1, 6);
    ASSERT_EQ(one.size(), again.size());
    for (size_t i = 0; i < one.size(); i++) {
      ASSERT_EQ(one[i].places.size(), again[i].places.size());
      for (size_t k = 0; k < one[i].places.size(); k++)
        EXPECT_EQ(one[i].places[k].place, again[i].places[k].place);
    }
    EXPECT_NE(one[1].places[3].place, other[1].places[3].place);
  }
}

TEST(Writer, held_out_writers_are_others) {
  for (uint64_t seed = 0; seed < 50; seed++)
    EXPECT_NE(make_writer(WriterGroup::training, seed).rotation,
              make_writer(WriterGroup::held_out, seed).rotation);
}

TEST(Writer, strokes_end_where_their_chords_lead) {
  const std::vector<Stroke> strokes{{vec2(0.5f, 0.2f), 1.2f, 0, 0.6, 0.3f},
                                    {vec2(-0.1f, 0.7f), -2.f, 0.5, 0.8, 0.25f}};
  const vec2 end = eval_strokes(strokes, 30);
  EXPECT_NEAR(end.x, 0.4f, 1e-3f);
  EXPECT_NEAR(end.y, 0.9f, 1e-3f);
  EXPECT_EQ(eval_strokes(strokes, -1), vec2(0));
  // A bend clockwise on the screen goes over the chord of a way to the right: up first.
  const std::vector<Stroke> arc{{vec2(1, 0), 1.5f, 0, 1, 0.3f}};
  EXPECT_LT(eval_strokes(arc, 0.4).y, -0.1f);
}

}  // namespace
}  // namespace wellspring::test
