// SPDX-License-Identifier: Apache-2.0
#include "world/load/stand_in.h"

#include <algorithm>
#include <cmath>

#include "image/srgb.h"
#include "scan/tree/octahedral.h"

namespace wellspring::world {
namespace {

constexpr float half_side = 0.9f;  // a square's, in distances between points
constexpr float steps = 65536;     // along a node's cube

// Adds a rectangle with these half sides.
void add_rectangle(vec3 place, vec3 along, vec3 across, vec4 color, Mesh& mesh) {
  const vec3 normal = glm::normalize(glm::cross(along, across));
  const uint32_t first = uint32_t(mesh.positions.size());
  for (const vec3 corner : {-along - across, along - across, along + across, across - along})
    mesh.positions.push_back(place + corner);
  mesh.normals.insert(mesh.normals.end(), 4, normal);
  mesh.colors.insert(mesh.colors.end(), 4, color);
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

void add_square(vec3 place, vec3 normal, float half, vec4 color, Mesh& mesh) {
  const vec3 aside = glm::normalize(std::abs(normal.y) < 0.9f ? glm::cross(normal, vec3(0, 1, 0))
                                                              : glm::cross(normal, vec3(1, 0, 0)));
  add_rectangle(place, half * aside, half * glm::cross(normal, aside), color, mesh);
}

}  // namespace

Mesh make_stand_in(std::span<const NodePoints> nodes) {
  Mesh mesh;
  mesh.stands_in = true;
  for (const NodePoints& node : nodes) {
    const float step = node.size / steps, half = half_side * node.spacing;
    for (uint32_t i = 0; i < node.count; i++) {
      const vec3 place(node.corner +
                       dvec3(node.x[i] + 0.5f, node.y[i] + 0.5f, node.z[i] + 0.5f) * double(step));
      const uint32_t code = node.color[i];
      const vec4 color(decode_srgb(uint8_t(code)), decode_srgb(uint8_t(code >> 8)),
                       decode_srgb(uint8_t(code >> 16)), 1);
      if (node.normal[i] != no_normal) {
        add_square(place, decode_octahedral(node.normal[i]), half, color, mesh);
        continue;
      }
      for (const vec3 axis : {vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1)})
        add_square(place, axis, half, color, mesh);
    }
  }
  return mesh;
}

Mesh make_stand_in(const SplatSet& splats, size_t most) {
  constexpr float least_opacity = 0.3f, reach = 1.5f;  // standard deviations
  std::vector<uint32_t> there;
  for (size_t i = 0; i < splats.size(); i++) {
    const float size = splats.scale[i].x + splats.scale[i].y + splats.scale[i].z;
    if (splats.opacity[i] >= least_opacity && is_finite(splats.place[i]) && std::isfinite(size) &&
        size > 0)
      there.push_back(uint32_t(i));
  }
  const size_t step = there.size() / std::max<size_t>(most, 1) + 1;
  const float larger = reach * std::sqrt(float(step));
  Mesh mesh;
  mesh.stands_in = true;
  for (size_t k = 0; k < there.size(); k += step) {
    const uint32_t i = there[k];
    const mat3 axes = glm::mat3_cast(splats.turn[i]);
    vec3 scale = larger * splats.scale[i];
    int thin = 0;
    for (int axis = 1; axis < 3; axis++)
      if (scale[axis] < scale[thin]) thin = axis;
    const int a = (thin + 1) % 3, b = (thin + 2) % 3;
    const float least = 0.01f * std::max(scale[a], scale[b]);
    auto code = [&](int c) {
      return decode_srgb(uint8_t(std::lrint(255 * std::clamp(splats.color[i][c], 0.0f, 1.0f))));
    };
    add_rectangle(splats.place[i], std::max(scale[a], least) * axes[a],
                  std::max(scale[b], least) * axes[b], vec4(code(0), code(1), code(2), 1), mesh);
  }
  return mesh;
}

}  // namespace wellspring::world
