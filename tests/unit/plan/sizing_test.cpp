// SPDX-License-Identifier: Apache-2.0
#include "plan/sizing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "unit/plan/made_costs.h"

namespace wellspring::test {
namespace {

Sizing sizing_of(int visitors, const Machine& machine = {}, const Goals& goals = {}) {
  const Demand demand{.visitors = visitors, .walking = 0.5, .standing = 0.4, .local = true};
  return size_fleet(usual_costs(), demand, machine, goals, 2, 0.002);
}

std::string refusal(const Demand& demand, const Machine& machine = {}, const Goals& goals = {}) {
  try {
    size_fleet(usual_costs(), demand, machine, goals, 2, 0.002);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(Sizing, ServersAreEnoughAndNoneIsTooMany) {
  const Sizing sizing = sizing_of(100);
  EXPECT_GE(sizing.servers * sizing.each, 100);
  EXPECT_LT((sizing.servers - 1) * sizing.each, 100);
  EXPECT_GE(sizing.outcome.keyframes, 2.85);
  EXPECT_LE(sizing.outcome.latency.quantile(0.95), 1.05);
  EXPECT_FALSE(sizing.limit.goal.empty());
  EXPECT_GT(sizing.bandwidth, 0);
  EXPECT_GT(sizing.memory, 1e9);
  EXPECT_EQ(sizing.workers, 0);
}

TEST(Sizing, MoreVisitorsNeverTakeFewerMachines) {
  int before = 0;
  for (const int visitors : {1, 2, 5, 9, 10, 17, 40, 41, 150}) {
    const Sizing sizing = sizing_of(visitors);
    EXPECT_GE(sizing.servers, before) << visitors;
    before = sizing.servers;
  }
}

TEST(Sizing, LargerMachinesAreFewer) {
  EXPECT_GT(sizing_of(200, {.cores = 8}).each, sizing_of(200, {.cores = 2}).each);
}

TEST(Sizing, MemoryLimitsVisitors) {
  const Sizing sizing = sizing_of(20, {.cores = 16, .memory = 1e9 + 3.5 * 15e6});
  EXPECT_EQ(sizing.each, 3);
  EXPECT_EQ(sizing.servers, 7);
  EXPECT_EQ(sizing.limit.goal, "memory");
}

TEST(Sizing, WorkersTraceWhatServersDoNot) {
  Goals goals;
  goals.samples = 2e5;
  const Sizing some = sizing_of(40, {}, goals);
  EXPECT_GT(some.workers, 0);
  EXPECT_GT(some.outcome.samples, 0.8 * goals.samples);
  goals.samples = 4e5;
  EXPECT_GT(sizing_of(40, {}, goals).workers, some.workers);
}

TEST(Sizing, NobodyNeedsNothing) {
  const Sizing sizing = sizing_of(0);
  EXPECT_EQ(sizing.servers, 0);
  EXPECT_EQ(sizing.workers, 0);
}

TEST(Sizing, WhatCannotBeReachedIsSaid) {
  EXPECT_NE(refusal({.visitors = 5, .local = true}, {.cores = 0.1}).find("one visitor alone has"),
            std::string::npos);
  EXPECT_NE(refusal({.visitors = 5}, {}, {.rate = 100}).find("pictures a second"),
            std::string::npos);
  EXPECT_NE(refusal({.visitors = 5}, {.memory = 1e6}).find("GB of memory"), std::string::npos);
  EXPECT_NE(refusal({.visitors = 5, .bandwidth = 0}).find("bandwidth"), std::string::npos);
  EXPECT_NE(refusal({.visitors = 5}, {}, {.latency = std::nan("")}).find("goals"),
            std::string::npos);
}

TEST(Sizing, APeakIsExceededOnceInTwenty) {
  EXPECT_EQ(visitors_at_peak(1000, 1), 1000);
  EXPECT_EQ(visitors_at_peak(1000, 0), 0);
  EXPECT_EQ(visitors_at_peak(0, 0.5), 0);
  EXPECT_EQ(visitors_at_peak(10000, 0.1), 1050);  // 1000 + 1.645 * 30
  EXPECT_EQ(visitors_at_peak(3, 0.9), 3);         // no more than there are
  EXPECT_THROW(visitors_at_peak(3, 1.1), std::invalid_argument);
  EXPECT_THROW(visitors_at_peak(3, std::nan("")), std::invalid_argument);
}

}  // namespace
}  // namespace wellspring::test
