// SPDX-License-Identifier: Apache-2.0
// Holds what a running show counts: for the report, the metrics and the log.
#pragma once
#include <cstdint>

namespace wellspring::show {

// All are counters since the start, unless said otherwise.
struct ShowTotals {
  // pictures drawn, pictures warped, warps given up
  uint64_t drawn = 0, warped = 0, unwarpable = 0;
  uint64_t posed = 0;           // drawings of moving things by themselves, over pictures at rest
  uint64_t reconstructed = 0;   // pictures at rest that the network made
  float reconstruction_ms = 0;  // milliseconds of the last of these
  uint64_t surroundings = 0;    // surroundings drawn for quick turns
  uint64_t lenses = 0;          // pictures of what glasses show
  uint64_t given_up = 0;        // pictures that nobody needed any more before they were drawn
  uint64_t pictures = 0, picture_bytes = 0, samples = 0, messages = 0, refused_messages = 0;
  // orders left out, since newer ones of the same visitor came before their turn
  uint64_t orders_left_out = 0;
  float tick_ms = 0, animate_ms = 0;  // milliseconds of the last tick
  uint64_t utterances = 0, sounds = 0,
           // utterances spoken; packets sent; dropped: too slow a reader
      sounds_given_up = 0;
  uint64_t visits = 0, observations = 0, greetings = 0, farewells = 0, stories = 0;
  uint64_t gestures = 0;  // gestures of guests that were followed
  uint64_t lamps_switched = 0;
  uint64_t announcements = 0;
  uint64_t attention_analyses = 0;
  float attention_ms = 0;  // milliseconds of the last of these
};

struct BakerStatus {
  bool works = false;  // whether it bakes at the moment, on all cores
  uint64_t passes = 0;
  float error = 1;  // error of the bake so far, share of the mean light; 1: nothing is baked
};

}  // namespace wellspring::show
