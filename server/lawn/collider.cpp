// SPDX-License-Identifier: Apache-2.0
#include "lawn/collider.h"

#include <algorithm>
#include <cmath>

namespace wellspring::lawn {
namespace {

LaneMask push_out_of_capsule(const Collider& collider, const LaneMask& lanes, Lanes3& v) {
  const vec3 a = collider.capsule.a, line = collider.capsule.b - a;
  const float length2 = dot(line, line), radius = collider.capsule.radius;
  const Lanes3 from = v - all_lanes(a);
  Lanes3 off = from;
  if (length2 > 0) {
    const Lanes share = dot(from, all_lanes(line)) * (1 / length2);
    off = off - all_lanes(line) * lanes_max(lanes_min(share, all_lanes(1)), Lanes{});
  }
  const Lanes distance = lanes_sqrt(dot(off, off));
  const LaneMask inside = lanes & (distance < radius);
  if (!any_lane(inside)) return inside;
  // On the line itself any way across it leads out.
  vec3 across = glm::cross(
      line, std::abs(line.y) > 0.9f * std::sqrt(length2) ? vec3(1, 0, 0) : vec3(0, 1, 0));
  across = dot(across, across) > 0 ? normalize(across) : vec3(1, 0, 0);
  const LaneMask has_way = distance > 1e-6f * radius;
  const Lanes3 normal =
      choose(has_way, off * (1.0f / (has_way ? distance : all_lanes(1))), all_lanes(across));
  v = choose(inside, v + normal * (radius + collider.margin - distance), v);
  return inside;
}

LaneMask push_out_of_cube(const Collider& collider, const LaneMask& lanes, Lanes3& v) {
  constexpr int tries = 4;
  const mat3 back = transpose(collider.turn);
  // Places outside of the mesh's box are outside of the mesh.
  const Lanes3 from = v - all_lanes(collider.place);
  const vec3 middle = collider.cube->middle(), half = collider.cube->half_size();
  LaneMask near = lanes;
  for (int axis = 0; axis < 3; axis++)
    near &= lanes_abs(dot(from, all_lanes(collider.turn[axis])) - middle[axis]) <=
            half[axis] + collider.margin;
  LaneMask inside{};
  for (unsigned left = negative_lanes(near); left != 0; left &= left - 1) {
    const int lane = __builtin_ctz(left);
    vec3 p = back * (v.at(lane) - collider.place);
    DepthCube::Depth depth = collider.cube->at(p);
    if (!(depth.distance < 0)) continue;
    inside[lane] = -1;
    for (int i = 0; depth.distance < 0; i++) {
      p += (collider.margin - depth.distance) * (i < tries ? depth.normal : depth.axis);
      depth = collider.cube->at(p);
    }
    v.set(lane, collider.turn * p + collider.place);
  }
  return inside;
}

}  // namespace

std::vector<Collider> find_colliders(const Walkers& walkers) {
  constexpr float most = 1e7f;  // metres
  std::vector<Collider> found;
  const auto is_place = [](vec3 p) { return is_finite(p) && max_component(abs(p)) < most; };
  const auto margin_of = [](float size, vec3 p) {
    return 1e-4f + 1e-6f * (size + max_component(abs(p)));
  };
  for (const Capsule& c : walkers.capsules) {
    if (!is_place(c.a) || !is_place(c.b) || !(c.radius > 0 && c.radius < most)) continue;
    Collider& put = found.emplace_back();
    put.capsule = c;
    put.low = min(c.a, c.b) - c.radius, put.high = max(c.a, c.b) + c.radius;
    put.margin = margin_of(c.radius, max(abs(c.a), abs(c.b)));
  }
  for (const PlacedCube& c : walkers.cubes) {
    if (!c.cube) continue;
    const vec3 half = c.cube->half_size();
    const float size = max_component(half);
    if (!(size > 0 && size < most)) continue;
    const vec3 middle = c.turn * c.cube->middle() + c.place;
    if (!is_place(middle) || !is_place(c.place)) continue;
    const mat3 unit = transpose(c.turn) * c.turn - mat3(1);
    const float off = max_component(abs(unit[0]) + abs(unit[1]) + abs(unit[2]));
    if (!(off < 1e-3f)) continue;  // it is no rotation
    Collider& put = found.emplace_back();
    put.cube = c.cube, put.place = c.place, put.turn = c.turn;
    const vec3 reach = abs(c.turn[0]) * half.x + abs(c.turn[1]) * half.y + abs(c.turn[2]) * half.z;
    put.low = middle - reach, put.high = middle + reach;
    put.margin = margin_of(size, middle);
  }
  return found;
}

float distance_to(const Collider& collider, vec3 v) {
  if (collider.cube)
    return collider.cube->at(transpose(collider.turn) * (v - collider.place)).distance;
  const vec3 line = collider.capsule.b - collider.capsule.a, from = v - collider.capsule.a;
  const float length2 = dot(line, line);
  const float share = length2 > 0 ? std::clamp(dot(from, line) / length2, 0.0f, 1.0f) : 0;
  return glm::length(from - share * line) - collider.capsule.radius;
}

LaneMask push_out(const Collider& collider, const LaneMask& lanes, Lanes3& v) {
  return collider.cube ? push_out_of_cube(collider, lanes, v)
                       : push_out_of_capsule(collider, lanes, v);
}

}  // namespace wellspring::lawn
