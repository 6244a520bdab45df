// SPDX-License-Identifier: Apache-2.0
// Pictures at rest that the network reconstructs, driven by a clock of the test's own.
#include "show/draw/still_pass.h"

#include <gtest/gtest.h>

#include "show/draw/make_picture_job.h"
#include "show/draw/pace.h"
#include "show/draw/picture.h"
#include "show/http/report.h"
#include "show/state/renderer.h"
#include "show/state/visitor_picture.h"
#include "unit/show/show_stage.h"

namespace wellspring::test {
namespace {

struct StillPassTest : testing::Test, ShowStage {
  bool begin(bool weights = true, int visitors = 1) {
    ShowSettings settings = settings_for("gather", 50);
    if (weights) settings.weights = WELLSPRING_WEIGHTS_FOLDER;
    ShowStage::begin(make_tiny_exhibit(), settings);
    for (int i = 0; i < visitors; i++) browsers[join(96, 64)].acknowledges = true;
    return !weights || show->drawing->pass.denoiser != nullptr;
  }
  // The last reconstruction, as it is.
  bool is_shown() {
    return !visitor().picture->unshown && visitor().picture->fade.from.rgb.empty();
  }
  double error_of_last() {
    return mean_difference(truth(visitor().place.last_view, 256), last_image());
  }
};

TEST_F(StillPassTest, WhoRestsIsShownAReconstructionAndThenTimeGoesToSamples) {
  if (!begin()) GTEST_SKIP() << show->drawing->pass.problem;
  ASSERT_TRUE(step_until([&] { return show->totals.reconstructed >= 1; }));
  ASSERT_TRUE(step_until([&] { return is_shown(); }));
  EXPECT_TRUE(visitor().picture->rest.reconstructed);
  EXPECT_LT(error_of_last(), 9) << "coarse light, which few samples have corrected yet";
  uint64_t drawn = show->totals.drawn, samples = show->totals.samples;
  ASSERT_TRUE(step_until([&] { return show->totals.reconstructed >= 4; }));
  EXPECT_EQ(show->totals.drawn, drawn);
  EXPECT_GT(show->totals.samples, samples);
  EXPECT_GT(visitor().picture->rest.passed_samples, 0.5);
  ASSERT_TRUE(step_until([&] { return visitor().picture->rest.samples > 60; }, 20000));
  ASSERT_TRUE(step_until([&] { return visitor().picture->rest.passed_samples > 60; }, 20000));
  ASSERT_TRUE(step_until([&] { return is_shown(); }));
  EXPECT_LT(error_of_last(), 4);
}

TEST_F(StillPassTest, OnePictureFadesIntoTheNext) {
  if (!begin()) GTEST_SKIP() << show->drawing->pass.problem;
  ASSERT_TRUE(step_until([&] { return show->totals.reconstructed >= 1; }));
  ASSERT_FALSE(is_shown());
  browsers[0].pictures.clear();
  double began = now;
  ASSERT_TRUE(step_until([&] { return is_shown(); }));
  EXPECT_GT(now - began, 0.3);
  EXPECT_LT(now - began, 1);
  EXPECT_GE(pictures().size(), 4u);
  EXPECT_LE(pictures().size(), 12u);
  for (size_t i = 0; i < pictures().size(); i++) {
    bool still = header(i).flags & packet_still;
    EXPECT_EQ(still, i + 1 == pictures().size());
  }
}

// A visitor who moves on sees the newest picture at once.
TEST_F(StillPassTest, NobodyWaitsForAFade) {
  if (!begin()) GTEST_SKIP() << show->drawing->pass.problem;
  ASSERT_TRUE(step_until([&] { return show->totals.reconstructed >= 1; }));
  turn(0.1);
  step();
  step();
  EXPECT_TRUE(visitor().picture->fade.from.rgb.empty());
}

TEST_F(StillPassTest, SamplesOfAViewThatWasLeftMeanwhileAreNotThoseOfTheNext) {
  if (!begin()) GTEST_SKIP() << show->drawing->pass.problem;
  step();
  Visitor& one = visitor();
  ASSERT_TRUE(step_until([&] { return one.picture->rest.samples > 1; }));
  show->drawing->renderer.drawn = 0;  // the renderer's work is dropped
  show->drawing->renderer.given_up = false;
  for (bool leaves : {false, true}) {
    const RestState before = one.picture->rest;
    const PictureJob job = make_picture_job(*show, one, 1, PictureKind::samples);
    ASSERT_EQ(job.kind, PictureKind::samples);
    draw_all(job, one);
    show->time += 0.02;
    if (leaves) one.place.view.yaw += 0.5f;
    watch(*show, one);
    finish_picture(*show, job, one);
    EXPECT_EQ(one.picture->rest.samples > before.samples, !leaves);
    EXPECT_EQ(one.picture->rest.samples == 0, leaves);
    EXPECT_EQ(one.picture->rest.asked == 0, leaves);
  }
}

TEST_F(StillPassTest, WhoMovesOnLeavesItBehind) {
  if (!begin()) GTEST_SKIP() << show->drawing->pass.problem;
  ASSERT_TRUE(step_until([&] { return show->drawing->pass.visitor != 0; }));
  turn(0.4);
  step();
  step();
  EXPECT_EQ(show->drawing->pass.visitor, 0u);
  EXPECT_EQ(show->totals.reconstructed, 0u);
  EXPECT_GE(show->totals.given_up, 1u);
  EXPECT_FALSE(visitor().picture->rest.reconstructed);
  ASSERT_TRUE(step_until([&] { return show->totals.reconstructed >= 1; }));
  ASSERT_TRUE(step_until([&] { return is_shown(); }));
  EXPECT_LT(error_of_last(), 9);  // from where the visitor is now
}

TEST_F(StillPassTest, WhoLeavesMeanwhileIsForgotten) {
  if (!begin(true, 2)) GTEST_SKIP() << show->drawing->pass.problem;
  ASSERT_TRUE(step_until([&] { return show->drawing->pass.visitor == visitor().link->id; }));
  browsers[0].link->mark_closed();
  steps(5);
  EXPECT_EQ(show->visits.visitors.size(), 1u);
  browsers.erase(browsers.begin());
  ASSERT_TRUE(step_until([&] { return show->totals.reconstructed >= 1; }));
}

TEST_F(StillPassTest, EverybodyWhoRestsHasATurn) {
  if (!begin(true, 3)) GTEST_SKIP() << show->drawing->pass.problem;
  EXPECT_TRUE(step_until([&] {
    return !show->visits.visitors.empty() &&
           std::all_of(show->visits.visitors.begin(), show->visits.visitors.end(),
                       [](const Visitor& one) { return one.picture->rest.reconstructed; });
  }));
}

TEST_F(StillPassTest, WithoutWeightsPicturesAreDrawnAndItIsSaid) {
  begin(false);
  steps(200);
  EXPECT_EQ(show->totals.reconstructed, 0u);
  EXPECT_GT(show->totals.drawn, 5u);
  EXPECT_FALSE(make_report(*show).denoiser_problem.empty());
}

}  // namespace
}  // namespace wellspring::test
