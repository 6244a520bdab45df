// SPDX-License-Identifier: Apache-2.0
// A drawn head that turns, and prints of it that are moved by hand or hang on the wall.
#include "kiosk/face/liveness.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "kiosk/figure.h"

namespace wellspring::test {
namespace {

constexpr double rate = 10;
constexpr int width = 640, height = 480;

GrayFrame head(double yaw, double shift, int k) {
  FigurePose pose;
  pose.visible = true;
  pose.position = {float(shift), 0, 0.7f};
  pose.rotation = {float(yaw), 0, 0};
  return draw_figure({width, height, 1, 2.5f, uint64_t(k)}, {}, pose, k / rate);
}

// The picture of a head, turned by an angle about an upright axis and shifted by pixels, seen by a
// lens 900 pixels away, with a sensor's noise.
GrayFrame print_of(const GrayFrame& picture, double yaw, double shift, int k) {
  const cv::Mat from(height, width, CV_8U, const_cast<uint8_t*>(picture.pixels.data()));
  std::vector<cv::Point2f> at, to;
  for (const auto& [x, y] : {std::pair{-200., -180.}, {200., -180.}, {200., 180.}, {-200., 180.}}) {
    const double away = 900 + x * std::sin(yaw);
    at.emplace_back(float(320 + x), float(240 + y));
    to.emplace_back(float(320 + shift + 900 * x * std::cos(yaw) / away),
                    float(240 + 900 * y / away));
  }
  cv::Mat moved, noise(height, width, CV_16S);
  cv::warpPerspective(from, moved, cv::getPerspectiveTransform(at, to), from.size());
  cv::RNG random(uint64_t(k) + 1);
  random.fill(noise, cv::RNG::NORMAL, 0, 2.5);
  moved.convertTo(moved, CV_16S);
  moved += noise;
  moved.convertTo(moved, CV_8U);
  GrayFrame frame{k / rate, width, height, {}};
  frame.pixels.assign(moved.data, moved.data + moved.total());
  return frame;
}

// The face of head(0, shift, ..) in its picture, as the networks put it.
Box face_at(double shift_pixels = 0) { return {float(250 + shift_pixels), 185, 140, 140}; }

struct Watched {
  LivenessState state;
  bool counts = false;
};

Watched watch(int frames, const std::function<GrayFrame(int)>& picture,
              const std::function<Box(int)>& face) {
  LivenessWatch watch;
  Watched out;
  for (int k = 0; k < frames; k++) {
    out.state = watch.step(picture(k), 1, face(k));
    out.counts = watch.counts(out.state);
  }
  return out;
}

TEST(Liveness, AHeadThatTurnsLives) {
  const Watched seen = watch(
      12, [](int k) { return head(0.25 * std::sin(k / 3.), 0, k); }, [](int) { return face_at(); });
  EXPECT_TRUE(seen.counts);
  EXPECT_GT(liveness(seen.state), 0.9f);
}

TEST(Liveness, APrintThatIsTurnedByHandIsAPicture) {
  const GrayFrame picture = head(0, 0, 0);
  bool ever = false;
  LivenessWatch watch;
  LivenessState state;
  for (int k = 0; k < 40; k++) {
    state = watch.step(print_of(picture, 0.4 * std::sin(k / 5.), 30 * std::sin(k / 7.), k), 1,
                       face_at(30 * std::sin(k / 7.)));
    ever |= watch.counts(state);
  }
  EXPECT_FALSE(ever);
  EXPECT_LT(liveness(state), 0.1f);
}

TEST(Liveness, APictureOnTheWallNeverCounts) {
  const GrayFrame picture = head(0, 0, 0);
  const Watched seen = watch(
      60, [&](int k) { return print_of(picture, 0, 0, k); }, [](int) { return face_at(); });
  EXPECT_FALSE(seen.counts);
  EXPECT_FALSE(seen.state.stirred);
}

TEST(Liveness, FacesOfNoSizeOrOutsideOfTheFrameAreTaken) {
  const GrayFrame picture = head(0, 0, 0);
  constexpr float none = std::numeric_limits<float>::quiet_NaN();
  for (const Box& box : {Box{}, Box{none, 0, 50, 50}, Box{-900, 0, 100, 100}, Box{0, 0, 1e9f, 1e9f},
                         Box{600, 440, 100, 100}}) {
    LivenessWatch watch;
    for (int k = 0; k < 8; k++) {
      GrayFrame frame = picture;
      frame.time = k / rate;
      EXPECT_TRUE(std::isfinite(liveness(watch.step(frame, 1, box))));
    }
  }
}

LivenessState after(const std::vector<std::optional<FaceMotion>>& motions,
                    const LivenessSettings& settings = {}) {
  LivenessState state;
  step_liveness(state, settings, 0, FaceMotion::none);
  double time = 0;
  for (const auto& motion : motions) step_liveness(state, settings, time += 0.3, motion);
  return state;
}

TEST(LivenessState, OneLookThatIsSolidIsEnoughAndOneThatIsPlaneIsNot) {
  using enum FaceMotion;
  EXPECT_TRUE(counts_as_visitor(after({solid}), {}));
  EXPECT_FALSE(counts_as_visitor(after({plane}), {}));
  EXPECT_TRUE(counts_as_visitor(after({plane, solid, solid}), {}));
  EXPECT_FALSE(counts_as_visitor(after({plane, plane}), {}));
  EXPECT_FALSE(counts_as_visitor(after({solid, plane, plane, plane, plane}), {}));
}

TEST(LivenessState, WhoStirsUnclearlyOrCannotBeComparedCountsAfterAWait) {
  using enum FaceMotion;
  EXPECT_FALSE(counts_as_visitor(after({unclear}), {}));
  EXPECT_TRUE(counts_as_visitor(after({unclear, unclear, none, unclear, none}), {}));
  EXPECT_FALSE(counts_as_visitor(after({unclear, plane, none, none}), {}));
  EXPECT_TRUE(counts_as_visitor(after({unclear, plane, none, none, none, none}), {}));
  EXPECT_FALSE(counts_as_visitor(after({none, none, none, none, none}), {}));
  const std::vector<std::optional<FaceMotion>> dark(6, std::nullopt);
  EXPECT_TRUE(counts_as_visitor(after(dark), {}));
}

TEST(LivenessState, WhoDoesNotStirForLongIsAPicture) {
  using enum FaceMotion;
  std::vector<std::optional<FaceMotion>> motions(70, none);
  motions[0] = solid;
  EXPECT_FALSE(counts_as_visitor(after(motions), {}));
  motions.push_back(solid);
  EXPECT_TRUE(counts_as_visitor(after(motions), {}));
}

TEST(LivenessState, ATimeThatRunsBackwardsIsNoTime) {
  LivenessState state = after({FaceMotion::solid});
  step_liveness(state, {}, -1e6, FaceMotion::none);
  EXPECT_TRUE(counts_as_visitor(state, {}));
  step_liveness(state, {}, std::numeric_limits<double>::quiet_NaN(), FaceMotion::plane);
  EXPECT_TRUE(counts_as_visitor(state, {}));
}

}  // namespace
}  // namespace wellspring::test
