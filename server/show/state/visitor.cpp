// SPDX-License-Identifier: Apache-2.0
#include "show/state/visitor.h"

#include <cmath>

#include "base/memory.h"
#include "show/visit/walk.h"

namespace wellspring {

namespace {
constexpr float ease_seconds = 0.09f;  // how softly a visitor starts and stops
}

size_t picture_memory(const Visitor& visitor) {
  return visitor.cache.memory_bytes() + visitor.compositor.memory_bytes() +
         visitor.broker.memory_bytes() +
         memory_bytes(visitor.keyframe) + memory_bytes(visitor.around) +
         memory_bytes(visitor.moving) +
         bytes_of(visitor.picture.rgb, visitor.fade.from.rgb) + visitor.encoder->memory_bytes;
}

void go_to_viewpoint(Visitor& visitor, const Exhibit& exhibit, int viewpoint) {
  visitor.view = exhibit.viewpoints[size_t(viewpoint)].view;
  visitor.viewpoint = viewpoint;
  visitor.leaps++;
  visitor.move = visitor.velocity = vec3(0);
  stop_tour(visitor.tour, visitor.narration.voice);
}

void move_visitor(Visitor& visitor, const World& world, const Exhibit& exhibit,
                  const TourRoads& roads, const std::optional<dvec3>& person, float dt,
                  TourStep& tour_step) {
  tour_step = TourStep{};
  TourRide& ride = visitor.tour;
  if (glm::length(visitor.move) > 0) {  // the visitor walks off: the tour waits
    pause_tour(ride, visitor.narration.voice);
    ride.pace = 0;
  }
  bool rides = ride.state == TourRide::State::playing ||
               (ride.state == TourRide::State::paused && ride.pace > 0);
  if (rides) {
    tour_step = advance_tour(ride, visitor.narration.voice, exhibit, roads, dt);
    visitor.view = tour_step.view;
    visitor.viewpoint = -1;
    if (tour_step.finished) stop_tour(ride, visitor.narration.voice);
    return;
  }
  visitor.velocity += (visitor.move - visitor.velocity) * (1 - std::exp(-dt / ease_seconds));
  if (visitor.move == vec3(0) && glm::length(visitor.velocity) < 0.01f) visitor.velocity = vec3(0);
  if (visitor.velocity == vec3(0)) return;
  visitor.viewpoint = -1;
  dvec3 next = walk(world, exhibit.walk, visitor.view.position,
                    move_direction(visitor.velocity, visitor.view.yaw), dt);
  visitor.view.position = person ? keep_distance(visitor.view.position, next, *person) : next;
}

}  // namespace wellspring
