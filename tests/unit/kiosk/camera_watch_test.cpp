// SPDX-License-Identifier: Apache-2.0
#include "kiosk/camera.h"

#include <gtest/gtest.h>

#include "base/rng.h"

namespace wellspring::test {
namespace {

struct Watched : testing::Test {
  CameraWatch watch;
  double time = 100;
  uint64_t frames = 0;
  // The state after so many seconds of noise around `level`.
  CameraState show(double seconds, int level, int noise, double rate = 30) {
    CameraState state = CameraState::good;
    for (int i = 0; i < int(seconds * rate); i++) {
      GrayFrame frame{.time = time += 1 / rate, .width = 64, .height = 48};
      frame.pixels.assign(64 * 48, uint8_t(level));
      Rng rng(++frames);
      if (noise > 0)
        for (uint8_t& pixel : frame.pixels) pixel = uint8_t(level + int(rng.uniform() * noise));
      state = watch.step(frame);
    }
    return state;
  }
};

TEST_F(Watched, AQuietRoomIsGood) { EXPECT_EQ(show(10, 90, 3), CameraState::good); }

TEST_F(Watched, ACoveredLensIsDarkAndComesBack) {
  show(2, 90, 3);
  EXPECT_EQ(show(2, 2, 6), CameraState::good) << "not at once: somebody stands before it";
  EXPECT_EQ(show(3, 2, 6), CameraState::dark);
  EXPECT_EQ(show(0.2, 90, 3), CameraState::good);
}

TEST_F(Watched, APictureWithoutNoiseIsFrozen) {
  show(2, 90, 3);
  EXPECT_EQ(show(2, 90, 0), CameraState::good);
  EXPECT_EQ(show(2, 90, 0), CameraState::frozen);
  EXPECT_EQ(show(0.2, 90, 3), CameraState::good);
}

TEST_F(Watched, FivePicturesASecondAreSlow) {
  EXPECT_EQ(show(4, 90, 3, 5), CameraState::good) << "not known yet";
  EXPECT_EQ(show(4, 90, 3, 5), CameraState::slow);
  EXPECT_EQ(show(8, 90, 3, 10), CameraState::good);
}

TEST_F(Watched, WithoutPicturesItIsMissing) {
  show(2, 90, 3);
  EXPECT_EQ(watch.step_blind(), CameraState::missing);
  time += 100;
  EXPECT_EQ(show(1, 90, 3), CameraState::good) << "the gap does not count";
  time = 0;  // a file begins again
  EXPECT_EQ(show(1, 90, 3), CameraState::good);
}

}  // namespace
}  // namespace wellspring::test
