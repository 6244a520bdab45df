// SPDX-License-Identifier: Apache-2.0
// Guides the camera on a tour: it goes from stop to stop on smooth ways around what stands there,
// while a narrator speaks; it goes on when a stop's text has ended. A ride is a value advanced by
// time. It can be paused and played on at any time, and the visitor may look round while it goes.
#pragma once
#include <memory>

#include "show/exhibit/exhibit.h"
#include "show/exhibit/json_fields.h"
#include "show/storyteller/voice.h"
#include "show/visit/camera_path.h"
#include "show/visit/walk_map.h"

namespace wellspring::show {

// Holds what tours of an exhibit need, made once: where one can walk, and the ways between stops.
struct TourRoads {
  std::optional<WalkMap> map;  // none: the exhibit's visitors fly
  // [tour][stop]: way to that stop from the one before.
  std::vector<std::vector<std::shared_ptr<const CameraPath>>> legs;
};

// Makes the ways. A way that cannot be gone is a fatal problem, with its stop and where it ends. If
// visitors fly (no walk rules), ways are straight.
TourRoads make_tour_roads(const Exhibit& exhibit, const World& world,
                          std::vector<Problem>& problems);
// Returns the way between two views; null with `problem` set when there is none.
std::shared_ptr<const CameraPath> make_leg(const Exhibit& exhibit, const TourRoads& roads,
                                           const Viewpoint& from, const Viewpoint& to,
                                           float least_seconds, std::string& problem,
                                           const CameraLimits& limits = {});

struct TourRide {
  enum class State : uint8_t { none, playing, paused } state = State::none;
  int tour = -1;         // -1 with a state: a story's camera, no tour
  int stop = 0;          // index of the stop that it travels to or stays at
  bool staying = false;  // the stop is reached, and its text has begun
  int target = 0;        // viewpoint that `path` leads to
  std::shared_ptr<const CameraPath> path;
  double time = 0;  // seconds on the path
  // share of the path's own speed, 0 to 1: eased when paused, played on and slowed down
  float pace = 0;
  bool leaps = false;       // it leaps to the end of every way
  float most_pace = 1;      // 0 to 1, the largest `pace`, so that pictures follow its turns
  float stayed = 0;         // seconds since the stop was reached
  Viewpoint view;           // the tour's camera, the visitor's own looking round left out
  vec2 look{0};             // the visitor's looking round: yaw, pitch
  float looked = 0;         // seconds since the visitor last looked round
  std::vector<int> wanted;  // viewpoints that marks of the text ask for, next first
};

struct TourStep {
  Viewpoint view;    // the visitor's view now
  int arrived = -1;  // stop reached in this step, if any
  bool finished = false;
};

// Starts from `from`, or plays on: from where it was paused, or, when the visitor has walked off,
// from where they are. A stop that no way leads to from there is jumped to.
void start_tour(TourRide& ride, Voice& narration, int tour, const Exhibit& exhibit,
                const TourRoads& roads, const Viewpoint& from);
// Goes on with a stop that need not be the next one, from where the ride is.
void go_on_from_stop(TourRide& ride, Voice& narration, const Exhibit& exhibit,
                     const TourRoads& roads, int stop);
void pause_tour(TourRide& ride, Voice& narration);
void stop_tour(TourRide& ride, Voice& narration);
// Makes the camera go to a viewpoint as soon as it rests; from `from` when no ride is under way.
void glide_to(TourRide& ride, int viewpoint, const Viewpoint& from);
void look_round(TourRide& ride, vec2 by);

// Moves on by `dt` seconds, 0 to 0.25; longer steps are cut. Adds to the narrator's queue.
TourStep advance_tour(TourRide& ride, Voice& narration, const Exhibit& exhibit,
                      const TourRoads& roads, float dt);

}  // namespace wellspring::show
