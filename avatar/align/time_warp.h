// SPDX-License-Identifier: Apache-2.0
// Dynamic time warping of a recording onto a sequence of templates (Sakoe & Chiba 1978), with
// pauses and foreign sounds between words: the cheapest way through, found by dynamic programming.
//
// Every frame of the recording is given a template, or is left out before a template that allows
// it. From frame to frame the template stays, advances by one, or, where `may_skip`, by two; or it
// goes back to where a word begins that is said once more. The way begins at the first template and
// ends at the last. Time and memory: frames times the band's width.
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
  // Cost of a frame at templates [first, last), written to `out`; called once a frame, in order.
  std::function<void(size_t frame, size_t first, size_t last, float* out)> costs;
  std::vector<float> gap_cost;             // of leaving a frame out, for each frame
  std::vector<float> silence_cost;         // the same in gaps that must be silent
  std::vector<WarpGap> gap_before;         // for each template; one entry more for the end
  float enter_gap = 0, enter_silence = 0;  // once for every stretch left out, by the gap's kind
  // For each template those after which the way may come back to it, themselves included; empty:
  // it never goes back.
  std::vector<std::vector<WarpReturn>> returns;
  float stay = 0, skip = 0;  // added for staying at a template, and for skipping one
  // Frames each template is expected to last; empty: 1. Staying costs the more the longer it lasts
  // already: `stay` times the frames spent there over the frames expected. The frames spent are
  // those of the cheapest way so far, so this one rule is followed greedily.
  std::vector<float> expected;
  bool may_skip = true;
  // Templates [first, last) that each frame may have; empty: all. Both never decrease with the
  // frame.
  std::vector<uint32_t> first, last;
};

struct WarpResult {
  bool found = false;        // false: more templates than the frames can pass in the band
  std::vector<int32_t> way;  // of each frame: its template, or -1 - the one it is left out before
  double cost = 0;           // sum
};

WarpResult warp(const WarpTask& task);

}  // namespace wellspring::avatar
