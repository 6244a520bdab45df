// SPDX-License-Identifier: Apache-2.0
#include "show/visit/place.h"

#include <cmath>

#include "show/visit/walk.h"

namespace wellspring::show {

namespace {
constexpr float ease_seconds = 0.09f;  // how softly a visitor starts and stops
constexpr float level_seconds = 0.4f;  // how softly who walks comes upright
constexpr float least_roll = 0.001f;   // radians
}  // namespace

void stand(VisitorPlace& place) {
  place.glide = {};
  place.closer = -1;
  place.around = {};
}

void go_to_viewpoint(VisitorPlace& place, Voice& narrator, const Exhibit& exhibit, int viewpoint) {
  place.view = exhibit.viewpoints[size_t(viewpoint)].view;
  place.viewpoint = viewpoint;
  place.camera_cuts++;
  place.move = place.velocity = vec3(0);
  stand(place);
  stop_tour(place.tour, narrator);
}

TourStep move_visitor(VisitorPlace& place, Voice& narrator, const World& world,
                      const Exhibit& exhibit, const TourRoads& roads,
                      const std::optional<dvec3>& person, float dt) {
  TourRide& ride = place.tour;
  if (place.around.point >= 0) {
    advance_around(place.view, place.move.z, place.comfort, dt, place.around);
    return {};
  }
  if (glm::length(place.move) > 0) {  // the visitor walks off: the tour waits
    pause_tour(ride, narrator);
    ride.pace = 0;
    stand(place);
  }
  if (place.glide.path) {
    place.view = advance_glide(place.glide, place.comfort, dt);
    place.viewpoint = -1;
    return {};
  }
  ride.leaps = place.comfort;
  bool rides = ride.state == TourRide::State::playing ||
               (ride.state == TourRide::State::paused && ride.pace > 0);
  if (rides) {
    TourStep step = advance_tour(ride, narrator, exhibit, roads, dt);
    place.view = step.view;
    place.viewpoint = -1;
    if (step.finished) stop_tour(ride, narrator);
    return step;
  }
  place.velocity += (place.move - place.velocity) * (1 - std::exp(-dt / ease_seconds));
  if (place.move == vec3(0) && glm::length(place.velocity) < 0.01f) place.velocity = vec3(0);
  if (place.velocity == vec3(0)) return {};
  place.view.roll *= std::exp(-dt / level_seconds);
  if (std::abs(place.view.roll) < least_roll) place.view.roll = 0;
  place.viewpoint = -1;
  dvec3 next = walk(world, exhibit.walk, place.view.position,
                    move_direction(place.velocity, place.view.yaw), dt);
  place.view.position = person ? keep_distance(place.view.position, next, *person) : next;
  return {};
}

}  // namespace wellspring::show
