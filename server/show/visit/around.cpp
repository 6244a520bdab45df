// SPDX-License-Identifier: Apache-2.0
#include "show/visit/around.h"

#include <algorithm>
#include <cmath>

namespace wellspring::show {

namespace {

constexpr float fov = 0.7f;                       // radians, of the picture's height
constexpr float filled = 0.8f;                    // of the picture, by the object
constexpr float turns = 2;                        // as far as a head would
constexpr float lowest = -1.45f, highest = 0.6f;  // radians of the eye's pitch
constexpr double nearest = 1.15, farthest = 6;    // radii
constexpr double zoom_rate = 0.8;                 // of the logarithm of the distance, for 1 m/s
constexpr float way_seconds = 0.9f;
constexpr float turn_seconds = 0.08f;
constexpr double margin = 1.02;  // of the sphere that is not cut

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
  // Comes to an end, so that the picture rests.
  const bool there = glm::length(rest) < 2e-4f && std::abs(far) < 2e-4 * around.distance;
  around.look += there ? rest : ease * rest;
  around.distance += there ? far : double(ease) * far;
  find_view(from, around);
}

}  // namespace wellspring::show
