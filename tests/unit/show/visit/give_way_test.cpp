// SPDX-License-Identifier: Apache-2.0
#include "show/visit/flow.h"

#include <gtest/gtest.h>

#include <cmath>

#include "unit/show/visit/simulated_line.h"

namespace wellspring::test {
namespace {

constexpr double megabit = 1e6 / 8;

// Returns the pictures sent between two times.
std::vector<SimulatedPicture> between(const std::vector<SimulatedPicture>& all, double from,
                                      double to) {
  std::vector<SimulatedPicture> some;
  for (const SimulatedPicture& one : all)
    if (one.sent >= from && one.sent < to) some.push_back(one);
  return some;
}

double longest_lag(const std::vector<SimulatedPicture>& pictures) {
  double longest = 0;
  for (const SimulatedPicture& one : pictures) longest = std::max(longest, one.lag());
  return longest;
}

double longest_gap(const std::vector<SimulatedPicture>& pictures) {
  double longest = 0;
  for (size_t i = 1; i < pictures.size(); i++)
    longest = std::max(longest, pictures[i].shown - pictures[i - 1].shown);
  return longest;
}

size_t most_in_flight(const std::vector<SimulatedPicture>& pictures) {
  size_t most = 0;
  for (const SimulatedPicture& now : pictures)
    most = std::max(most, size_t(std::ranges::count_if(pictures, [&](const auto& other) {
                      return other.sent <= now.sent && other.acknowledged > now.sent;
                    })));
  return most;
}

TEST(GiveWay, ALineThatCarriesAllGetsAll) {
  SimulatedLine line{.rate = [](double) { return 2000 * megabit; }, .trip = 0.002};
  const auto pictures = between(simulate(line, {}, 5), 1, 5);
  ASSERT_GT(pictures.size(), 200u);
  for (const SimulatedPicture& one : pictures) {
    EXPECT_EQ(one.plan.quality, 82);
    EXPECT_EQ(one.plan.eighths, 8);
    EXPECT_EQ(one.limit, Limit::none);
  }
}

TEST(GiveWay, LagStaysWithinTwoRoundTripsAndATenthOfASecond) {
  for (double rate : {20.0, 5.0, 1.0})
    for (double trip : {0.02, 0.08, 0.2}) {
      SimulatedLine line{.rate = [&](double) { return rate * megabit; }, .trip = trip};
      const auto pictures = between(simulate(line, {}, 20), 1, 20);
      SCOPED_TRACE(testing::Message() << rate << " Mbit/s, " << trip << " s");
      EXPECT_LE(longest_lag(pictures), 2 * trip + 0.1);
      EXPECT_LE(longest_gap(pictures), 0.5);
      EXPECT_GT(pictures.size() / 19.0, 4);
      EXPECT_LE(most_in_flight(pictures), max_in_flight);
      if (rate < 20) {
        EXPECT_EQ(pictures.back().limit, Limit::network);
      }
    }
}

TEST(GiveWay, QualityFallsBeforeRateAndRateBeforeResolution) {
  Flow quick{.line_rate = 1e8};
  PicturePlan before{82, 60, 8};
  for (float at = 0; at <= 3; at += 0.1f) {
    GiveWay way;
    way.pressures[0].value = at;
    const PicturePlan plan = plan_picture(way, quick, {});
    if (plan.rate < 60 - 1e-6) {
      EXPECT_EQ(plan.quality, 30);
    }
    if (plan.eighths < 8) {
      EXPECT_NEAR(plan.rate, 8, 1e-6);
    }
    EXPECT_LE(plan.quality, before.quality);
    EXPECT_LE(plan.rate, before.rate + 1e-9);
    EXPECT_LE(plan.eighths, before.eighths);
    before = plan;
  }
  EXPECT_EQ(before.eighths, 2);
}

TEST(GiveWay, FullQualityIsBackWithinThreeSecondsOfTheLinesRecovery) {
  for (double trip : {0.02, 0.08}) {
    SimulatedLine line{.rate = [](double t) { return (t > 3 && t < 15 ? 1 : 200) * megabit; },
                       .trip = trip};
    const auto pictures = simulate(line, {}, 20);
    EXPECT_EQ(between(pictures, 2, 3).back().plan.quality, 82);
    EXPECT_EQ(between(pictures, 14, 15).back().limit, Limit::network);
    EXPECT_LT(between(pictures, 14, 15).back().plan.quality, 50);
    for (const SimulatedPicture& one : between(pictures, 18, 20)) {
      EXPECT_EQ(one.plan.quality, 82) << one.sent;
      EXPECT_EQ(one.plan.eighths, 8) << one.sent;
    }
    EXPECT_LE(longest_lag(between(pictures, 6, 20)), 2 * trip + 0.1);
  }
}

TEST(GiveWay, OthersQueuesDoNotStopIt) {
  SimulatedLine line{.rate = [](double) { return 5 * megabit; }, .trip = 0.05};
  line.others = [](double t) { return t > 3 && t < 8 ? 0.4 : 0.0; };  // somebody fills the buffer
  const auto pictures = simulate(line, {}, 14);
  EXPECT_LE(longest_gap(between(pictures, 1, 14)), 1.2);
  EXPECT_LE(longest_lag(between(pictures, 1, 2.5)), 0.2);
  EXPECT_LE(longest_lag(between(pictures, 10, 14)), 0.2);
  EXPECT_GE(between(pictures, 11, 14).back().plan.quality,
            between(pictures, 2, 3).back().plan.quality - 8);
}

TEST(GiveWay, ASlowDecoderIsNotTakenForASlowLine) {
  SimulatedLine line{.rate = [](double) { return 500 * megabit; },
                     .decode = [](double t) { return t < 10 ? 0.08 : 0.004; }};
  const auto pictures = simulate(line, {}, 15);
  const SimulatedPicture slow = between(pictures, 8, 10).back();
  EXPECT_EQ(slow.limit, Limit::browser);
  EXPECT_LE(longest_lag(between(pictures, 3, 10)), 2 * line.trip + 0.1);
  const SimulatedPicture later = pictures.back();
  EXPECT_EQ(later.limit, Limit::none);
  EXPECT_EQ(later.plan.quality, 82);
}

TEST(GiveWay, ASlowEncoderIsNotTakenForASlowLine) {
  SimulatedLine line{.rate = [](double) { return 500 * megabit; },
                     .encode = [](double t) { return t < 10 ? 0.06 : 0.004; }};
  const auto pictures = simulate(line, {}, 15);
  EXPECT_EQ(between(pictures, 8, 10).back().limit, Limit::server);
  EXPECT_EQ(pictures.back().limit, Limit::none);
}

TEST(GiveWay, FailedProbesBecomeRare) {
  SimulatedLine line;
  line.rate = [](double t) { return (std::fmod(t, 0.7) < 0.35 ? 3 : 6) * megabit; };  // deceives
  const auto pictures = between(simulate(line, {}, 30), 10, 30);
  int climbs = 0;
  for (size_t i = 1; i < pictures.size(); i++)
    climbs += pictures[i].plan.quality > pictures[i - 1].plan.quality + 3;
  EXPECT_LE(climbs, 25);
  EXPECT_LE(longest_gap(pictures), 0.5);
}

TEST(GiveWay, TheVisitorsLimitsAreKept) {
  SimulatedLine line{.rate = [](double) { return 1000 * megabit; }};
  FlowWishes wishes{.quality = 60, .rate = 12, .bandwidth = 1.5 * megabit};
  const auto pictures = between(simulate(line, wishes, 11), 1, 11);
  double bytes = 0;
  for (const SimulatedPicture& one : pictures) {
    bytes += one.bytes;
    EXPECT_LE(one.plan.quality, 60);
  }
  EXPECT_LE(pictures.size(), 121u);
  EXPECT_LE(bytes / 10, 1.1 * wishes.bandwidth);
  EXPECT_GE(bytes / 10, 0.3 * wishes.bandwidth);
}

TEST(GiveWay, NothingIsThrottledToZero) {
  SimulatedLine line;
  line.rate = [](double) { return 0.02 * megabit; };  // 2.5 kB a second
  const auto pictures = simulate(line, {}, 60);
  EXPECT_GE(pictures.size(), 15u);
  EXPECT_EQ(pictures.back().plan.eighths, 2);
}

TEST(GiveWay, WithoutAnswersToPingsTwoInFlightStillHold) {
  SimulatedLine line{.rate = [](double) { return 1 * megabit; }, .answers_pings = false};
  EXPECT_LE(most_in_flight(between(simulate(line, {}, 20), 12, 20)), max_in_flight);
}

}  // namespace
}  // namespace wellspring::test
