// SPDX-License-Identifier: Apache-2.0
// Warping against signals whose warp is known.
#include <gtest/gtest.h>

#include <cmath>

#include "avatar/speech_warp.h"
#include "base/rng.h"

namespace wellspring {
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
  for (size_t j = 0; j <= templates; j++) p.task.gap_before.push_back(j % 20 == 0);
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

TEST(SpeechWarp, FindsAKnownWarpAndItsGaps) {
  for (uint64_t seed : {1, 2, 3, 4}) {
    Problem p = make_problem(seed, 400);
    set_costs(p);
    WarpResult result = warp(p.task);
    ASSERT_TRUE(result.found);
    size_t wrong_gap = 0, far = 0;
    for (size_t t = 0; t < p.frames.size(); t++) {
      bool gap = result.way[t] < 0;
      wrong_gap += gap != (p.truth[t] < 0);
      far += !gap && p.truth[t] >= 0 && std::abs(double(result.way[t]) - p.truth[t]) > 2.5;
    }
    EXPECT_LE(wrong_gap, p.frames.size() / 50) << seed;
    EXPECT_LE(far, p.frames.size() / 20) << seed;
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
      EXPECT_TRUE(p.task.gap_before[size_t(-1 - at)]);
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

TEST(SpeechWarp, TooFewFramesHaveNoWay) {
  Problem p = make_problem(7, 100);
  set_costs(p);
  p.task.frames = 40;
  EXPECT_FALSE(warp(p.task).found);
  p.task.frames = 0;
  EXPECT_FALSE(warp(p.task).found);
}

}  // namespace
}  // namespace wellspring
