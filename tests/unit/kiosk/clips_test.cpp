// SPDX-License-Identifier: Apache-2.0
// Real recordings, where they are present: hits, false alarms and the track of a head.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

#include "kiosk/camera.h"
#include "kiosk/observe.h"

namespace wellspring::test {
namespace {

const std::filesystem::path faces = std::filesystem::path(WELLSPRING_DATA) / "5_faces";

std::vector<Observation> watch(const std::filesystem::path& file, double until) {
  CameraSettings settings{.source = file.string()};
  auto camera = make_camera(settings);
  Observer observer;
  std::vector<Observation> seen;
  GrayFrame frame;
  while (camera->next(frame) == Got::frame && frame.time < until)
    seen.push_back(observer.step(frame));
  return seen;
}

TEST(Clips, the_head_of_a_man_at_his_webcam_is_followed_without_a_gap) {
  const auto file = faces / "headtrackr" / "capture4.mp4";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not here";
  auto seen = watch(file, 5);
  ASSERT_EQ(seen.size(), 102u);  // 20.34 frames a second
  float left = 1e9f, right = -1e9f;
  const Person* last = nullptr;
  for (const Observation& o : seen) {
    if (o.time < 1) continue;
    ASSERT_EQ(o.state, Presence::person) << "at " << o.time;
    ASSERT_EQ(o.people.size(), 1u) << "at " << o.time;
    const Person& p = o.people[0];
    EXPECT_EQ(p.id, 1u);
    EXPECT_GT(p.position.z, 0.3f);
    EXPECT_LT(p.position.z, 0.9f);
    if (last) {
      EXPECT_LT(glm::length(p.position - last->position), 0.08f) << "at " << o.time;
    }
    last = &p;
    left = std::min(left, p.position.x), right = std::max(right, p.position.x);
    // At 3.93 s his head is at the image's right edge: on the left as he sees the screen.
    if (std::abs(o.time - 3.933) < 0.02) {
      EXPECT_LT(p.position.x, -0.1f);
    }
    if (std::abs(o.time - 2.0) < 0.03) {
      EXPECT_GT(p.position.x, 0.01f);
    }
  }
  EXPECT_GT(right - left, 0.15f);
}

TEST(Clips, cars_and_bottles_are_not_people) {
  const auto folder = faces / "intel_sample_videos";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not here";
  for (const char* name : {"car-detection.mp4", "bottle-detection.mp4"})
    for (const Observation& o : watch(folder / name, 12))
      EXPECT_NE(o.state, Presence::person) << name << " at " << o.time;
}

TEST(Clips, a_person_at_arms_length_is_confirmed_within_a_second_and_a_half) {
  const auto folder = faces / "intel_sample_videos";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not here";
  for (const char* name : {"preview/head-pose-face-detection-male.gif", "asl_gestures/again.mkv",
                           "asl_gestures/help.mkv"}) {
    auto seen = watch(folder / name, 1.5);
    ASSERT_FALSE(seen.empty());
    EXPECT_EQ(seen.back().state, Presence::person) << name;
  }
}

}  // namespace
}  // namespace wellspring::test
