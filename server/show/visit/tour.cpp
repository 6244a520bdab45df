// SPDX-License-Identifier: Apache-2.0
#include "show/visit/tour.h"

#include <algorithm>
#include <cmath>
#include <fmt/core.h>

#include "show/visit/route.h"

namespace wellspring::show {

namespace {

constexpr float pace_seconds = 0.35f;  // seconds of lag with which a ride stops and goes on
constexpr float look_hold = 1.5f,
                look_return = 0.8f;  // seconds until the gaze goes back, and its lag
constexpr float widest_look = 2.1f, steepest = 1.45f;  // radians
constexpr float storyteller_room = 0.35f;              // metres around the storyteller's axis

const Viewpoint& view_of(const Exhibit& exhibit, int viewpoint) {
  return exhibit.viewpoints[size_t(viewpoint)].view;
}

bool is_at(const Viewpoint& a, const Viewpoint& b) {
  return glm::length(a.position - b.position) < 0.02;
}

// Plans the ride's next way, from where it is.
void go_to(TourRide& ride, const Exhibit& exhibit, const TourRoads& roads, int viewpoint,
           float least_seconds) {
  std::string problem;
  const Viewpoint& to = view_of(exhibit, viewpoint);
  ride.path = make_leg(exhibit, roads, ride.view, to, least_seconds, problem);
  ride.time = 0;
  ride.target = viewpoint;
  if (!ride.path) ride.view = to;  // no way leads there: as if the visitor had chosen the place
}

void go_to_stop(TourRide& ride, Voice& narration, const Exhibit& exhibit, const TourRoads& roads) {
  const TourStop& stop = exhibit.tours[size_t(ride.tour)].stops[size_t(ride.stop)];
  const auto& legs = roads.legs[size_t(ride.tour)];
  ride.staying = false;
  ride.stayed = 0;
  ride.wanted.clear();
  auto planned = legs[size_t(ride.stop)];
  Viewpoint first = planned ? eval_camera_path(*planned, 0) : Viewpoint{};
  bool begins_here = planned && is_at(ride.view, first) &&
                     std::abs(std::remainder(ride.view.yaw - first.yaw, 2 * pi)) < 1e-3f;
  if (begins_here) {
    ride.path = planned;
    ride.time = 0;
    ride.target = stop.viewpoint;
  } else {
    go_to(ride, exhibit, roads, stop.viewpoint, stop.travel_seconds);
  }
  say_all(narration, stop.way_text);
}

bool has_arrived(const TourRide& ride) { return !ride.path || ride.time >= ride.path->seconds; }

void ease_look(TourRide& ride, float dt) {
  ride.looked += dt;
  float eagerness = std::clamp((ride.looked - look_hold) / 1.0f, 0.0f, 1.0f);
  float share = 1 - std::exp(-dt * eagerness / look_return);
  vec2 back = ride.look * share;
  float most = CameraLimits{}.turn * dt;
  if (glm::length(back) > most) back *= most / glm::length(back);
  ride.look -= back;
  if (glm::length(ride.look) < 1e-5f) ride.look = vec2(0);
}

Viewpoint with_appearance(const TourRide& ride) {
  Viewpoint view = ride.view;
  view.yaw += ride.look.x;
  view.pitch = std::clamp(view.pitch + ride.look.y, -steepest, steepest);
  return view;
}

}  // namespace

std::shared_ptr<const CameraPath> make_leg(const Exhibit& exhibit, const TourRoads& roads,
                                           const Viewpoint& from, const Viewpoint& to,
                                           float least_seconds, std::string& problem,
                                           const CameraLimits& limits) {
  std::vector<dvec3> eyes{from.position, to.position};
  if (roads.map && glm::length(from.position - to.position) > 1e-3) {
    const dvec3 origin = exhibit.scene.origin;
    Route route = find_route(*roads.map, vec3(from.position - origin), vec3(to.position - origin));
    if (route.points.empty()) {
      problem = route.problem;
      return nullptr;
    }
    // Eyes keep their height above the ground, which changes from one end's to the other's.
    float first = float(from.position.y - origin.y) - route.points.front().y;
    float last = float(to.position.y - origin.y) - route.points.back().y;
    eyes = {from.position};
    for (size_t i = 0; i < route.points.size(); i++) {
      float t = float(i) / float(std::max<size_t>(route.points.size() - 1, 1));
      vec3 p = route.points[i];
      eyes.push_back(origin + dvec3(p.x, p.y + first + (last - first) * t, p.z));
    }
    eyes.push_back(to.position);
  }
  return std::make_shared<CameraPath>(make_camera_path(eyes, from, to, limits, least_seconds));
}

TourRoads make_tour_roads(const Exhibit& exhibit, const World& world,
                          std::vector<Problem>& problems) {
  TourRoads roads;
  const dvec3 origin = exhibit.scene.origin;
  if (exhibit.walk) {
    std::vector<vec3> seeds;
    for (const ExhibitViewpoint& viewpoint : exhibit.viewpoints)
      seeds.push_back(vec3(viewpoint.view.position - origin));
    std::vector<WalkObstacle> obstacles;
    for (const StorytellerPlace& place : exhibit.storytellers)  // any of them may be there
      obstacles.push_back({vec3(place.position - origin), storyteller_room});
    roads.map = make_walk_map(world, *exhibit.walk, seeds, obstacles);
  }
  for (size_t t = 0; t < exhibit.tours.size(); t++) {
    const TourPlan& tour = exhibit.tours[t];
    auto& legs = roads.legs.emplace_back(tour.stops.size());
    for (size_t i = 1; i < tour.stops.size(); i++) {
      std::string problem;
      legs[i] = make_leg(exhibit, roads, view_of(exhibit, tour.stops[i - 1].viewpoint),
                         view_of(exhibit, tour.stops[i].viewpoint), tour.stops[i].travel_seconds,
                         problem);
      if (!legs[i])
        problems.push_back(
            {exhibit.folder + "/exhibit.json", fmt::format("/tours/{}/stops/{}", t, i), problem});
    }
  }
  return roads;
}

void start_tour(TourRide& ride, Voice& narration, int tour, const Exhibit& exhibit,
                const TourRoads& roads, const Viewpoint& from) {
  bool resume = ride.state == TourRide::State::paused && ride.tour == tour;
  if (!resume) {
    stop_tour(ride, narration);
    ride.tour = tour;
    ride.view = from;
    ride.state = TourRide::State::playing;
    go_to_stop(ride, narration, exhibit, roads);
    return;
  }
  ride.state = TourRide::State::playing;
  resume_voice(narration);
  if (is_at(from, ride.view)) {  // the visitor only looked round
    ride.look = {std::remainder(from.yaw - ride.view.yaw, 2 * pi), from.pitch - ride.view.pitch};
    ride.looked = 0;
    return;
  }
  ride.view = from;
  ride.look = vec2(0);
  ride.pace = 0;
  go_to(ride, exhibit, roads, ride.target, 0);
}

void go_on_from_stop(TourRide& ride, Voice& narration, const Exhibit& exhibit,
                     const TourRoads& roads, int stop) {
  hush(narration);
  ride.stop = stop;
  go_to_stop(ride, narration, exhibit, roads);
}

void pause_tour(TourRide& ride, Voice& narration) {
  if (ride.state != TourRide::State::playing) return;
  ride.state = TourRide::State::paused;
  pause_voice(narration);
}

void stop_tour(TourRide& ride, Voice& narration) {
  ride = TourRide{};
  hush(narration);
}

void glide_to(TourRide& ride, int viewpoint, const Viewpoint& from) {
  if (ride.state == TourRide::State::none) {
    ride = TourRide{};
    ride.state = TourRide::State::playing;
    ride.view = from;
  }
  ride.wanted.push_back(viewpoint);
}

void look_round(TourRide& ride, vec2 by) {
  ride.look += by;
  ride.look.x = std::clamp(ride.look.x, -widest_look, widest_look);
  ride.look.y = std::clamp(ride.look.y, -steepest, steepest);
  ride.looked = 0;
}

TourStep advance_tour(TourRide& ride, Voice& narration, const Exhibit& exhibit,
                      const TourRoads& roads, float dt) {
  TourStep step;
  dt = std::clamp(dt, 0.0f, 0.25f);
  bool plays = ride.state == TourRide::State::playing;
  const float goal = plays ? ride.most_pace : 0.0f;
  ride.pace += (goal - ride.pace) * (1 - std::exp(-dt / pace_seconds));
  if (std::abs(ride.pace - goal) < 0.01f) ride.pace = goal;
  if (ride.path) {
    ride.time = ride.leaps ? ride.path->seconds : ride.time + double(dt * ride.pace);
    ride.view = eval_camera_path(*ride.path, ride.time);
  }
  if (plays) ease_look(ride, dt);
  step.view = with_appearance(ride);
  if (!plays || !has_arrived(ride)) return step;

  if (!ride.wanted.empty()) {
    int next = ride.wanted.front();
    ride.wanted.erase(ride.wanted.begin());
    go_to(ride, exhibit, roads, next, 0);
    return step;
  }
  if (ride.tour < 0) {
    step.finished = true;
    return step;
  }
  const TourPlan& tour = exhibit.tours[size_t(ride.tour)];
  const TourStop& stop = tour.stops[size_t(ride.stop)];
  if (!ride.staying) {
    if (!narration.queue.empty()) return step;  // the way's text ends first
    ride.staying = true;
    ride.stayed = 0;
    step.arrived = ride.stop;
    say_all(narration, stop.text);
    return step;
  }
  ride.stayed += dt;
  if (!narration.queue.empty() || ride.stayed < stop.stay_seconds) return step;
  if (++ride.stop < int(tour.stops.size())) go_to_stop(ride, narration, exhibit, roads);
  else step.finished = true;
  return step;
}

}  // namespace wellspring::show
