// SPDX-License-Identifier: Apache-2.0
// One visitor of the analytic room: what the show does for a picture, in one place.
#pragma once
#include <optional>

#include "light/sample/lights.h"
#include "picture/compositor.h"
#include "unit/cache/room.h"

namespace wellspring::test {

struct Visit {
  Room room;  // with or without its lamp for good, once there is a picture
  RenderCache cache;
  Compositor compositor;
  std::vector<Request> requests;
  std::vector<Sample> samples;
  Frame frame;
  uint64_t tick = 1;

  void step(const View& view, int budget) {
    begin(view);
    cache.plan(view, budget, tick++, requests);
    trace_room(room, requests, samples);
    cache.remember(view, requests, samples);
    compositor.follow_changes(cache);
    compositor.add_samples(view, requests, samples);
    show(view);
  }
  void begin(const View& view) {
    cache.resize(view.width, view.height);
    cache.move_points(place().world);
    cache.project(view);
    cache.attend();
  }
  // Shows a view, at rest from its second picture on.
  void show(const View& view) {
    if (view == shown_) compositor.draw_still(cache, view, place().visibility, frame);
    else compositor.draw(cache, view, place().visibility, frame);
    shown_ = view;
  }
  const World& world() { return place().world; }
  const VisibilityPass& visibility() { return place().visibility; }

 private:
  struct Place {
    Scene scene;
    World world{scene};
    VisibilityPass visibility;
    explicit Place(Scene made)
        : scene(std::move(made)), visibility(commit(world), make_lights(world)) {}
    static const World& commit(World& world) {
      world.commit();
      return world;
    }
  };
  const Place& place() {
    if (!place_) place_ = std::make_unique<Place>(make_room_scene(room));
    return *place_;
  }
  std::unique_ptr<Place> place_;
  View shown_;
};

}  // namespace wellspring::test
