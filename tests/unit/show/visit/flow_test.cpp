// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "show/visit/flow.h"

namespace wellspring {
namespace {

TEST(Flow, WithoutAcknowledgementsTheSocketAlonePaces) {
  Flow flow;
  for (uint32_t i = 1; i < 1000; i++) {
    EXPECT_TRUE(may_send(flow, i * 0.01));
    note_sent(flow, i, i * 0.01);
  }
  EXPECT_LE(flow.in_flight.size(), 64u);
  EXPECT_EQ(suggest_quality(flow, 80), 80);
}

TEST(Flow, WindowClosesAndOpensWithAcknowledgements) {
  Flow flow;
  note_sent(flow, 1, 0);
  note_ack(flow, 1, 2, 0.01);
  uint32_t frame = 1;
  while (may_send(flow, 0.02) && frame < 100) note_sent(flow, ++frame, 0.02);
  EXPECT_EQ(frame, 5u);  // four in flight
  EXPECT_FALSE(may_send(flow, 0.5));
  note_ack(flow, 3, 2, 0.6);  // answers for 2 as well
  EXPECT_TRUE(may_send(flow, 0.6));
  EXPECT_EQ(flow.in_flight.size(), 2u);
}

TEST(Flow, SilenceIsFollowedByATrickleNotByAStandstill) {
  Flow flow;
  note_sent(flow, 1, 0);
  note_ack(flow, 1, 2, 0.01);
  for (uint32_t i = 2; i <= 5; i++) note_sent(flow, i, 0.02);
  EXPECT_FALSE(may_send(flow, 1));
  EXPECT_TRUE(may_send(flow, 2.1));
  note_sent(flow, 6, 2.1);
  EXPECT_FALSE(may_send(flow, 2.2));
}

TEST(Flow, QualityFallsWithLagAndRecovers) {
  Flow flow;
  double now = 0;
  uint32_t frame = 0;
  auto trip = [&](double seconds) {
    note_sent(flow, ++frame, now);
    note_ack(flow, frame, 1, now + seconds);
    now += 0.03;
  };
  for (int i = 0; i < 50; i++) trip(0.005);
  EXPECT_EQ(suggest_quality(flow, 82), 82);
  for (int i = 0; i < 60; i++) trip(0.08);
  EXPECT_LT(suggest_quality(flow, 82), 50);
  EXPECT_GE(suggest_quality(flow, 82), 30);
  for (int i = 0; i < 80; i++) trip(0.005);
  EXPECT_EQ(suggest_quality(flow, 82), 82);
}

TEST(Flow, FrameNumbersMayWrap) {
  Flow flow;
  note_sent(flow, 0xffffffffu, 0);
  note_sent(flow, 0, 0.01);
  note_ack(flow, 0, 1, 0.02);
  EXPECT_TRUE(flow.in_flight.empty());
}

TEST(Flow, UnknownAcknowledgementsAreHarmless) {
  Flow flow;
  note_ack(flow, 77, -5, 0.1);
  note_ack(flow, 3, 1e30f, 0.2);
  EXPECT_TRUE(may_send(flow, 0.3));
  EXPECT_GE(suggest_quality(flow, 80), 30);
}

}  // namespace
}  // namespace wellspring
