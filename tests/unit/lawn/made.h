// SPDX-License-Identifier: Apache-2.0
// Lawns, meshes and walkers for tests.
#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "lawn/response.h"

namespace wellspring::test {

inline LawnDescription small_meadow() {
  LawnDescription description;
  description.low = {-2, -2}, description.high = {2, 2};
  description.density = 400;
  return description;
}

struct MadeMesh {
  std::vector<vec3> places;
  std::vector<uvec3> triangles;
};

// Makes a sphere around the origin of rings and sectors.
inline MadeMesh made_sphere(float radius, int rings = 128) {
  MadeMesh mesh;
  const int sectors = 2 * rings;
  for (int i = 0; i <= rings; i++)
    for (int k = 0; k < sectors; k++) {
      const float polar = pi * float(i) / float(rings), turn = 2 * pi * float(k) / float(sectors);
      mesh.places.push_back(radius * vec3(std::sin(polar) * std::cos(turn), std::cos(polar),
                                          std::sin(polar) * std::sin(turn)));
    }
  const auto at = [&](int i, int k) { return uint32_t(i * sectors + k % sectors); };
  for (int i = 0; i < rings; i++)
    for (int k = 0; k < sectors; k++) {
      mesh.triangles.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
      mesh.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
    }
  return mesh;
}

inline void add_box(MadeMesh& mesh, vec3 low, vec3 high) {
  const uint32_t first = uint32_t(mesh.places.size());
  for (int i = 0; i < 8; i++)
    mesh.places.push_back({i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z});
  for (int axis = 0; axis < 3; axis++)
    for (int end = 0; end < 2; end++) {
      const uint32_t a = 1u << axis, b = 1u << (axis + 1) % 3, c = 1u << (axis + 2) % 3;
      const uint32_t from = first + (end ? a : 0);
      mesh.triangles.push_back({from, from + b, from + b + c});
      mesh.triangles.push_back({from, from + b + c, from + c});
    }
}

// Calls body(tile, blade of the lawn, shapes, lane) for every blade.
template <class Body>
void for_blades(const Lawn& lawn, const LawnState& state, const Wind& wind, const Body& body) {
  const WindNow now(wind, state.time);
  for (int t = 0; t < int(lawn.tile.size()); t++) {
    const LawnTile& tile = lawn.tile[size_t(t)];
    for (int i = 0; i < tile.count; i += lane_count) {
      const BladeShapes shapes = eval_shapes(lawn, state, now, t, tile.begin + i);
      for (int lane = 0; lane < std::min(lane_count, tile.count - i); lane++)
        body(t, tile.begin + i + lane, shapes, lane);
    }
  }
}

// Returns all joints of all blades, tile by tile.
inline std::vector<vec3> all_joints(const Lawn& lawn, const LawnState& state, const Wind& wind) {
  std::vector<vec3> found;
  for_blades(lawn, state, wind, [&](int, int, const BladeShapes& shapes, int lane) {
    for (const Lanes3& joint : shapes.joint) found.push_back(joint.at(lane));
  });
  return found;
}

inline float farthest(const std::vector<vec3>& a, const std::vector<vec3>& b) {
  float most = a.size() == b.size() ? 0 : INFINITY;
  for (size_t i = 0; i < std::min(a.size(), b.size()); i++)
    most = std::max(most, glm::length(a[i] - b[i]));
  return most;
}

// Returns how deep the deepest joint but roots is inside a walker; 0: none is.
inline float deepest(const Lawn& lawn, const LawnState& state, const Wind& wind,
                     const Walkers& walkers) {
  float depth = 0;
  const std::vector<Collider> colliders = find_colliders(walkers);
  for_blades(lawn, state, wind, [&](int, int, const BladeShapes& shapes, int lane) {
    for (int k = 1; k < joints; k++)
      for (const Collider& c : colliders)
        depth = std::max(depth, -distance_to(c, shapes.joint[k].at(lane)));
  });
  return depth;
}

inline Walkers ball(vec3 at, float radius) { return {{{at, at, radius}}, {}}; }

}  // namespace wellspring::test
