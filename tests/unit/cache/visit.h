// SPDX-License-Identifier: Apache-2.0
// One visitor of the analytic room: what the show does for a picture, in one place.
#pragma once
#include "cache/cache.h"
#include "unit/cache/room.h"

namespace wellspring {

struct Visit {
  Scene scene;
  World world{scene};
  Room room;
  RenderCache cache;
  std::vector<Request> requests;
  std::vector<Sample> samples;
  std::vector<Ray> looks;
  std::vector<Seen> seen;
  Frame frame;
  uint64_t tick = 1;
  int most_looks = 0;

  void step(const View& view, int budget) {
    cache.resize(view.width, view.height);
    cache.move_points(world);
    cache.project(view);
    cache.attend();
    cache.plan(view, budget, tick++, requests);
    trace_room(room, requests, samples);
    cache.remember(view, requests, samples);
    cache.survey(view, most_looks, frame, looks);
    see_room(room, looks, seen);
    cache.reconstruct(view, seen, frame);
  }
};

}  // namespace wellspring
