// SPDX-License-Identifier: Apache-2.0
// Who is corrected first, how much of each, and by how many threads.
#include "benchmark/corrective/correction_queue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <set>
#include <thread>

namespace wellspring::test {
namespace {

constexpr int size = 96;
const PixelBox left{0, 0, 48, size}, right{48, 0, size, size};

// Object 1 on the left, 2 on the right.
CorrectionPlan halves(float one, float two) {
  CorrectionPlan plan;
  plan.view.width = plan.view.height = size;
  for (int i = 0; i < size * size; i++) plan.object.push_back(i % size < 48 ? 1 : 2);
  plan.regions = {{1, left, one}, {2, right, two}};
  return plan;
}

std::vector<CorrectionJob> take_all(CorrectionQueue& queue) {
  std::vector<CorrectionJob> jobs;
  CorrectionJob job;
  while (queue.take(job)) jobs.push_back(job);
  return jobs;
}

size_t count_places(const std::vector<CorrectionJob>& jobs) {
  std::set<std::pair<int, int>> places;
  size_t count = 0;
  for (const CorrectionJob& job : jobs)
    for (ivec2 place : job.places) count++, places.insert({place.x, place.y});
  EXPECT_EQ(places.size(), count);  // each once
  return count;
}

TEST(CorrectionQueue, EachPixelOfEachRegionGoesOutOnceInJobsOfTheAskedSize) {
  CorrectionQueue queue({.levels = 4, .job = 50});
  queue.submit(halves(1, 0.9f));
  std::vector<CorrectionJob> jobs = take_all(queue);
  EXPECT_EQ(count_places(jobs), size_t(size * size));
  Sqrt5Grid grid = make_sqrt5_grid(4);
  for (const CorrectionJob& job : jobs) {
    EXPECT_LE(job.places.size(), 50u);
    std::vector<ivec2> listed;
    list_places(grid, job.level, job.object == 1 ? left : right, job.position,
                int64_t(job.places.size()), listed);
    EXPECT_EQ(listed, job.places);
  }
  EXPECT_TRUE(queue.empty());
  EXPECT_EQ(queue.stats().places, uint64_t(size * size));
  EXPECT_EQ(queue.stats().skipped, 0u);
}

TEST(CorrectionQueue, TheHighestPriorityIsNextAndFallsFromLevelToLevel) {
  CorrectionQueue queue({.levels = 4, .job = 64, .decay = 0.8f});
  queue.submit(halves(1, 0.7f));
  float before = INFINITY;
  for (const CorrectionJob& job : take_all(queue)) {
    float first = job.object == 1 ? 1.0f : 0.7f;
    EXPECT_FLOAT_EQ(job.priority, first * std::pow(0.8f, float(job.level - 1)));
    EXPECT_LE(job.priority, before);
    before = job.priority;
  }
}

TEST(CorrectionQueue, AnotherRegionGetsSomethingBeforeTheFirstIsDone) {
  CorrectionQueue queue({.levels = 4, .job = 64, .decay = 0.85f});
  queue.submit(halves(1, 0.9f));
  std::vector<CorrectionJob> jobs = take_all(queue);
  auto is = [](uint32_t object, int level) {
    return [=](const CorrectionJob& job) { return job.object == object && job.level >= level; };
  };
  auto second = std::find_if(jobs.begin(), jobs.end(), is(2, 1));
  auto finer = std::find_if(jobs.begin(), jobs.end(), is(1, 2));
  EXPECT_EQ(jobs.front().object, 1u);
  EXPECT_LT(second, finer);  // all of the first's coarsest level, then the second's
}

TEST(CorrectionQueue, EqualPrioritiesTakeTurns) {
  CorrectionQueue queue({.levels = 1, .job = 64});
  queue.submit(halves(1, 1));
  std::vector<CorrectionJob> jobs = take_all(queue);
  for (size_t i = 1; i < jobs.size(); i++) EXPECT_NE(jobs[i].object, jobs[i - 1].object);
}

TEST(CorrectionQueue, PlacesOfOtherObjectsCostNothing) {
  CorrectionQueue queue({.levels = 4, .job = 10});
  CorrectionPlan plan = halves(1, 1);
  std::fill(plan.object.begin(), plan.object.end(), 5u);
  for (size_t i = 0; i < size; i++) plan.object[i * size + i] = 1;  // a thin diagonal
  plan.regions = {{1, {-1000, -1000, 1000, 1000}, 1}};              // clipped to the picture
  queue.submit(plan);
  std::vector<CorrectionJob> jobs = take_all(queue);
  EXPECT_EQ(count_places(jobs), size_t(size));
  for (const CorrectionJob& job : jobs)
    for (ivec2 place : job.places) EXPECT_EQ(place.x, place.y);
  EXPECT_EQ(queue.stats().skipped, uint64_t(size * size - size));
}

TEST(CorrectionQueue, RegionsThatCannotBeCorrectedAreLeftOut) {
  CorrectionQueue queue;
  CorrectionJob job;
  EXPECT_FALSE(queue.take(job));
  CorrectionPlan plan = halves(NAN, -1);
  plan.regions.push_back({1, left, INFINITY});
  plan.regions.push_back({1, left, 0});
  plan.regions.push_back({0, left, 1});
  plan.regions.push_back({1, {size, 0, size + 9, 9}, 1});
  plan.regions.push_back({1, {9, 9, 9, 20}, 1});
  queue.submit(plan);
  EXPECT_TRUE(queue.empty());
  plan = halves(1, 1);
  plan.object.pop_back();
  queue.submit(plan);
  EXPECT_FALSE(queue.take(job));
  EXPECT_EQ(queue.stats().places + queue.stats().skipped, 0u);
  EXPECT_EQ(queue.plan(), 2u);
}

TEST(CorrectionQueue, ANewPlanOfTheSameViewChangesPrioritiesAndGoesOn) {
  CorrectionQueue queue({.levels = 4, .job = 64});
  queue.submit(halves(1, 0.1f));
  std::vector<CorrectionJob> jobs(20);
  for (CorrectionJob& job : jobs) {
    ASSERT_TRUE(queue.take(job));
    EXPECT_EQ(job.object, 1u);
  }
  queue.submit(halves(0.1f, 1));
  CorrectionJob job;
  ASSERT_TRUE(queue.take(job));
  EXPECT_EQ(job.object, 2u);
  EXPECT_EQ(job.plan, 2u);
  jobs.push_back(job);
  std::vector<CorrectionJob> rest = take_all(queue);
  EXPECT_EQ(rest.back().object, 1u);
  EXPECT_FLOAT_EQ(rest.back().priority, 0.1f * 0.9f * 0.9f * 0.9f);
  jobs.insert(jobs.end(), rest.begin(), rest.end());
  EXPECT_EQ(count_places(jobs), size_t(size * size));  // nothing twice
  queue.submit(halves(1, 1));
  EXPECT_TRUE(queue.empty());  // all is done
}

TEST(CorrectionQueue, APlanOfAnotherViewBeginsAnew) {
  CorrectionQueue queue({.levels = 3, .job = 64});
  queue.submit(halves(1, 1));
  take_all(queue);
  CorrectionPlan moved = halves(1, 1);
  moved.view.position.x = 1;
  moved.age = 7;
  moved.regions.pop_back();
  queue.submit(moved);
  std::vector<CorrectionJob> jobs = take_all(queue);
  EXPECT_EQ(count_places(jobs), size_t(48 * size));
  EXPECT_EQ(jobs[0].view.position.x, 1);
  EXPECT_EQ(jobs[0].age, 7u);
  // So does one where other pixels show the object.
  moved.object.assign(moved.object.size(), 2);
  moved.object[7 * size + 9] = 1;
  queue.submit(moved);
  jobs = take_all(queue);
  ASSERT_EQ(jobs.size(), 1u);
  EXPECT_EQ(jobs[0].places, std::vector<ivec2>{ivec2(9, 7)});
}

TEST(CorrectionQueue, ManyThreadsTakeEachPlaceOnce) {
  CorrectionQueue queue({.levels = 4, .job = 16});
  queue.submit(halves(1, 0.95f));
  std::vector<std::vector<CorrectionJob>> taken(8);
  std::vector<std::thread> tracers;
  for (std::vector<CorrectionJob>& jobs : taken)
    tracers.emplace_back([&] { jobs = take_all(queue); });
  for (std::thread& tracer : tracers) tracer.join();
  std::vector<CorrectionJob> all;
  for (const auto& jobs : taken) all.insert(all.end(), jobs.begin(), jobs.end());
  EXPECT_EQ(count_places(all), size_t(size * size));
  EXPECT_TRUE(queue.empty());
}

TEST(CorrectionQueue, PlansMayComeInWhileThreadsTrace) {
  CorrectionQueue queue({.levels = 4, .job = 16});
  std::atomic<bool> ends = false;
  std::vector<std::vector<CorrectionJob>> taken(4);
  std::vector<std::thread> tracers;
  for (std::vector<CorrectionJob>& jobs : taken)
    tracers.emplace_back([&] {
      CorrectionJob job;
      while (!ends || !queue.empty())
        if (queue.take(job)) jobs.push_back(job);
    });
  for (int i = 1; i <= 50; i++) {
    CorrectionPlan plan = halves(1, float(i % 3));
    plan.view.position.x = float(i);
    queue.submit(plan);
  }
  ends = true;
  for (std::thread& tracer : tracers) tracer.join();
  std::vector<CorrectionJob> last;
  for (const auto& jobs : taken)
    for (const CorrectionJob& job : jobs) {
      EXPECT_EQ(job.view.position.x, float(job.plan));
      if (job.plan == 50) last.push_back(job);
    }
  EXPECT_EQ(count_places(last), size_t(size * size));
}

}  // namespace
}  // namespace wellspring::test
