// SPDX-License-Identifier: Apache-2.0
// Pictures at rest that the network reconstructs, driven by a clock of the test's own.
#include "show/draw/still_pass.h"

#include <gtest/gtest.h>

#include "frame/compare.h"
#include "frame/jpeg.h"
#include "show/answer/report.h"
#include "show/state/make_show.h"
#include "show/state/show.h"
#include "show/tick.h"
#include "unit/show/tiny_exhibit.h"
#include "wire/packet.h"

namespace wellspring {
namespace {

struct StillPassTest : testing::Test {
  Arrivals arrivals;
  std::vector<std::shared_ptr<Link>> links;
  std::vector<Packet> pictures;  // of the first visitor
  double now = 0;
  uint32_t seq = 0;
  std::unique_ptr<Show> show;

  bool begin(bool weights = true, int visitors = 1) {
    ShowSettings settings;
    settings.fps = 50;
    settings.technique = "gather";
    settings.still_technique = "path";
    if (weights) settings.weights = WELLSPRING_WEIGHTS_FOLDER;
    show = make_show(make_tiny_exhibit(), settings);
    for (int i = 0; i < visitors; i++) {
      links.push_back(std::make_shared<Link>(uint64_t(i + 1), LinkKind::visit, "test"));
      arrivals.put(links.back());
      links.back()->push_text_in(
          R"({"type":"hello","exhibit":"","width":96,"height":64,"lang":"en","role":"visitor"})");
    }
    return !weights || show->pass.denoiser != nullptr;
  }
  void turn(double yaw) {
    links[0]->push_text_in(R"({"type":"input","seq":)" + std::to_string(++seq) +
                           R"(,"move":[0,0,0],"look":[)" + std::to_string(yaw) + ",0]}");
  }
  void step() {
    tick(*show, arrivals, now += 0.02);
    for (Visitor& visitor : show->visitors) visitor.shown.encoder->task.wait();
    show->renderer.worker.wait();
    for (const auto& link : links) {
      Link::Out out;
      while (link->take_out(out)) {
        if (!out.picture) continue;
        if (link == links.front()) pictures.push_back(*out.packet);
        link->push_text_in(R"({"type":"ack","frame":)" +
                           std::to_string(read_packet(*out.packet)->header.frame) +
                           R"(,"decoded_ms":1,"shown":true})");
      }
    }
  }
  // Until the condition holds; false: it never did.
  template <class Condition>
  bool steps_until(const Condition& holds, int most = 2000) {
    for (int i = 0; i < most; i++) {
      if (holds()) return true;
      step();
    }
    return holds();
  }
  Visitor& visitor() { return show->visitors.front(); }
  // The last reconstruction, as it is.
  bool is_shown() { return !visitor().picture.unshown && visitor().picture.fade.from.rgb.empty(); }
  double error_of_last() {
    StillSettings settings;
    settings.spp = 256;
    settings.transport = show->settings.transport;
    Frame truth = render_still(*show->still_technique, *show->world, show->lights,
                               visitor().place.last_view, settings);
    Image8 wanted, shown = decode_jpeg(read_packet(pictures.back())->payload, "picture");
    tonemap(truth, Tonemap{show->exhibit.exposure}, wanted);
    double sum = 0;
    for (size_t i = 0; i < wanted.rgb.size(); i++)
      sum += std::abs(int(wanted.rgb[i]) - int(shown.rgb[i]));
    return sum / double(wanted.rgb.size());
  }
};

TEST_F(StillPassTest, WhoRestsIsShownAReconstructionAndThenTimeGoesToSamples) {
  if (!begin()) GTEST_SKIP() << show->pass.problem;
  ASSERT_TRUE(steps_until([&] { return show->totals.reconstructed >= 1; }));
  ASSERT_TRUE(steps_until([&] { return is_shown(); }));
  EXPECT_TRUE(visitor().picture.rest.reconstructed);
  EXPECT_LT(error_of_last(), 6);
  uint64_t drawn = show->totals.drawn, samples = show->totals.samples;
  ASSERT_TRUE(steps_until([&] { return show->totals.reconstructed >= 4; }));
  EXPECT_EQ(show->totals.drawn, drawn);
  EXPECT_GT(show->totals.samples, samples);
  EXPECT_GT(visitor().picture.rest.passed_samples, 0.5);
  ASSERT_TRUE(steps_until([&] { return visitor().picture.rest.samples > 60; }, 20000));
  ASSERT_TRUE(steps_until([&] { return visitor().picture.rest.passed_samples > 60; }, 20000));
  ASSERT_TRUE(steps_until([&] { return is_shown(); }));
  EXPECT_LT(error_of_last(), 4);
}

TEST_F(StillPassTest, OnePictureFadesIntoTheNext) {
  if (!begin()) GTEST_SKIP() << show->pass.problem;
  ASSERT_TRUE(steps_until([&] { return show->totals.reconstructed >= 1; }));
  ASSERT_FALSE(is_shown());
  pictures.clear();
  double began = now;
  ASSERT_TRUE(steps_until([&] { return is_shown(); }));
  EXPECT_GT(now - began, 0.3);
  EXPECT_LT(now - began, 1);
  EXPECT_GE(pictures.size(), 4u);
  EXPECT_LE(pictures.size(), 12u);
  for (size_t i = 0; i < pictures.size(); i++) {
    bool still = read_packet(pictures[i])->header.flags & packet_still;
    EXPECT_EQ(still, i + 1 == pictures.size());
  }
}

// Who moves on sees the newest at once.
TEST_F(StillPassTest, NobodyWaitsForAFade) {
  if (!begin()) GTEST_SKIP() << show->pass.problem;
  ASSERT_TRUE(steps_until([&] { return show->totals.reconstructed >= 1; }));
  turn(0.1);
  step();
  step();
  EXPECT_TRUE(visitor().picture.fade.from.rgb.empty());
}

TEST_F(StillPassTest, WhoMovesOnLeavesItBehind) {
  if (!begin()) GTEST_SKIP() << show->pass.problem;
  ASSERT_TRUE(steps_until([&] { return show->pass.visitor != nullptr; }));
  turn(0.4);
  step();
  step();
  EXPECT_EQ(show->pass.visitor, nullptr);
  EXPECT_EQ(show->totals.reconstructed, 0u);
  EXPECT_GE(show->totals.given_up, 1u);
  EXPECT_FALSE(visitor().picture.rest.reconstructed);
  ASSERT_TRUE(steps_until([&] { return show->totals.reconstructed >= 1; }));
  ASSERT_TRUE(steps_until([&] { return !visitor().picture.unshown; }));
  EXPECT_LT(error_of_last(), 6);  // of where the visitor is now
}

TEST_F(StillPassTest, WhoLeavesMeanwhileIsForgotten) {
  if (!begin(true, 2)) GTEST_SKIP() << show->pass.problem;
  ASSERT_TRUE(steps_until([&] { return show->pass.visitor == &show->visitors.front(); }));
  links[0]->mark_closed();
  for (int i = 0; i < 5; i++) step();
  EXPECT_EQ(show->visitors.size(), 1u);
  links.erase(links.begin());
  ASSERT_TRUE(steps_until([&] { return show->totals.reconstructed >= 1; }));
}

TEST_F(StillPassTest, EverybodyWhoRestsHasATurn) {
  if (!begin(true, 3)) GTEST_SKIP() << show->pass.problem;
  EXPECT_TRUE(steps_until([&] {
    return !show->visitors.empty() &&
           std::all_of(show->visitors.begin(), show->visitors.end(),
                       [](const Visitor& one) { return one.picture.rest.reconstructed; });
  }));
}

TEST_F(StillPassTest, WithoutWeightsPicturesAreDrawnAndItIsSaid) {
  begin(false);
  for (int i = 0; i < 200; i++) step();
  EXPECT_EQ(show->totals.reconstructed, 0u);
  EXPECT_GT(show->totals.drawn, 5u);
  EXPECT_FALSE(make_report(*show).denoiser_problem.empty());
}

}  // namespace
}  // namespace wellspring
