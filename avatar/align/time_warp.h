// SPDX-License-Identifier: Apache-2.0
// Warps a recording onto a sequence of templates (dynamic time warping: Sakoe & Chiba 1978), with
// pauses and foreign sounds between words. The cheapest way is found by dynamic programming.
//
// Every frame of the recording is given a template, or is left out before a template that allows
// it. From frame to frame the template stays, advances by one, or, with `may_skip`, by two; or the
// way goes back to the beginning of a word that is said once more. It begins at the first template
// and ends at the last. Time and memory grow with the frames times the band's width.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace wellspring::avatar {

enum class WarpGap : uint8_t { none, silence, anything };

// After template `from` the way may go back to an earlier one, or to the gap before that.
struct WarpReturn {
  uint32_t from = 0;
  float cost = 0;
};

struct WarpTask {
  size_t frames = 0, templates = 0;
  // Writes the cost of a frame at templates [first, last) to `out`; called once a frame, in order.
  std::function<void(size_t frame, size_t first, size_t last, float* out)> costs;
  std::vector<float> gap_cost;      // cost of leaving each frame out
  std::vector<float> silence_cost;  // the same in gaps that must be silent
  std::vector<WarpGap> gap_before;  // kind of gap before each template; one entry more for the end
  float enter_gap = 0, enter_silence = 0;  // cost of every stretch left out, by the gap's kind
  // Lists, for each template, the templates after which the way may come back to it, itself
  // included; empty: the way never goes back.
  std::vector<std::vector<WarpReturn>> returns;
  float stay = 0, skip = 0;  // cost added for staying at a template, for skipping one
  // Frames each template is expected to last; empty: 1. Staying costs the more the longer it lasts
  // already: `stay` times the frames spent there over the frames expected. The frames spent are
  // counted along the cheapest way so far, so this one rule is followed greedily.
  std::vector<float> expected;
  bool may_skip = true;
  // Templates [first, last) that each frame may have; empty: all. Both never decrease with the
  // frame.
  std::vector<uint32_t> first, last;
};

struct WarpResult {
  bool found = false;        // false: more templates than the frames can pass in the band
  std::vector<int32_t> way;  // each frame's template, or -1 - the one it is left out before
  double cost = 0;           // sum of all costs
};

WarpResult warp(const WarpTask& task);

}  // namespace wellspring::avatar
