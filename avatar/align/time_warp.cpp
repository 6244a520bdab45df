// SPDX-License-Identifier: Apache-2.0
#include "avatar/align/time_warp.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace wellspring::avatar {

namespace {

constexpr float never = std::numeric_limits<float>::infinity();

// A cell says how two states were reached: the template itself (low bits) and the gap before it;
// the bits above say how far back the way came from, if it went back.
enum From : uint16_t { stay = 0, advance = 1, skip = 2, from_gap = 3, back = 4, how_mask = 7 };
constexpr uint16_t gap_entered = 8,
                   gap_back = 16;  // bits: from template - 1, or back; neither: it went on
constexpr int distance_shift = 5;
constexpr size_t most_distance = 0xffff >> distance_shift;

struct Row {
  size_t first = 0;
  std::vector<uint16_t> from;  // one a template from `first` on; the last cell is a gap only
};

// Holds the costs of all states at one frame, addressed by template with a border of `never`.
struct Front {
  size_t first = 0;
  std::vector<float> at, gap, spent;  // spent: frames spent at the template
  float template_cost(ptrdiff_t j) const { return get(at, j); }
  float gap_cost(ptrdiff_t j) const { return get(gap, j); }
  float get(const std::vector<float>& list, ptrdiff_t j) const {
    ptrdiff_t k = j - ptrdiff_t(first);
    return k < 0 || k >= ptrdiff_t(list.size()) ? never : list[size_t(k)];
  }
};

// Returns the cheapest way back to template j: its cost and how many templates it goes back.
std::pair<float, size_t> best_return(const WarpTask& task, const Front& before, size_t j) {
  std::pair<float, size_t> best{never, 0};
  if (task.returns.empty() || j >= task.templates) return best;
  for (const WarpReturn& way : task.returns[j]) {
    float cost = before.template_cost(ptrdiff_t(way.from)) + way.cost;
    if (cost < best.first && way.from - j <= most_distance) best = {cost, way.from - j};
  }
  return best;
}

}  // namespace

WarpResult warp(const WarpTask& task) {
  WarpResult result;
  if (task.frames == 0 || task.templates == 0) return result;
  std::vector<Row> rows(task.frames);
  Front before, now;
  std::vector<float> costs;
  // Before the first frame nothing is said, and the gap before the first template is open.
  before.at.assign(1, never);
  before.gap.assign(1, 0);
  before.spent.assign(1, 0);

  for (size_t t = 0; t < task.frames; t++) {
    size_t first = task.first.empty() ? 0 : task.first[t];
    size_t last = task.last.empty() ? task.templates : task.last[t];  // one past the last template
    costs.assign(last - first, 0);
    task.costs(t, first, last, costs.data());
    now.first = first;
    now.at.assign(last - first + 1, never);
    now.gap.assign(last - first + 1, never);
    now.spent.assign(last - first + 1, 1);
    Row& row = rows[t];
    row.first = first;
    row.from.assign(last - first + 1, 0);
    for (size_t j = first; j <= last; j++) {
      ptrdiff_t i = ptrdiff_t(j);
      size_t cell = j - first;
      auto [return_cost, distance] = best_return(task, before, j);
      row.from[cell] = uint16_t(distance << distance_shift);
      if (j < last) {
        float best = before.template_cost(i), spent = 0;
        if (best < never) {
          spent = before.get(before.spent, i);
          best += task.stay * spent / (task.expected.empty() ? 1 : task.expected[j]);
        }
        uint16_t how = stay;
        auto offer = [&](float cost, uint16_t way) {
          if (cost < best) best = cost, how = way;
        };
        offer(before.template_cost(i - 1), advance);
        if (task.may_skip && task.gap_before[j] == WarpGap::none)
          offer(before.template_cost(i - 2) + task.skip, skip);
        offer(before.gap_cost(i), from_gap);
        offer(return_cost, back);
        now.at[cell] = best + costs[cell];
        now.spent[cell] = how == stay ? spent + 1 : 1;
        row.from[cell] |= how;
      }
      if (task.gap_before[j] != WarpGap::none) {
        bool silent = task.gap_before[j] == WarpGap::silence;
        float enter = silent ? task.enter_silence : task.enter_gap;
        float best = before.gap_cost(i), in = before.template_cost(i - 1) + enter;
        uint16_t how = 0;
        if (in < best) best = in, how = gap_entered;
        if (return_cost + enter < best) best = return_cost + enter, how = gap_back;
        now.gap[cell] = best + (silent ? task.silence_cost[t] : task.gap_cost[t]);
        row.from[cell] |= how;
      }
    }
    std::swap(before, now);
  }

  ptrdiff_t end = ptrdiff_t(task.templates);
  float said = before.template_cost(end - 1), silent = before.gap_cost(end);
  if (!(std::min(said, silent) < never)) return result;
  result.found = true;
  result.cost = double(std::min(said, silent));
  result.way.resize(task.frames);
  bool gap = silent < said;
  ptrdiff_t j = gap ? end : end - 1;
  for (size_t t = task.frames; t-- > 0;) {
    uint16_t from = rows[t].from[size_t(j) - rows[t].first];
    ptrdiff_t distance = from >> distance_shift;
    result.way[t] = int32_t(gap ? -1 - j : j);
    if (gap) {
      if (from & gap_entered) gap = false, j--;
      if (from & gap_back) gap = false, j += distance;
    } else {
      switch (from & how_mask) {
        case stay: break;
        case advance: j--; break;
        case skip: j -= 2; break;
        case from_gap: gap = true; break;
        case back: j += distance; break;
      }
    }
  }
  return result;
}

}  // namespace wellspring::avatar
