// SPDX-License-Identifier: Apache-2.0
#include "kiosk/calibrate.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace wellspring::test {
namespace {

constexpr float degree = pi / 180;

// Returns where eyes at `place` seem to be if the camera is believed to sit as `believed`.
vec3 seem(const Mount& truth, const Mount& believed, vec3 place) {
  vec3 camera = screen_to_camera(truth, place);
  camera.z *= focal_length(believed, 640, 480) / focal_length(truth, 640, 480);
  return camera_to_screen(believed, camera);
}

TEST(Calibrate, FindsHowTheCameraSits) {
  for (float fov : {45.0f, 60.0f, 90.0f})
    for (float pitch : {-20.0f, 0.0f, 12.0f})
      for (float eyes : {-0.3f, 0.25f}) {
        Mount truth{.fov = fov * degree, .offset = {0.1f, 0.4f, 0.05f}, .pitch = pitch * degree};
        Mount solved = solve_mount({}, seem(truth, {}, {0, eyes, near_mark}),
                                   seem(truth, {}, {0, eyes, far_mark}), eyes);
        EXPECT_NEAR(solved.fov / degree, fov, 0.05f);
        EXPECT_NEAR(solved.pitch / degree, pitch, 0.05f);
        EXPECT_LT(glm::length(solved.offset - truth.offset), 2e-3f);
      }
}

TEST(Calibrate, KeepsTheHeightThatNobodyKnows) {
  Mount before;
  before.offset.y = 0.7f;
  Mount solved = solve_mount(before, {0, 0.2f, near_mark}, {0, 0.2f, far_mark});
  EXPECT_NEAR(solved.offset.y, 0.7f, 1e-5f);
}

TEST(Calibrate, RefusesWhatNoCameraCouldSee) {
  const float nan = std::nanf("");
  for (auto [near, far] : {std::pair(vec3(0, 0, 1), vec3(0, 0, 1)),
                           {vec3(0, 0, 2), vec3(0, 0, 1)},
                           {vec3(0, 0, 1), vec3(0.5f, 0, 2)},
                           {vec3(0, 0, 1), vec3(0, 3, 2)},
                           {vec3(0, nan, 1), vec3(0, 0, 2)}})
    EXPECT_THROW(solve_mount({}, near, far), std::runtime_error);
}

struct Standing : testing::Test {
  Calibration calibration;
  double time = 0;
  bool stand(vec3 place, double seconds, float tremble = 0, size_t people = 1) {
    bool done = false;
    for (double end = time + seconds; time < end; time += 0.1) {
      Observation seen{.time = time};
      seen.people.resize(people);
      for (Person& person : seen.people)
        person.position = place + vec3(tremble * float(std::sin(7 * time)), 0, 0);
      done = calibration.step(seen);
    }
    return done;
  }
};

TEST_F(Standing, EachMarkCountsOnceTheyStandStill) {
  EXPECT_NE(calibration.advice().find("1.0 m"), std::string::npos);
  EXPECT_FALSE(stand({0, 0, 1}, 1.5));
  EXPECT_FALSE(stand({0.3f, 0, 1.1f}, 1));  // moved
  EXPECT_NE(calibration.advice().find("1.0 m"), std::string::npos);
  EXPECT_EQ(calibration.now().metres, near_mark);
  const float before = calibration.now().progress;
  EXPECT_FALSE(stand({0.3f, 0, 1.1f}, 0.4));
  EXPECT_GT(calibration.now().progress, before);
  EXPECT_FALSE(stand({0.3f, 0, 1.1f}, 3, 0.01f));
  EXPECT_EQ(calibration.now().what, CalibrationStep::What::far_mark);
  EXPECT_EQ(calibration.now().metres, far_mark);
  EXPECT_NE(calibration.advice().find("2.0 m"), std::string::npos);
  EXPECT_FALSE(stand({0.3f, 0, 1.2f}, 5)) << "still at the first";
  EXPECT_FALSE(stand({0, 0, 2}, 5, 0.3f)) << "walks about";
  EXPECT_FALSE(stand({0, 0, 2}, 5, 0, 2)) << "who of them?";
  EXPECT_TRUE(stand({0, 0, 2}, 3, 0.01f));
  EXPECT_EQ(calibration.now(), (CalibrationStep{CalibrationStep::What::done, 0, 1}));
  EXPECT_NEAR(calibration.at_near().z, 1.1f, 0.02f);
  EXPECT_NEAR(calibration.at_far().z, 2, 0.02f);
}

}  // namespace
}  // namespace wellspring::test
