// SPDX-License-Identifier: Apache-2.0
// One simulated visitor: what it does, what the server has drawn for it, what is on its way.
#pragma once
#include <cstdint>

#include "plan/tally.h"

namespace wellspring::plan {

enum class Doing : uint8_t { walks, stands, rests };

// Counts for all who were here one after the other.
struct GuestCounts {
  uint64_t keyframes = 0, pictures = 0;
  double bytes = 0, samples = 0;
};

// Times are in seconds of the simulation.
struct Guest {
  int server = -1;
  uint32_t visit = 0;  // counts who comes; what is meant for somebody who has left is dropped
  // The visitor does what follows from when its first turn began.
  double phase = 0, came_at = 0;
  Doing doing = Doing::walks;
  double stood_at = 0;  // since when it stands

  // These are of pictures that are drawn (show::VisitorDrawState).
  int drawn_seq = -1;    // input that the newest keyframe shows; -1: there is none
  bool unshown = false;  // it was not sent yet
  double drawn_at = -1e9, sent_at = -1e9, pictured_at = -1e9, served = 0;
  double scale = 1, drawing = 0;  // the last keyframe has this scale, and took so long
  double asked_seconds = 0;       // for samples, of the renderer
  double wide_at = -1e9;          // when its wide view was drawn
  bool wide_drawn = false, wide_unsent = false;

  // These are of pictures that are made and sent.
  double warping = 0, encoding = 0;  // how long these took of late
  bool encodes = false;
  double encode_began = 0;
  int in_flight = 0;
  double line_free = 0;
  int shown_seq = -1;  // input that the last picture shows which has arrived

  GuestCounts counted;
  double turned_at = 0;    // when it began what it does
  double arrived_at = -1;  // when the last picture arrived
};

}  // namespace wellspring::plan
