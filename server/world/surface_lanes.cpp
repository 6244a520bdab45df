// SPDX-License-Identifier: Apache-2.0
#include "world/surface_lanes.h"

#include <bit>

namespace wellspring {
namespace {

static_assert(sizeof(Face) == 2 * sizeof(Lanes), "a face is two rows of eight numbers");

// The lane's number is taken from `bits`.
inline int next_lane(unsigned& bits) {
  int lane = std::countr_zero(bits);
  bits &= bits - 1;
  return lane;
}

// Alike all over: nothing but the face and the material's colour is needed.
inline bool is_plain(const PlacedMesh& placed, const Face& face) {
  return face.flat == 1 && placed.material->base_color_texture.texture < 0 &&
         placed.mesh->colors.empty() && face.normal != vec3(0);
}

}  // namespace

MattSurfaceLanes eval_matt_surfaces(const World& world, const Lanes3& direction, const Hit* hits,
                                    unsigned active) {
  MattSurfaceLanes s;
  Lanes first[lane_count] = {}, second[lane_count] = {}, u{}, v{};
  alignas(Lanes) float color[3][lane_count] = {};
  MattSurface detailed[lane_count];
  unsigned plain = 0;
  for (unsigned bits = active; bits;) {
    int i = next_lane(bits);
    const Hit& hit = hits[i];
    const PlacedMesh& placed = world.placed(hit.instance);
    const Face* face = placed.faces ? placed.faces + hit.triangle : nullptr;
    if (face && is_plain(placed, *face)) {
      plain |= 1u << i;
      first[i] = load_lanes(&face->corner.x);
      second[i] = load_lanes(&face->edge2.x);
      for (int c = 0; c < 3; c++) color[c][i] = placed.material->base_color[c];
      u[i] = hit.barycentric.x, v[i] = hit.barycentric.y;
    } else {
      Ray ray;
      ray.direction = direction.at(i);
      detailed[i] = eval_matt_surface(world, ray, hit);
    }
  }
  transpose_lanes(first);
  transpose_lanes(second);
  Lanes3 corner{first[0], first[1], first[2]}, edge1{first[4], first[5], first[6]},
      edge2{second[0], second[1], second[2]}, winding{second[4], second[5], second[6]};
  s.extent = first[3];
  s.position = corner + edge1 * u + edge2 * v;
  s.geometric_normal = choose(dot(winding, direction) <= 0, winding, -winding);
  s.normal = s.geometric_normal;
  for (int c = 0; c < 3; c++)
    (c == 0 ? s.base_color.x : c == 1 ? s.base_color.y : s.base_color.z) =
        lanes_max(load_lanes(color[c]), Lanes{});
  s.bent = active & ~plain;
  for (unsigned bits = s.bent; bits;) {
    int i = next_lane(bits);
    s.position.set(i, detailed[i].position);
    s.geometric_normal.set(i, detailed[i].geometric_normal);
    s.normal.set(i, detailed[i].normal);
    s.base_color.set(i, detailed[i].base_color);
    s.extent[i] = detailed[i].extent;
  }
  return s;
}

Lanes3 offset_origins(const MattSurfaceLanes& s, const Lanes3& direction) {
  // offset_origin's constants, and its reasons.
  const Lanes one = all_lanes(1), zero{};
  Lanes small = lanes_min(s.extent, one), unit = s.extent > zero ? small : one;
  Lanes near_zero = unit / 32, near_step = unit / 65536 * small;
  Lanes3 n = choose(dot(s.geometric_normal, direction) < zero, -s.geometric_normal,
                    s.geometric_normal);
  auto move = [&](Lanes p, Lanes normal) {
    LaneMask steps = __builtin_convertvector(256 * normal, LaneMask);
    Lanes stepped = Lanes(LaneMask(p) + (p < zero ? -steps : steps));
    return lanes_abs(p) < near_zero ? p + near_step * normal : stepped;
  };
  Lanes3 moved{move(s.position.x, n.x), move(s.position.y, n.y), move(s.position.z, n.z)};
  Lanes least = s.extent * 0x1p-20f;
  Lanes short_of = least - dot(moved - s.position, n);
  return moved + n * (short_of > zero ? short_of : zero);
}

}  // namespace wellspring
