// SPDX-License-Identifier: Apache-2.0
#include "museum/upkeep.h"

#include <gtest/gtest.h>

using wellspring::museum::Heartbeat;

TEST(Heartbeat, GoesOnWithTicks) {
  Heartbeat heart;
  EXPECT_FALSE(heart.beats());
  heart.tick(1, 0);
  EXPECT_TRUE(heart.beats());
  heart.forget();
  EXPECT_FALSE(heart.beats());
  heart.tick(2, 0);
  EXPECT_TRUE(heart.beats());
}

TEST(Heartbeat, StopsWhenOneDrawingNeverEnds) {
  Heartbeat heart;
  auto beats = [&](double now, uint64_t drawing) {
    heart.forget();
    heart.tick(now, drawing);
    return heart.beats();
  };
  for (double now = 1; now < 200; now++) EXPECT_TRUE(beats(now, uint64_t(now)));
  EXPECT_TRUE(beats(200, 200));
  EXPECT_TRUE(beats(200 + Heartbeat::longest_drawing - 1, 200));
  EXPECT_FALSE(beats(200 + Heartbeat::longest_drawing + 1, 200));
  EXPECT_TRUE(beats(300, 201)) << "it has ended after all";
  EXPECT_TRUE(beats(500, 0));
}
