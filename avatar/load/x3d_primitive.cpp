// SPDX-License-Identifier: Apache-2.0
// Box, Sphere, Cylinder and Cone of X3D 4, clause 13.
#include "avatar/load/x3d_mesh.h"

namespace wellspring::avatar {
namespace {

constexpr int around = 24, along = 12;

// A surface of revolution about +Y from a profile of (radius, y, normal_r, normal_y).
struct ProfilePoint {
  float radius, y, normal_radius, normal_y, t;
};

void add_vertex(X3dMesh& mesh, vec3 position, vec3 normal, vec2 uv) {
  mesh.point_of.push_back(uint32_t(mesh.points.size()));
  mesh.points.push_back(position);
  mesh.normals.push_back(normal);
  mesh.uv.push_back(uv);
}

// Profiles run from low to high so that the outside is the front.
void revolve(X3dMesh& mesh, const std::vector<ProfilePoint>& profile) {
  uint32_t first = uint32_t(mesh.points.size()), columns = around + 1;
  for (const ProfilePoint& p : profile)
    for (int i = 0; i <= around; i++) {
      float angle = 2 * pi * float(i) / around;  // starts at the back, as textures do
      vec3 out(-std::sin(angle), 0, -std::cos(angle));
      vec3 normal = out * p.normal_radius + vec3(0, p.normal_y, 0);
      add_vertex(mesh, out * p.radius + vec3(0, p.y, 0), normal, {float(i) / around, p.t});
    }
  for (uint32_t row = 0; row + 1 < profile.size(); row++)
    for (uint32_t i = 0; i < uint32_t(around); i++) {
      uint32_t a = first + row * columns + i, b = a + 1, c = a + columns, d = c + 1;
      if (profile[row].radius > 0) mesh.triangles.push_back({a, b, d});
      if (profile[row + 1].radius > 0) mesh.triangles.push_back({a, d, c});
    }
}

}  // namespace

X3dMesh make_x3d_primitive(const X3dFile& file, const X3dNode& node) {
  X3dMesh mesh;
  mesh.solid = bool_of(node, "solid", true);
  if (node.type == "Box") {
    vec3 half = 0.5f * glm::abs(vec3_of(file, node, "size", vec3(2)));
    for (int axis = 0; axis < 3; axis++)
      for (float side : {-1.0f, 1.0f}) {
        vec3 n(0), u(0), v(0);
        n[axis] = side;
        u[(axis + 1) % 3] = side;
        v[(axis + 2) % 3] = 1;
        uint32_t first = uint32_t(mesh.points.size());
        for (vec2 c : {vec2(-1, -1), vec2(1, -1), vec2(1, 1), vec2(-1, 1)})
          add_vertex(mesh, (n + u * c.x + v * c.y) * half, n, c * 0.5f + 0.5f);
        mesh.triangles.push_back({first, first + 1, first + 2});
        mesh.triangles.push_back({first, first + 2, first + 3});
      }
    return mesh;
  }
  std::vector<ProfilePoint> side;
  float radius = std::abs(float_of(file, node, node.type == "Cone" ? "bottomRadius" : "radius", 1));
  float half = 0.5f * std::abs(float_of(file, node, "height", 2));
  if (node.type == "Sphere") {
    for (int i = 0; i <= along; i++) {
      float t = float(i) / along, angle = (t - 0.5f) * pi;
      float c = i == 0 || i == along ? 0 : std::cos(angle), s = std::sin(angle);
      side.push_back({radius * c, radius * s, c, s, t});
    }
    revolve(mesh, side);
    return mesh;
  }
  bool cone = node.type == "Cone";
  float slope = glm::length(vec2(2 * half, radius)), top_radius = cone ? 0 : radius;
  float normal_radius = cone && slope > 0 ? 2 * half / slope : 1;
  float normal_y = cone && slope > 0 ? radius / slope : 0;
  if (bool_of(node, "side", true))
    revolve(mesh, {{radius, -half, normal_radius, normal_y, 0},
                   {top_radius, half, normal_radius, normal_y, 1}});
  if (bool_of(node, "bottom", true))
    revolve(mesh, {{0, -half, 0, -1, 0}, {radius, -half, 0, -1, 1}});
  if (!cone && bool_of(node, "top", true))
    revolve(mesh, {{radius, half, 0, 1, 0}, {0, half, 0, 1, 1}});
  return mesh;
}

}  // namespace wellspring::avatar
