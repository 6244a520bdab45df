// SPDX-License-Identifier: Apache-2.0
#include "show/answer/go.h"

#include <algorithm>
#include <cmath>

#include "show/answer/events.h"
#include "show/answer/groups.h"
#include "show/state/in_view.h"
#include "show/visit/good_view.h"
#include "show/visit/route.h"

namespace wellspring::show {

namespace {

using Answer = std::optional<WireError>;

constexpr double least_way = 0.3;      // metres: shorter ones are no way
constexpr double flown_short = 1.2;    // metres before what is pointed at, where visitors fly
constexpr float steepest_gaze = 0.2f;  // radians: who walks looks ahead

const WireError no_way{"no_way", "there is no way to that place"};

// Breaks off whatever the visitor is on.
void halt(Visitor& visitor, const GoTo& order) {
  VisitorPlace& place = visitor.place;
  go_away(visitor);
  pause_tour(place.tour, visitor.hearing.narration.voice);
  place.tour.pace = 0;
  place.seq = order.seq;
  place.move = place.velocity = vec3(0);
  stand(place);
}

// Sets out for a view, or leaps there; `point`: what is looked at closer, -1: nothing.
void set_out(const ExhibitStage& stage, Visitor& visitor, const GoTo& order, const Viewpoint& to,
             int point) {
  VisitorPlace& place = visitor.place;
  std::string problem;
  halt(visitor, order);
  auto path = make_leg(stage.exhibit, stage.roads, place.view, to, 0, problem, glide_limits);
  place.viewpoint = -1;
  place.closer = point;
  const bool leaps = place.comfort || !path;  // who stands where nobody can walks from nowhere
  if (leaps) place.view = to;
  else place.glide.path = path;
  if (leaps) place.camera_cuts++;
  const std::string object = point < 0 ? "" : stage.exhibit.points[size_t(point)].id;
  visitor.link->send_text(went_message(order.seq, object, to.position, leaps ? 0 : path->seconds));
  visitor.state_sent_at = -1e9;
}

// The view of one who has walked to `ground`: on in the same direction.
Viewpoint view_at(const ExhibitStage& stage, const Viewpoint& from, dvec3 eye) {
  Viewpoint to = from;
  to.position = eye;
  to.yaw = float(std::atan2(from.position.x - eye.x, from.position.z - eye.z));
  to.pitch = std::clamp(from.pitch, -steepest_gaze, steepest_gaze);
  to.roll = 0;
  to.fov = stage.exhibit.viewpoints[size_t(stage.exhibit.start)].view.fov;
  return to;
}

// `ground`: relative to the scene's origin.
Answer go_to_ground(const ExhibitStage& stage, Visitor& visitor, const GoTo& order, vec3 ground) {
  const Viewpoint& from = visitor.place.view;
  const dvec3 origin = stage.exhibit.scene.origin;
  dvec3 eye;
  if (!stage.roads.map) {  // visitors fly: towards it, at their height
    eye = origin + dvec3(ground);
    eye.y = from.position.y;
    const dvec3 way = eye - from.position;
    if (glm::length(way) < flown_short + least_way) return no_way;
    eye -= way * (flown_short / glm::length(way));
  } else {
    const WalkMap& map = *stage.roads.map;
    const int place = nearest_of(map, reachable_places(map, vec3(from.position - origin)), ground);
    if (place < 0) return no_way;
    vec3 foot = map.places[size_t(place)].ground;
    if (clear_at(map, ground) >= map.radius) foot = ground;  // not where the grid has a place
    eye = origin + dvec3(foot + vec3(0, map.eye_height, 0));
  }
  const dvec3 way = eye - from.position;
  if (std::hypot(way.x, way.z) < least_way) return no_way;
  set_out(stage, visitor, order, view_at(stage, from, eye), -1);
  return {};
}

Answer look_closer(const ExhibitStage& stage, Visitor& visitor, const GoTo& order, int point,
                   std::optional<vec3> near) {
  const Viewpoint& from = visitor.place.view;
  const PictureWishes& wants = visitor.wants;
  Viewpoint to = from;
  if (stage.roads.map) {
    const WalkMap& map = *stage.roads.map;
    const vec3 eye = vec3(from.position - stage.exhibit.scene.origin);
    const float fov = stage.exhibit.viewpoints[size_t(stage.exhibit.start)].view.fov;
    auto view = good_view(stage.exhibit, *stage.world, map, reachable_places(map, eye), point, near,
                          from, float(wants.width) / float(wants.height), fov);
    if (view) to = *view;
    else return WireError{"no_way", "there is no place from which it can be seen"};
  } else {  // visitors fly: they turn to it
    const dvec3 way = stage.exhibit.points[size_t(point)].place - from.position;
    to.yaw = float(std::atan2(-way.x, -way.z));
    to.pitch = float(std::atan2(way.y, std::hypot(way.x, way.z)));
  }
  set_out(stage, visitor, order, to, point);
  return {};
}

// Lifts it out of its place; the visitor stays.
Answer look_around(const ExhibitStage& stage, Visitor& visitor, const GoTo& order,
                   const PointOfInterest& point) {
  if (!point.around)
    return WireError{"no_way", "the exhibit does not show '" + point.id + "' from all sides"};
  const Bounds bounds = object_bounds(*stage.world, point);
  if (bounds.low.x > bounds.high.x)
    return WireError{"no_way", "nothing is to be seen of '" + point.id + "'"};
  VisitorPlace& place = visitor.place;
  halt(visitor, order);
  place.closer = int(&point - stage.exhibit.points.data());
  begin_around(stage.exhibit, place.closer, bounds, place.view,
               float(visitor.wants.width) / float(visitor.wants.height), place.around);
  visitor.state_sent_at = -1e9;
  return {};
}

Answer put_back(Visitor& visitor, const GoTo& order) {
  visitor.place.seq = order.seq;
  visitor.place.move = vec3(0);
  visitor.place.around.leaves = true;
  visitor.state_sent_at = -1e9;
  return {};
}

}  // namespace

std::optional<WireError> go(Show& show, Visitor& visitor, const GoTo& order) {
  if (int(order.at.has_value()) + int(order.to.has_value()) + int(!order.object.empty()) != 1)
    return WireError{"bad_field", "go: takes one of at, to and object"};
  if (order.around && order.object.empty())
    return WireError{"bad_field", "go.around: is about an object"};
  if (!order.object.empty()) {
    const PointOfInterest* point = find_point(show.stage.exhibit, order.object);
    if (!point) return WireError{"unknown_object", "there is no object '" + order.object + "'"};
    Around& around = visitor.place.around;
    const bool same = around.point == int(point - show.stage.exhibit.points.data());
    if (order.around) return look_around(show.stage, visitor, order, *point);
    if (same) return put_back(visitor, order);
    return look_closer(show.stage, visitor, order, int(point - show.stage.exhibit.points.data()),
                       {});
  }
  if (order.to)
    return go_to_ground(show.stage, visitor, order,
                        vec3(*order.to - show.stage.exhibit.scene.origin));
  // In the picture that the visitor was sent last.
  const View view = visitor.shown.frame_number > 0 ? visitor.shown.view : view_of(show, visitor);
  const auto pointed = point_at(show.stage.exhibit, *show.stage.world, view, *order.at);
  if (!pointed) return WireError{"nothing_there", "there is nothing at that place"};
  if (pointed->point >= 0) touch_object(show, visitor, pointed->point);
  if (pointed->point >= 0)
    return look_closer(show.stage, visitor, order, pointed->point, pointed->place);
  return go_to_ground(show.stage, visitor, order, pointed->ground);
}

}  // namespace wellspring::show
