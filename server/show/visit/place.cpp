// SPDX-License-Identifier: Apache-2.0
#include "show/visit/place.h"

#include <algorithm>
#include <cmath>

#include "cache/plan.h"
#include "picture/keyframe.h"
#include "show/visit/walk_map.h"

namespace wellspring::show {

namespace {
constexpr float ease_seconds = 0.09f;  // seconds of lag with which a visitor starts and stops
constexpr float level_seconds = 0.4f;  // seconds of lag with which a walking visitor comes upright
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

namespace {

constexpr double motion_seconds =
    0.05;  // seconds in which motion is measured: inputs may come thirty times a second
constexpr double longest_gap = 0.5;   // seconds between two views that show motion
constexpr size_t most_past = 32;      // number of views of that time
constexpr float fastest = 25;         // metres a second; more is a jump
constexpr float smallest_cut = 0.5f;  // metres

constexpr float widest_turn = 0.8f;     // radians to either side
constexpr float turned_away = 0.8f;     // radians
constexpr float walked_away = 2;        // metres
constexpr float wide_share = 1 / 8.0f;  // share of the view's pixels

}  // namespace

bool note_view(Heading& heading, double time, const View& view) {
  std::vector<Heading::PastView>& past = heading.past;
  bool cut = false;
  if (!past.empty()) {
    float passed = float(time - past.back().time);
    cut = length(view.position - past.back().view.position) > fastest * passed + smallest_cut;
  }
  auto alike = [&](const Heading::PastView& one) {
    return !cut && time - one.time <= longest_gap && one.view.width == view.width &&
           one.view.height == view.height;
  };
  auto of_use = [&](const Heading::PastView& one) {
    return alike(one) && time - one.time <= motion_seconds;
  };
  auto first = std::find_if(past.begin(), past.end(), of_use);
  // If ticks come late the last view has to do, or there would be no motion.
  if (first == past.end() && !past.empty() && alike(past.back())) first--;
  past.erase(past.begin(), first);
  if (past.size() >= most_past) past.erase(past.begin());
  past.push_back({time, view});
  return cut;
}

View expected_view(const Heading& heading, const View& now, double seconds) {
  // In a quick turn, fewer than all views are enough.
  for (const Heading::PastView& past : heading.past) {
    double passed = heading.past.back().time - past.time;
    if (!(passed > 0)) break;
    View ahead = extrapolate(past.view, now, float(seconds / passed));
    if (ahead != now) return ahead;
  }
  return now;
}

float expected_turn(const Heading& heading, const View& now, double seconds) {
  return std::acos(
      std::clamp(dot(now.forward, expected_view(heading, now, seconds).forward), -1.0f, 1.0f));
}

EyeMotion motion_of(const Heading& heading, const View& now) {
  constexpr float seconds = 0.1f;
  const View ahead = expected_view(heading, now, seconds);
  return {length(ahead.position - now.position) / seconds,
          expected_turn(heading, now, seconds) / seconds};
}

View wide_view(const View& now) {
  View left = now, right = now;
  for (auto [view, turn] : {std::pair(&left, widest_turn), {&right, -widest_turn}}) {
    view->forward = std::cos(turn) * now.forward - std::sin(turn) * now.right;
    view->right = std::cos(turn) * now.right + std::sin(turn) * now.forward;
  }
  const View views[] = {now, left, right};
  return surrounding_view(views, wide_share);
}

bool is_elsewhere(const View& wide, const View& now) {
  return dot(wide.forward, now.forward) < std::cos(turned_away) ||
         length(wide.position - now.position) > walked_away;
}

namespace {

constexpr float fov = 0.7f;                       // radians, of the picture's height
constexpr float filled = 0.8f;                    // share of the picture that the object fills
constexpr float turns = 2;                        // times as far as a head would turn
constexpr float lowest = -1.45f, highest = 0.6f;  // radians of the eye's pitch
constexpr double nearest = 1.15, farthest = 6;    // least and greatest distance, in radii
constexpr double zoom_rate = 0.8;  // change of the logarithm of the distance a second, for 1 m/s
constexpr float way_seconds = 0.9f;
constexpr float turn_seconds = 0.08f;
constexpr double margin = 1.02;  // times the radius: the sphere that is not cut

vec3 forward_of(vec2 look) {
  return {-std::sin(look.x) * std::cos(look.y), std::sin(look.y),
          -std::cos(look.x) * std::cos(look.y)};
}

void find_view(const Viewpoint& from, Around& around) {
  const float t = around.share, share = t * t * (3 - 2 * t);
  const dvec3 eye = around.centre - around.distance * dvec3(forward_of(around.look));
  around.view = from;
  around.view.position = glm::mix(from.position, eye, double(share));
  around.view.yaw = from.yaw + share * std::remainder(around.look.x - from.yaw, 2 * pi);
  around.view.pitch = glm::mix(from.pitch, around.look.y, share);
  around.view.roll = glm::mix(from.roll, 0.0f, share);
  around.view.fov = glm::mix(from.fov, fov, share);
  const double depth = dot(around.centre - around.view.position,
                           dvec3(forward_of({around.view.yaw, around.view.pitch})));
  around.near = share * float(std::max(depth - margin * around.radius, 0.0));
}

}  // namespace

Bounds object_bounds(const World& world, const PointOfInterest& point) {
  Bounds bounds;
  for (uint32_t i = 0; i < uint32_t(world.instance_count()); i++) {
    if (std::ranges::find(point.objects, world.object_of(i)) == point.objects.end()) continue;
    for (const vec3& position : world.mesh_of(i).positions) {
      const vec3 p = vec3(world.to_world(i) * vec4(position, 1));
      bounds.low = min(bounds.low, p), bounds.high = max(bounds.high, p);
    }
  }
  for (const PlacedVolume& placed : world.volumes()) {
    if (std::ranges::find(point.objects, placed.object) == point.objects.end()) continue;
    const Bounds around = bounds_of(placed);
    bounds.low = min(bounds.low, around.low), bounds.high = max(bounds.high, around.high);
  }
  return bounds;
}

void begin_around(const Exhibit& exhibit, int point, const Bounds& bounds, const Viewpoint& from,
                  float aspect, Around& around) {
  around = {};
  around.point = point;
  around.centre = exhibit.scene.origin + dvec3(0.5f * (bounds.low + bounds.high));
  around.radius = std::max(0.5 * double(glm::length(bounds.high - bounds.low)), 1e-3);
  const float across = std::tan(0.5f * fov) * filled * std::min(1.0f, aspect);
  around.distance = around.wanted_distance = around.radius / std::sin(std::atan(double(across)));
  const dvec3 way = around.centre - from.position;
  around.look.x = float(std::atan2(-way.x, -way.z));
  around.look.y = std::clamp(float(std::atan2(way.y, std::hypot(way.x, way.z))), -0.6f, 0.3f);
  around.wanted_look = around.look;
  find_view(from, around);
}

void turn_around(vec2 look, Around& around) {
  around.wanted_look.x -= turns * look.x;
  around.wanted_look.y = std::clamp(around.wanted_look.y - turns * look.y, lowest, highest);
}

void advance_around(const Viewpoint& from, float forward, bool leaps, float dt, Around& around) {
  const float way = leaps ? 1 : dt / way_seconds;
  around.share = std::clamp(around.share + (around.leaves ? -way : way), 0.0f, 1.0f);
  if (around.leaves && around.share <= 0) {
    around = {};
    return;
  }
  around.wanted_distance =
      std::clamp(around.wanted_distance * std::exp(-zoom_rate * double(forward) * double(dt)),
                 nearest * around.radius, farthest * around.radius);
  const float ease = leaps ? 1 : 1 - std::exp(-dt / turn_seconds);
  const vec2 rest = around.wanted_look - around.look;
  const double far = around.wanted_distance - around.distance;
  // The motion comes to an end, so that the picture rests.
  const bool there = glm::length(rest) < 2e-4f && std::abs(far) < 2e-4 * around.distance;
  around.look += there ? rest : ease * rest;
  around.distance += there ? far : double(ease) * far;
  find_view(from, around);
}

}  // namespace wellspring::show
