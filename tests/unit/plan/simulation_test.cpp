// SPDX-License-Identifier: Apache-2.0
#include "plan/simulation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "unit/plan/made_costs.h"

namespace wellspring::test {
namespace {

constexpr Span span{4, 40, 3};

Outcome outcome_of(const Costs& costs, const Demand& demand, double cores = 2) {
  Fleet fleet;
  fleet.machine.cores = cores;
  return simulate(costs, demand, fleet, span);
}

// A renderer that is never idle draws one after the other: each of n visitors gets a keyframe every
// n drawings, and an input waits for its turn, evenly spread, and for the drawing.
TEST(Simulation, ARendererInRotation) {
  Costs costs = free_costs();
  costs.draw = constant(0.02);
  costs.serial = 1;
  const Outcome outcome = outcome_of(costs, {.visitors = 25, .local = true});
  const double turn = 25 * 0.02;
  EXPECT_NEAR(outcome.keyframes, 1 / turn, 0.03 / turn);
  EXPECT_NEAR(outcome.least_keyframes, 1 / turn, 0.06 / turn);
  EXPECT_NEAR(outcome.latency.quantile(0.5), 0.5 * turn + 0.02, 0.02);
  EXPECT_NEAR(outcome.latency.quantile(0.95), 0.95 * turn + 0.02, 0.03);
  EXPECT_NEAR(outcome.renderer, 1, 0.02);
}

// Keyframes of pages that draw by themselves are at most ten a second.
TEST(Simulation, AnIdleServerGivesWhatIsAskedFor) {
  const Outcome local = outcome_of(free_costs(), {.local = true});
  EXPECT_NEAR(local.keyframes, 10, 0.5);
  const Outcome finished = outcome_of(free_costs(), {});
  EXPECT_NEAR(finished.pictures, 60, 1.5);
  EXPECT_LT(finished.latency.quantile(0.95), 0.03);
  EXPECT_LT(finished.renderer, 0.1);
}

TEST(Simulation, ALineDelaysByItsLatencyAndByEachBytesTime) {
  Costs costs = free_costs();
  costs.keyframe_bytes = constant(20e3);
  const Demand quick{.local = true, .bandwidth = 1e9};
  Demand far = quick, slow = quick;
  far.latency = 1 / 30.0;  // so that inputs come at the same part of a tick
  slow.bandwidth = 1e6;
  const double base = outcome_of(costs, quick).latency.mean();
  EXPECT_NEAR(outcome_of(costs, far).latency.mean(), base + 2 * far.latency, 0.004);
  EXPECT_NEAR(outcome_of(costs, slow).latency.mean(), base + 20e3 / 1e6, 0.004);
}

// At most 0.85 of a line is used, and no more than two pictures are on their way.
TEST(Simulation, ASlowLineMakesPicturesFewer) {
  Costs costs = free_costs();
  costs.picture_bytes = constant(20e3);
  const Outcome narrow = outcome_of(costs, {.bandwidth = 250e3});
  EXPECT_NEAR(narrow.pictures, 0.85 * 250e3 / 20e3, 0.6);
  EXPECT_NEAR(narrow.line, 0.85, 0.05);
  const Outcome far = outcome_of(costs, {.latency = 0.25});
  EXPECT_NEAR(far.pictures, 2 / 0.5, 0.5);
}

// A tick that warps for every visitor shows each a picture every n warps.
TEST(Simulation, WarpsOfOneTickComeOneAfterTheOther) {
  Costs costs = free_costs();
  costs.warp = constant(0.02);  // 10 ms on two cores
  const Outcome outcome = outcome_of(costs, {.visitors = 10});
  EXPECT_NEAR(outcome.pictures, 0.5 / (10 * 0.010), 1);  // half of the time goes to warps
}

TEST(Simulation, MoreCoresAreNeverLater) {
  for (const bool local : {false, true}) {
    double before = std::numeric_limits<double>::infinity(), keyframes = 0;
    for (const double cores : {1.0, 2.0, 4.0, 8.0, 16.0}) {
      const Outcome outcome = outcome_of(usual_costs(), {.visitors = 12, .local = local}, cores);
      EXPECT_LT(outcome.latency.mean(), 1.05 * before) << cores;
      EXPECT_GT(outcome.keyframes, 0.95 * keyframes) << cores;
      before = outcome.latency.mean(), keyframes = outcome.keyframes;
    }
  }
}

TEST(Simulation, MoreVisitorsWaitLonger) {
  double before = 0;
  for (const int visitors : {1, 4, 16, 64}) {
    const Outcome outcome = outcome_of(usual_costs(), {.visitors = visitors, .local = true});
    EXPECT_GT(outcome.latency.quantile(0.95), before) << visitors;
    before = outcome.latency.quantile(0.95);
  }
}

TEST(Simulation, TheProxySendsEverybodyWhereFewestAre) {
  Fleet fleet{.servers = 7};
  const Outcome outcome =
      simulate(usual_costs(), {.visitors = 30, .local = true, .stay = 5}, fleet, span);
  EXPECT_GE(outcome.most_connections, 5);
  EXPECT_LE(outcome.most_connections, 9);
}

TEST(Simulation, WhoStandsOrIsHiddenLeavesTheRendererToWalkers) {
  const Demand all{.visitors = 24, .local = true};
  Demand some = all;
  some.walking = 0.3, some.standing = 0.4;
  const Outcome crowded = outcome_of(usual_costs(), all), quiet = outcome_of(usual_costs(), some);
  EXPECT_GT(quiet.keyframes, 1.5 * crowded.keyframes);
  Demand none = all;
  none.walking = 0;
  const Outcome asleep = outcome_of(usual_costs(), none);
  EXPECT_EQ(asleep.latency.count(), 0u);
  EXPECT_EQ(asleep.keyframes, 0);
}

TEST(Simulation, WorkersLeaveTheRendererMoreTime) {
  Costs costs = usual_costs();
  Fleet fleet;
  const Demand demand{.visitors = 8, .local = true};
  const Outcome alone = simulate(costs, demand, fleet, span);
  fleet.workers = 4, fleet.worker_cores = 4;
  const Outcome helped = simulate(costs, demand, fleet, span);
  EXPECT_GT(helped.samples, 1.5 * alone.samples);
  EXPECT_GE(helped.keyframes, alone.keyframes);
  fleet.worker_trip = 5;  // answers come when nobody needs them
  EXPECT_NEAR(simulate(costs, demand, fleet, span).samples, alone.samples, 0.2 * alone.samples);
}

TEST(Simulation, TheSameSeedGivesTheSameNumbers) {
  const Demand demand{.visitors = 9, .walking = 0.5, .standing = 0.3, .stay = 20};
  const Outcome one = outcome_of(usual_costs(), demand), two = outcome_of(usual_costs(), demand);
  EXPECT_EQ(one.latency.count(), two.latency.count());
  EXPECT_EQ(one.total_bytes, two.total_bytes);
}

TEST(Simulation, ManyMachinesOnPaper) {
  Fleet fleet{.servers = 1250, .workers = 1000, .worker_cores = 8};
  const Outcome outcome = simulate(usual_costs(), {.visitors = 10000, .local = true, .stay = 600},
                                   fleet, {.warm_up = 1, .seconds = 2});
  EXPECT_GT(outcome.latency.count(), 100000u);
  EXPECT_GT(outcome.keyframes, 1);
  EXPECT_EQ(outcome.most_connections, 8);
}

TEST(Simulation, NobodyIsNoTrouble) {
  const Outcome outcome = outcome_of(usual_costs(), {.visitors = 0});
  EXPECT_EQ(outcome.latency.count(), 0u);
  EXPECT_EQ(outcome.total_bytes, 0);
}

TEST(Simulation, WhatMakesNoSenseIsRefused) {
  const double nan = std::nan("");
  auto refusal = [](const Demand& demand, const Fleet& fleet = {}, const Span& one = span) {
    try {
      simulate(usual_costs(), demand, fleet, one);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(refusal({.bandwidth = 0}),
            "the line's bandwidth: has to be from 1000 to 1e+12, and is 0");
  EXPECT_NE(refusal({.visitors = -1}).find("visitors: has to be"), std::string::npos);
  EXPECT_NE(refusal({.visitors = 2000000000}).find("visitors"), std::string::npos);
  EXPECT_NE(refusal({.walking = nan}).find("walks"), std::string::npos);
  EXPECT_NE(refusal({.walking = 0.7, .standing = 0.7}).find("walk and stand"), std::string::npos);
  EXPECT_NE(refusal({.pixels = nan}).find("pixels"), std::string::npos);
  EXPECT_NE(refusal({.latency = -1}).find("latency"), std::string::npos);
  EXPECT_NE(refusal({}, {.servers = 0}).find("servers"), std::string::npos);
  EXPECT_NE(refusal({}, {.machine = {.cores = nan}}).find("cores"), std::string::npos);
  EXPECT_NE(refusal({}, {.machine = {.bandwidth = 0}}).find("network"), std::string::npos);
  EXPECT_NE(refusal({}, {}, {.seconds = 0}).find("simulated time"), std::string::npos);
}

}  // namespace
}  // namespace wellspring::test
