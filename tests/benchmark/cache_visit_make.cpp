// SPDX-License-Identifier: Apache-2.0
// How the castle's traces come about; see cache_visit_trace.h.
#include <cmath>

#include "cache_visit_trace.h"
#include "show/visit/place.h"
#include "show/visit/tour.h"
#include "show/visit/walk_map.h"

namespace wellspring::test {
namespace {

constexpr int rate = 60, keep_every = 2;  // steps a second; 30 samples a second are kept

// The view from `eye` towards `target`.
void look_at(Viewpoint& view, dvec3 target) {
  dvec3 to = target - view.position;
  double yaw = std::atan2(-to.x, -to.z);
  view.yaw += float(std::remainder(yaw - view.yaw, 2 * double(pi)));  // turns count on
  view.pitch = float(std::atan2(to.y, std::hypot(to.x, to.z)));
}

// Eased from 0 to 1 as t runs from 0 to 1.
double ease(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

const Viewpoint& viewpoint(const Exhibit& exhibit, const char* name) {
  int found = find_viewpoint(exhibit, name);
  if (found < 0) throw std::invalid_argument(std::string("the exhibit has no viewpoint ") + name);
  return exhibit.viewpoints[size_t(found)].view;
}

// Calls step(time, view) `seconds` * rate times and keeps what it makes of the view.
template <class Step>
VisitTrace record(const char* name, const char* about, double seconds, Viewpoint view, Step step) {
  VisitTrace trace;
  trace.name = name;
  trace.about = about;
  trace.exhibit = "castle";
  int count = int(std::lround(seconds * rate));
  for (int i = 0; i <= count; i++) {
    double time = double(i) / rate;
    step(time, view);
    if (i % keep_every == 0)
      trace.samples.push_back({time, view.position, view.yaw, view.pitch, view.fov});
  }
  return trace;
}

// A walk by the show's rules: `intend(time, visitor)` sets what the visitor's keys and mouse do.
template <class Intend>
VisitTrace walk_through(const char* name, const char* about, const Exhibit& exhibit,
                        const World& world, double seconds, const Viewpoint& from, Intend intend) {
  VisitorPlace visitor;
  Voice narrator;
  visitor.view = from;
  return record(name, about, seconds, from, [&](double time, Viewpoint& view) {
    intend(time, visitor);
    move_visitor(visitor, narrator, world, exhibit, TourRoads{}, std::nullopt,
                 time == 0 ? 0 : 1.0f / rate);
    view = visitor.view;
  });
}

VisitTrace make_stroll(const Exhibit& castle, const World& world) {
  Viewpoint from = viewpoint(castle, "hall");
  return walk_through("stroll", "walks down the hall at 1.4 m/s and looks about", castle, world, 6,
                      from, [&](double time, VisitorPlace& visitor) {
                        visitor.move = {0, 0, castle.walk ? castle.walk->speed : 1.4f};
                        visitor.view.yaw = from.yaw + 0.35f * float(std::sin(1.3 * time));
                        visitor.view.pitch = from.pitch + 0.06f * float(std::sin(0.9 * time));
                      });
}

VisitTrace make_pauses(const Exhibit& castle, const World& world) {
  Viewpoint from = viewpoint(castle, "hall");
  return walk_through(
      "pauses", "walks down the hall, stops twice for a second and a half to look at something",
      castle, world, 5.5, from, [&](double time, VisitorPlace& visitor) {
        bool walks = std::fmod(time, 2.75) < 1.25;
        visitor.move = {0, 0, walks ? 1.4f : 0.0f};
        visitor.view.yaw = from.yaw + 0.3f * float(std::sin(std::min(time, 1.4)) +
                                                   std::sin(std::clamp(time - 2.75, 0.0, 1.4)));
      });
}

VisitTrace make_turn(const Exhibit& castle) {
  Viewpoint from = viewpoint(castle, "hall");
  from.position = {0.5, from.position.y, 0.4};
  return record("turn", "stands still, then turns once about in 3 s", 4.5, from,
                [&](double time, Viewpoint& view) {
                  view.yaw = from.yaw + 2 * pi * float(ease((time - 0.5) / 3));
                });
}

VisitTrace make_approach(const Exhibit& castle, const World& world) {
  const dvec3 crown{-1.4, 1.2, -0.9};
  Viewpoint from = viewpoint(castle, "hall");
  from.position = {3.4, from.position.y, -0.3};
  look_at(from, crown);
  return walk_through("approach", "walks up to the crown in its case and leans closer", castle,
                      world, 5.5, from, [&](double time, VisitorPlace& visitor) {
                        double away = glm::length(crown - visitor.view.position);
                        float speed = float(std::clamp(1.6 * (away - 0.95), 0.0, 1.2));
                        visitor.move = {0, 0, speed};
                        look_at(visitor.view, crown);
                        visitor.view.fov = from.fov - 0.35f * float(ease((time - 3.5) / 1.5));
                      });
}

VisitTrace make_door(Exhibit castle, const World& world) {
  Viewpoint from = viewpoint(castle, "well");
  from.position.x = -3.6;
  if (castle.walk) castle.walk->bounds.reset();  // beyond the rope the courtyard goes on
  return walk_through("door", "walks from the hall through the gate into the sunlit courtyard",
                      castle, world, 6, from, [&](double time, VisitorPlace& visitor) {
                        visitor.move = {0, 0, 1.4f};
                        visitor.view.yaw = from.yaw + 0.5f * float(ease((time - 4) / 1.5));
                      });
}

VisitTrace make_orbit(const Exhibit& castle) {
  const dvec3 horse{-4.5, 1.6, 2.1};
  constexpr double radius = 2.3;
  return record("orbit", "circles the bronze horse at 2.3 m, eyes on it", 6,
                viewpoint(castle, "figure"), [&](double time, Viewpoint& view) {
                  double angle = 1.75 - 2.9 * ease(time / 6);  // from +Z towards +X
                  view.position =
                      horse + dvec3(radius * std::sin(angle), 0.05, -radius * std::cos(angle));
                  look_at(view, horse);
                });
}

VisitTrace make_tour(const Exhibit& castle, const World& world) {
  std::vector<Problem> problems;
  TourRoads roads = make_tour_roads(castle, world, problems);
  TourRide ride;
  Voice narration;
  Viewpoint from = viewpoint(castle, "paintings");
  glide_to(ride, find_viewpoint(castle, "crown"), from);
  return record(
      "tour", "the guided tour from the paintings to the crown, and a rest there", 7.5, from,
      [&](double time, Viewpoint& view) {
        float before = view.yaw;
        view = advance_tour(ride, narration, castle, roads, time == 0 ? 0 : 1.0f / rate).view;
        view.yaw = before + std::remainder(view.yaw - before, 2 * pi);
      });
}

// Between two viewpoints there is no way: the samples before and after lie less than a picture
// apart.
VisitTrace make_jump(const Exhibit& castle) {
  constexpr double stay = 1.2, camera_cut = 0.001;
  VisitTrace trace;
  trace.name = "jump";
  trace.about = "asks for one viewpoint after the other";
  trace.exhibit = "castle";
  double time = 0;
  for (const char* name : {"hall", "crown", "paintings", "well", "fireplace", "windows"}) {
    const Viewpoint& at = viewpoint(castle, name);
    for (double t : {time, time + stay - camera_cut})
      trace.samples.push_back({t, at.position, at.yaw, at.pitch, at.fov});
    time += stay;
  }
  return trace;
}

VisitTrace make_storyteller(const Exhibit& castle) {
  VisitTrace trace = record("storyteller", "stands before the storyteller, who tells a story", 5,
                            viewpoint(castle, "storyteller"), [](double, Viewpoint&) {});
  trace.telling = true;
  return trace;
}

VisitTrace make_lamps(const Exhibit& castle) {
  VisitTrace trace = record("lights", "looks at the paintings; all lamps go off and on again", 5,
                            viewpoint(castle, "paintings"), [](double, Viewpoint&) {});
  trace.lamps = {{1.5, false}, {3.25, true}};
  return trace;
}

}  // namespace

void make_visit_traces(const Exhibit& castle, const World& world, const std::string& folder) {
  for (const VisitTrace& trace :
       {make_stroll(castle, world), make_pauses(castle, world), make_turn(castle),
        make_approach(castle, world), make_door(castle, world), make_orbit(castle),
        make_tour(castle, world), make_storyteller(castle), make_lamps(castle), make_jump(castle)})
    save_visit_trace(trace, folder);
}

}  // namespace wellspring::test
