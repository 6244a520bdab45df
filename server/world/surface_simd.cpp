// SPDX-License-Identifier: Apache-2.0
#include "world/surface_simd.h"

#include <bit>

namespace wellspring::world {
namespace {

static_assert(sizeof(Face) == 2 * sizeof(Lanes), "a face is two rows of eight numbers");

// The lane's number is taken from `bits`.
inline int next_lane(unsigned& bits) {
  int lane = std::countr_zero(bits);
  bits &= bits - 1;
  return lane;
}

}  // namespace

LambertSurfaceLanes eval_lambert_surfaces(const World& world, const Lanes3& direction,
                                          const Hit* hits, unsigned active) {
  static const Face nowhere{};
  LambertSurfaceLanes s;
  const Face* faces[lane_count];
  Face own[lane_count];  // of what is not plain, as flat as it is there
  float color[3][lane_count] = {};
  for (int i = 0; i < lane_count; i++) faces[i] = &nowhere;
  Lanes u{}, v{};
  for (unsigned bits = active; bits;) {
    int i = next_lane(bits);
    const Hit& hit = hits[i];
    const PlacedMesh& placed = world.placed(hit.instance);
    faces[i] = placed.faces ? placed.faces + hit.triangle : &nowhere;
    vec3 base = vec3(placed.material->base_color);
    if (faces[i]->plain == 1) {
      u[i] = hit.barycentric.x, v[i] = hit.barycentric.y;
    } else {
      Ray ray;
      ray.direction = direction.at(i);
      LambertSurface surface = eval_lambert_surface(world, ray, hit);
      own[i] = nowhere;
      own[i].corner = surface.position;
      own[i].extent = surface.extent;
      own[i].normal = surface.geometric_normal;
      faces[i] = &own[i];
      base = surface.base_color;
      s.normal.set(i, surface.normal);
      s.bent |= 1u << i;
    }
    for (int c = 0; c < 3; c++) color[c][i] = base[c];
  }
  Lanes first[lane_count], second[lane_count];
  for (int i = 0; i < lane_count; i++) {
    first[i] = load_lanes(&faces[i]->corner.x);
    second[i] = load_lanes(&faces[i]->edge2.x);
  }
  transpose_lanes(first);
  transpose_lanes(second);
  Lanes3 corner{first[0], first[1], first[2]}, edge1{first[4], first[5], first[6]},
      edge2{second[0], second[1], second[2]}, winding{second[4], second[5], second[6]};
  s.extent = first[3];
  s.position = corner + edge1 * u + edge2 * v;
  s.geometric_normal = choose(dot(winding, direction) <= 0, winding, -winding);
  s.normal = choose(lanes_of_bits(s.bent), s.normal, s.geometric_normal);
  const Lanes zero{};
  s.base_color = {lanes_max(load_lanes(color[0]), zero), lanes_max(load_lanes(color[1]), zero),
                  lanes_max(load_lanes(color[2]), zero)};
  return s;
}

Lanes3 offset_origins(const LambertSurfaceLanes& s, const Lanes3& direction) {
  // offset_origin's constants, and its reasons.
  const Lanes one = all_lanes(1), zero{};
  Lanes small = lanes_min(s.extent, one), unit = s.extent > zero ? small : one;
  Lanes near_zero = unit / 32, near_step = unit / 65536 * small;
  Lanes3 n =
      choose(dot(s.geometric_normal, direction) < zero, -s.geometric_normal, s.geometric_normal);
  auto move = [&](Lanes p, Lanes normal) {
    LaneMask steps = __builtin_convertvector(256 * normal, LaneMask);
    Lanes stepped = Lanes(LaneMask(p) + (p < zero ? -steps : steps));
    return lanes_abs(p) < near_zero ? p + near_step * normal : stepped;
  };
  if (negative_lanes(s.extent < zero)) {  // of a scene: all or none
    Lanes step = lanes_max(-s.extent, zero);
    return s.position + n * step;
  }
  Lanes3 moved{move(s.position.x, n.x), move(s.position.y, n.y), move(s.position.z, n.z)};
  Lanes least = s.extent * 0x1p-20f;
  Lanes short_of = least - dot(moved - s.position, n);
  return moved + n * (short_of > zero ? short_of : zero);
}

}  // namespace wellspring::world
