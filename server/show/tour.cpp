// SPDX-License-Identifier: Apache-2.0
#include "show/tour.h"

#include <algorithm>
#include <cmath>

namespace wellspring {

Viewpoint blend_viewpoints(const Viewpoint& a, const Viewpoint& b, float t) {
  t = std::clamp(t, 0.0f, 1.0f);
  float ease = t * t * t * (t * (6 * t - 15) + 10);
  Viewpoint result = b;
  result.position = a.position + (b.position - a.position) * double(ease);
  result.yaw = a.yaw + std::remainder(b.yaw - a.yaw, 2 * pi) * ease;
  result.pitch = a.pitch + (b.pitch - a.pitch) * ease;
  result.fov = a.fov + (b.fov - a.fov) * ease;
  return result;
}

void start_tour(TourRide& ride, int tour, const Viewpoint& from) {
  bool resume = ride.state == TourRide::State::paused && ride.tour == tour;
  if (!resume) ride = TourRide{};
  if (!resume || !ride.staying) ride.elapsed = 0;
  ride.tour = tour;
  ride.state = TourRide::State::playing;
  ride.from = from;
}

TourStep advance_tour(TourRide& ride, const Exhibit& exhibit, float dt) {
  TourStep step;
  const TourPlan& tour = exhibit.tours[size_t(ride.tour)];
  const TourStop& stop = tour.stops[size_t(ride.stop)];
  const Viewpoint& there = exhibit.viewpoints[size_t(stop.viewpoint)].view;
  step.view = ride.staying ? there
                           : blend_viewpoints(ride.from, there, stop.travel_seconds > 0
                                                                    ? ride.elapsed / stop.travel_seconds : 1);
  if (ride.state != TourRide::State::playing) return step;
  ride.elapsed += std::max(dt, 0.0f);
  if (!ride.staying) {
    float t = stop.travel_seconds > 0 ? ride.elapsed / stop.travel_seconds : 1;
    step.view = blend_viewpoints(ride.from, there, t);
    if (t >= 1) {
      ride.staying = true;
      ride.elapsed = 0;
      step.arrived = ride.stop;
    }
  } else if (ride.elapsed >= stop.stay_seconds) {
    ride.elapsed = 0;
    ride.staying = false;
    ride.from = there;
    if (++ride.stop >= int(tour.stops.size())) {
      ride = TourRide{};
      step.finished = true;
    }
  }
  return step;
}

}  // namespace wellspring
