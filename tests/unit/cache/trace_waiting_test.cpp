// SPDX-License-Identifier: Apache-2.0
// All cores as a worker: whose pieces it takes, and when it stops.
#include "cache/broker.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <limits>
#include <thread>

#include "base/clock.h"

namespace wellspring::test {
namespace {

std::vector<uint64_t> traced;  // seeds, in order; one thread only

Technique writing_down() {
  Technique technique{.name = "writes down what it is asked"};
  technique.trace = [](const World&, const Lights&, const TransportSettings&,
                       const Request& request) {
    traced.push_back(request.seed);
    return Sample{.distance = float(request.seed)};
  };
  return technique;
}

std::vector<Request> seeded(uint64_t first, int count) {
  std::vector<Request> requests(static_cast<size_t>(count));
  for (Request& r : requests) r.seed = first++;
  return requests;
}

struct Bench {
  Scene scene;
  World world{scene};
  Lights lights;
  Technique technique = writing_down();
  std::mutex guard;
};

TEST(TraceWaiting, VisitorsTakeTurnsHoweverMuchTheyAsk) {
  oneapi::tbb::global_control single(oneapi::tbb::global_control::max_allowed_parallelism, 1);
  Bench bench;
  traced.clear();
  Broker greedy({.piece = 1}), modest({.piece = 1});
  greedy.ask({}, {&bench.technique, {}}, seeded(0, 100));
  modest.ask({}, {&bench.technique, {}}, seeded(1000, 10));
  Broker* both[] = {&greedy, &modest};
  size_t count = trace_waiting(both, bench.world, bench.lights, 7,
                               std::numeric_limits<double>::infinity(), bench.guard);
  EXPECT_EQ(count, 110u);
  ASSERT_EQ(traced.size(), 110u);
  int of_modest = 0;
  for (size_t i = 0; i < 20; i++) of_modest += traced[i] >= 1000;
  EXPECT_EQ(of_modest, 10);
  std::vector<Answer> answers = modest.collect();
  ASSERT_EQ(answers.size(), 10u);
  for (const Answer& answer : answers) {
    EXPECT_EQ(answer.pose, 7u);
    EXPECT_EQ(answer.samples[0].distance, float(answer.piece.requests[0].seed));
  }
}

TEST(TraceWaiting, StopsWhenTimeIsUp) {
  Bench bench;
  traced.clear();
  Broker broker;
  broker.ask({}, {&bench.technique, {}}, seeded(0, 1000));
  Broker* one[] = {&broker};
  EXPECT_EQ(trace_waiting(one, bench.world, bench.lights, 1, seconds_now() - 1, bench.guard), 0u);
  EXPECT_EQ(broker.waiting(), 1000);
  EXPECT_TRUE(traced.empty());
}

TEST(TraceWaiting, OtherWorkersMayHelp) {
  Bench bench;
  bench.technique.trace = [](const World&, const Lights&, const TransportSettings&,
                             const Request& request) {
    return Sample{.distance = float(request.seed)};
  };
  Broker broker({.piece = 8});
  broker.ask({}, {&bench.technique, {}}, seeded(0, 8000));
  std::thread helper([&] {
    while (true) {
      std::optional<Piece> piece;
      {
        std::lock_guard lock(bench.guard);
        piece = broker.take();
      }
      if (!piece) return;
      Answer answer{std::move(*piece), 1, {}};
      for (const Request& r : answer.piece.requests)
        answer.samples.push_back(bench.technique.trace(bench.world, bench.lights, {}, r));
      std::lock_guard lock(bench.guard);
      broker.answer(std::move(answer));
    }
  });
  Broker* one[] = {&broker};
  trace_waiting(one, bench.world, bench.lights, 1, std::numeric_limits<double>::infinity(),
                bench.guard);
  helper.join();
  uint64_t expected = 0, sum = 0;
  for (uint64_t i = 0; i < 8000; i++) expected += i;
  size_t count = 0;
  for (const Answer& answer : broker.collect())
    for (size_t i = 0; i < answer.samples.size(); i++, count++) {
      EXPECT_EQ(answer.samples[i].distance, float(answer.piece.requests[i].seed));
      sum += answer.piece.requests[i].seed;
    }
  EXPECT_EQ(count, 8000u);
  EXPECT_EQ(sum, expected);
}

}  // namespace
}  // namespace wellspring::test
