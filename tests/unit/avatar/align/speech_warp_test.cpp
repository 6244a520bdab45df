// SPDX-License-Identifier: Apache-2.0
// Warping against signals whose warp is known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "avatar/align/time_warp.h"
#include "base/rng.h"

namespace wellspring::test {
namespace {

// A smooth random curve: templates sample it evenly, recordings at warped times.
struct Curve {
  std::vector<float> nodes;
  explicit Curve(Rng& rng, size_t count) {
    for (size_t i = 0; i < count + 4; i++) nodes.push_back(4 * rng.uniform());
  }
  float at(double t) const {
    double x = t / 5;
    size_t i = std::min(size_t(x), nodes.size() - 2);
    float f = float(x - double(i));
    f = f * f * (3 - 2 * f);
    return nodes[i] + (nodes[i + 1] - nodes[i]) * f;
  }
};

struct Problem {
  std::vector<float> templates, frames, loud;  // loud: 0 where a gap is
  std::vector<double> truth;                   // template of each frame; -1 in a gap
  WarpTask task;
};

// `templates` points, words of 20; before every word a gap of up to 40 frames; speed 0.6 to 1.8.
Problem make_problem(uint64_t seed, size_t templates) {
  Rng rng{seed};
  Curve curve(rng, templates / 5 + 2);
  Problem p;
  for (size_t j = 0; j < templates; j++) p.templates.push_back(curve.at(double(j)));
  for (double t = 0; t < double(templates) - 0.5;) {
    size_t word = size_t(t + 0.5) / 20;
    if (p.truth.empty() || size_t(std::max(p.truth.back(), 0.0) + 0.5) / 20 != word ||
        (t == 0 && p.truth.empty()))
      for (int k = int(40 * rng.uniform()); k > 0; k--) {
        p.frames.push_back(20 + rng.uniform());
        p.loud.push_back(0);
        p.truth.push_back(-1);
      }
    p.frames.push_back(curve.at(t) + 0.1f * (rng.uniform() - 0.5f));
    p.loud.push_back(1);
    p.truth.push_back(t);
    t += 1.2 + 0.6 * std::sin(t / 37);
  }
  p.task.frames = p.frames.size();
  p.task.templates = templates;
  for (size_t j = 0; j <= templates; j++)
    p.task.gap_before.push_back(j % 20 == 0 ? WarpGap::anything : WarpGap::none);
  for (float loud : p.loud) p.task.gap_cost.push_back(loud > 0 ? 1.0f : 0.1f);
  p.task.enter_gap = 0.2f;
  p.task.stay = p.task.skip = 0.01f;
  return p;
}

void set_costs(Problem& p) {
  p.task.costs = [&p](size_t t, size_t first, size_t last, float* out) {
    for (size_t j = first; j < last; j++) *out++ = std::abs(p.frames[t] - p.templates[j]);
  };
}

// Frames taken for a gap or a template that are neither, and those far from their template: few.
void expect_near_truth(const Problem& p, const WarpResult& result) {
  size_t wrong_gap = 0, far = 0;
  for (size_t t = 0; t < p.frames.size(); t++) {
    bool gap = result.way[t] < 0;
    wrong_gap += gap != (p.truth[t] < 0);
    far += !gap && p.truth[t] >= 0 && std::abs(double(result.way[t]) - p.truth[t]) > 2.5;
  }
  EXPECT_LE(wrong_gap, p.frames.size() / 50);
  EXPECT_LE(far, p.frames.size() / 20);
}

TEST(SpeechWarp, FindsAKnownWarpAndItsGaps) {
  for (uint64_t seed : {1, 2, 3, 4}) {
    Problem p = make_problem(seed, 400);
    set_costs(p);
    WarpResult result = warp(p.task);
    ASSERT_TRUE(result.found);
    SCOPED_TRACE(seed);
    expect_near_truth(p, result);
  }
}

TEST(SpeechWarp, WayIsLegalFromTheFirstTemplateToTheLast) {
  Problem p = make_problem(9, 200);
  set_costs(p);
  WarpResult result = warp(p.task);
  ASSERT_TRUE(result.found);
  int last = -1;  // the template before
  for (int32_t at : result.way) {
    if (at < 0) {
      EXPECT_EQ(-1 - at, last + 1);
      EXPECT_EQ(p.task.gap_before[size_t(-1 - at)], WarpGap::anything);
    } else {
      EXPECT_GE(at, last);
      EXPECT_LE(at, last + 2);
      last = at;
    }
  }
  EXPECT_EQ(last, 199);
}

TEST(SpeechWarp, ABandAroundTheWayFindsTheSameWay) {
  Problem p = make_problem(5, 300);
  set_costs(p);
  WarpResult whole = warp(p.task);
  ASSERT_TRUE(whole.found);
  for (int32_t at : whole.way) {
    uint32_t j = uint32_t(at < 0 ? -1 - at : at);
    p.task.first.push_back(j > 30 ? j - 30 : 0);
    p.task.last.push_back(std::min(j + 31, 300u));
  }
  WarpResult banded = warp(p.task);
  ASSERT_TRUE(banded.found);
  EXPECT_EQ(banded.way, whole.way);
  EXPECT_DOUBLE_EQ(banded.cost, whole.cost);
}

TEST(SpeechWarp, CostIsTheSumAlongTheWay) {
  Problem p = make_problem(6, 100);
  set_costs(p);
  WarpResult result = warp(p.task);
  double sum = 0;
  int last = -1, spent = 0;
  bool was_gap = false;
  for (size_t t = 0; t < result.way.size(); t++) {
    int at = result.way[t];
    if (at < 0) {
      sum += double(p.task.gap_cost[t]) + (!was_gap && t > 0 ? double(p.task.enter_gap) : 0);
      was_gap = true;
      spent = 0;
      continue;
    }
    sum += std::abs(double(p.frames[t]) - double(p.templates[size_t(at)]));
    if (at == last && !was_gap) sum += double(p.task.stay) * spent;
    if (at == last + 2) sum += double(p.task.skip);
    spent = at == last && !was_gap ? spent + 1 : 1;
    last = at;
    was_gap = false;
  }
  EXPECT_NEAR(result.cost, sum, 1e-3 * sum);
}

// Words of 20 templates, each made of parts that end after 8, 14 and 20 of them. Before a word,
// parts of it are said once to three times with or without silence; within words voices fail.
Problem make_stutter(uint64_t seed, size_t templates) {
  Rng rng{seed};
  Curve curve(rng, templates / 5 + 2);
  Problem p;
  for (size_t j = 0; j < templates; j++) p.templates.push_back(curve.at(double(j)));
  auto add = [&](double truth, float value, float loud) {
    p.truth.push_back(truth), p.frames.push_back(value), p.loud.push_back(loud);
  };
  auto say = [&](size_t first, size_t end) {
    for (double t = double(first); t < double(end) - 0.5; t += 0.8 + 0.4 * double(rng.uniform()))
      add(t, curve.at(t) + 0.1f * (rng.uniform() - 0.5f), 1);
  };
  auto be_silent = [&] {
    for (int k = int(30 * rng.uniform()); k > 0; k--) add(-1, 20 + rng.uniform(), 0);
  };
  for (size_t word = 0; word < templates; word += 20) {
    if (rng.uniform() < 0.3f)
      for (int k = int(3 * rng.uniform()); k >= 0; k--) {
        size_t part = rng.uniform() < 0.5f ? 8 : rng.uniform() < 0.5f ? 14 : 20;
        say(word, word + part);
        if (rng.uniform() < 0.5f) be_silent();
      }
    say(word, word + 8);
    if (rng.uniform() < 0.2f) be_silent();
    say(word + 8, word + 20);
  }
  p.task.frames = p.frames.size();
  p.task.templates = templates;
  p.task.returns.resize(templates);
  for (size_t j = 0; j <= templates; j++) {
    size_t place = j % 20;
    p.task.gap_before.push_back(place == 0   ? WarpGap::anything
                                : place == 8 ? WarpGap::silence
                                             : WarpGap::none);
    if (j < templates && (place == 7 || place == 13 || place == 19))
      p.task.returns[j - place].push_back({uint32_t(j), 1});
  }
  for (float loud : p.loud) {
    p.task.gap_cost.push_back(loud > 0 ? 1.0f : 0.1f);
    p.task.silence_cost.push_back(loud > 0 ? 10.0f : 0.1f);
  }
  p.task.enter_gap = p.task.enter_silence = 0.2f;
  p.task.stay = p.task.skip = 0.01f;
  return p;
}

TEST(SpeechWarp, WordsAreSaidAgainWhollyOrInPart) {
  for (uint64_t seed : {1, 2, 3, 4}) {
    Problem p = make_stutter(seed, 400);
    set_costs(p);
    WarpResult result = warp(p.task);
    ASSERT_TRUE(result.found);
    SCOPED_TRACE(seed);
    expect_near_truth(p, result);
    size_t repeats = 0, found = 0;
    int32_t last = 0;
    double last_truth = 0;
    for (size_t t = 0; t < p.frames.size(); t++) {
      if (p.truth[t] >= 0) {
        repeats += p.truth[t] < last_truth - 1;
        last_truth = p.truth[t];
      }
      if (result.way[t] >= 0) {
        found += result.way[t] < last;
        if (result.way[t] < last) {
          EXPECT_EQ(result.way[t] % 20, 0);
        }
        last = result.way[t];
      }
    }
    EXPECT_GE(repeats, 4u);
    EXPECT_NEAR(double(found), double(repeats), 1);

    p.task.returns.clear();
    WarpResult straight = warp(p.task);
    ASSERT_TRUE(straight.found);
    EXPECT_LT(result.cost, straight.cost);
  }
}

TEST(SpeechWarp, SilenceWithinAWordIsNoPlaceForOtherSounds) {
  Problem p = make_problem(3, 60);
  set_costs(p);
  p.task.gap_before.assign(61, WarpGap::none);
  p.task.gap_before[0] = p.task.gap_before[60] = WarpGap::anything;
  p.task.gap_before[30] = WarpGap::silence;
  p.task.silence_cost.assign(p.task.frames, 0);
  p.task.gap_cost.assign(p.task.frames, 1000);
  WarpResult silent = warp(p.task);
  ASSERT_TRUE(silent.found);
  EXPECT_GT(std::count(silent.way.begin(), silent.way.end(), -31), 0);
  p.task.silence_cost.assign(p.task.frames, 1000);
  p.task.gap_cost.assign(p.task.frames, 0);
  WarpResult other = warp(p.task);
  ASSERT_TRUE(other.found);
  EXPECT_EQ(std::count(other.way.begin(), other.way.end(), -31), 0);
}

TEST(SpeechWarp, TooFewFramesHaveNoWay) {
  Problem p = make_problem(7, 100);
  set_costs(p);
  p.task.frames = 40;
  EXPECT_FALSE(warp(p.task).found);
  p.task.frames = 0;
  EXPECT_FALSE(warp(p.task).found);
}

}  // namespace
}  // namespace wellspring::test
