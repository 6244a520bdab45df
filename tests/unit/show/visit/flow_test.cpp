// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "show/visit/flow.h"

namespace wellspring::test {
namespace {

TEST(Flow, WithoutAcknowledgementsTheSocketAlonePaces) {
  Flow flow;
  for (uint32_t i = 1; i < 1000; i++) {
    EXPECT_TRUE(may_send(flow, i * 0.01));
    note_sent(flow, i, i * 0.01);
  }
  EXPECT_LE(flow.in_flight.size(), 64u);
}

TEST(Flow, WindowClosesAndOpensWithAcknowledgements) {
  Flow flow;
  note_sent(flow, 1, 0);
  note_ack(flow, 1, 2, 0.01);
  uint32_t frame = 1;
  while (may_send(flow, 0.02) && frame < 100) note_sent(flow, ++frame, 0.02);
  EXPECT_EQ(frame, 3u);  // two in flight
  EXPECT_FALSE(may_send(flow, 0.5));
  note_ack(flow, 3, 2, 0.6);  // answers for 2 as well
  EXPECT_TRUE(may_send(flow, 0.6));
  EXPECT_EQ(flow.in_flight.size(), 0u);
}

TEST(Flow, SilenceIsFollowedByATrickleNotByAStandstill) {
  Flow flow;
  note_sent(flow, 1, 0);
  note_ack(flow, 1, 2, 0.01);
  for (uint32_t i = 2; i <= 3; i++) note_sent(flow, i, 0.02);
  EXPECT_FALSE(may_send(flow, 1));
  EXPECT_TRUE(may_send(flow, 2.1));
  note_sent(flow, 6, 2.1);
  EXPECT_FALSE(may_send(flow, 2.2));
}

TEST(Flow, ALinesRateAndTripAreToldApart) {
  Flow flow;
  double now = 0.1, free = 0;
  note_delivery(flow, {0, 0, 0.08, true});
  for (int i = 0; i < 40; i++) {  // 1 MB/s, 80 ms; every fourth message is small
    const size_t bytes = i % 4 == 0 ? 300 : 20000;
    const bool alone = free + 0.08 <= now;
    free = std::max(free, now) + double(bytes) / 1e6;
    note_delivery(flow, {bytes, now, free + 0.08, alone});
    now += 0.05;
  }
  EXPECT_NEAR(flow.line_trip, 0.08, 0.001);
  EXPECT_NEAR(flow.line_rate, 1e6, 1e5);
}

TEST(Flow, ATripThatGrowsIsLearnedFromWhatNothingWasBefore) {
  Flow flow;
  for (int i = 0; i < 100; i++) note_delivery(flow, {100, 0.5 * i, 0.5 * i + 0.02, true});
  EXPECT_NEAR(flow.line_trip, 0.02, 1e-4);
  for (int i = 0; i < 100; i++) note_delivery(flow, {100, 50 + 0.5 * i, 50.1 + 0.5 * i, true});
  EXPECT_NEAR(flow.line_trip, 0.1, 1e-3);
}

TEST(Flow, WhatWasNotSentIsNotWaitedFor) {
  Flow flow{.acknowledges = true};
  note_sent(flow, 1, 0), note_sent(flow, 2, 0.01);
  EXPECT_FALSE(may_send(flow, 0.02));
  note_unsent(flow, 2);
  EXPECT_TRUE(may_send(flow, 0.02));
}

TEST(Flow, SizesFollowWhatWasEncoded) {
  Flow flow;
  for (int i = 0; i < 30; i++) note_encoded(flow, 200000, 1000000, 75, false);
  EXPECT_NEAR(expected_bytes(flow, 1000000, 75, false), 200000, 100);
  EXPECT_GT(expected_bytes(flow, 1000000, 92, true), 400000);
  EXPECT_LT(expected_bytes(flow, 1000000, 30, false), 110000);
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
}

}  // namespace
}  // namespace wellspring::test
