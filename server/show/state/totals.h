// SPDX-License-Identifier: Apache-2.0
// What a running show counts: for the report, the metrics and the log.
#pragma once
#include <cstdint>

namespace wellspring::show {

// Counters since the start, unless said otherwise.
struct ShowTotals {
  uint64_t drawn = 0, warped = 0, unwarpable = 0;  // pictures; warps given up
  uint64_t posed = 0;           // what moves in pictures at rest, drawn by itself
  uint64_t reconstructed = 0;   // pictures at rest, by the network
  float reconstruction_ms = 0;  // of the last of these
  uint64_t surroundings = 0;    // drawn of quick turns
  uint64_t given_up = 0;        // pictures that nobody needed any more before they were drawn
  uint64_t pictures = 0, picture_bytes = 0, samples = 0, messages = 0, refused_messages = 0;
  uint64_t orders_left_out = 0;       // since newer ones of the same visitor came before their turn
  float tick_ms = 0, animate_ms = 0;  // of the last tick
  uint64_t utterances = 0, sounds = 0,
           sounds_given_up = 0;  // spoken; packets sent; too slow a reader
  uint64_t visits = 0, observations = 0, greetings = 0, farewells = 0, stories = 0;
  uint64_t gestures = 0;  // of guests, that were followed
  uint64_t lamps_switched = 0;
  uint64_t announcements = 0;
  uint64_t attention_analyses = 0;
  float attention_ms = 0;  // of the last of these
};

}  // namespace wellspring::show
