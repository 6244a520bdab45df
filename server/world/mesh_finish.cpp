// SPDX-License-Identifier: Apache-2.0
#include "world/mesh_finish.h"

#include <cmath>
#include <utility>

namespace wellspring::world {
namespace {

template <class T>
void gather(std::vector<T>& values, const std::vector<uint32_t>& from) {
  if (values.empty()) return;
  std::vector<T> result;
  result.reserve(from.size());
  for (uint32_t i : from) result.push_back(values[i]);
  values = std::move(result);
}

// Replaces the vertices: vertex i of the result is vertex from[i] of the mesh.
void gather_vertices(Mesh& mesh, const std::vector<uint32_t>& from) {
  gather(mesh.positions, from);
  gather(mesh.normals, from);
  gather(mesh.tangents, from);
  gather(mesh.uv[0], from);
  gather(mesh.uv[1], from);
  gather(mesh.colors, from);
}

glm::dvec3 face_cross(const Mesh& mesh, const uvec3& t) {
  dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
  return cross(b - a, c - a);
}

vec3 unit_or(dvec3 v, vec3 otherwise) {
  double length = glm::length(v);
  return length > 1e-150 && std::isfinite(length) ? vec3(v / length) : otherwise;
}

vec3 any_perpendicular(vec3 n) {
  vec3 other = std::abs(n.x) < 0.7f ? vec3(1, 0, 0) : vec3(0, 1, 0);
  return normalize(cross(n, other));
}

// Returns the direction of u over a triangle, weighted by its area; `determinant` tells which way
// round the picture lies.
dvec3 face_tangent(const Mesh& mesh, const std::vector<vec2>& uv, const uvec3& t,
                   double& determinant) {
  dvec3 e1 = dvec3(mesh.positions[t.y]) - dvec3(mesh.positions[t.x]);
  dvec3 e2 = dvec3(mesh.positions[t.z]) - dvec3(mesh.positions[t.x]);
  dvec2 d1 = dvec2(uv[t.y]) - dvec2(uv[t.x]), d2 = dvec2(uv[t.z]) - dvec2(uv[t.x]);
  determinant = d1.x * d2.y - d2.x * d1.y;
  dvec3 tangent = e1 * d2.y - e2 * d1.y;
  double length = glm::length(tangent);
  if (determinant == 0 || !(length > 0) || !std::isfinite(length)) return dvec3(0);
  return tangent * ((determinant < 0 ? -1 : 1) / length * glm::length(cross(e1, e2)));
}

vec3 upright(dvec3 sum, vec3 normal) {
  vec3 tangent = unit_or(sum - dvec3(normal) * dot(dvec3(normal), sum), vec3(0));
  return tangent == vec3(0) ? any_perpendicular(normal) : tangent;
}

}  // namespace

std::vector<uint32_t> make_flat_normals(Mesh& mesh) {
  std::vector<uint32_t> from;
  std::vector<vec3> normals;
  from.reserve(mesh.triangles.size() * 3);
  normals.reserve(mesh.triangles.size() * 3);
  for (uvec3& triangle : mesh.triangles) {
    vec3 normal = unit_or(face_cross(mesh, triangle), vec3(0, 1, 0));
    for (int corner = 0; corner < 3; corner++) {
      from.push_back(triangle[corner]);
      normals.push_back(normal);
    }
  }
  mesh.normals.clear();
  gather_vertices(mesh, from);
  mesh.normals = std::move(normals);
  for (size_t i = 0; i < mesh.triangles.size(); i++)
    mesh.triangles[i] = uvec3(uint32_t(3 * i)) + uvec3(0, 1, 2);
  return from;
}

int repair_normals(Mesh& mesh) {
  std::vector<uint32_t> bad;
  std::vector<char> is_bad(mesh.normals.size(), 0);
  for (size_t i = 0; i < mesh.normals.size(); i++) {
    vec3& n = mesh.normals[i];
    double length = is_finite(n) ? glm::length(dvec3(n)) : 0;
    if (length > 1e-12) n = vec3(dvec3(n) / length);
    else bad.push_back(uint32_t(i)), is_bad[i] = 1;
  }
  if (bad.empty()) return 0;
  std::vector<dvec3> sum(mesh.normals.size(), dvec3(0));
  for (const uvec3& triangle : mesh.triangles) {
    if (!is_bad[triangle.x] && !is_bad[triangle.y] && !is_bad[triangle.z]) continue;
    dvec3 face = face_cross(mesh, triangle);
    for (int corner = 0; corner < 3; corner++) sum[triangle[corner]] += face;
  }
  for (uint32_t i : bad) mesh.normals[i] = unit_or(sum[i], vec3(0, 1, 0));
  return int(bad.size());
}

std::vector<uint32_t> make_tangents(Mesh& mesh, int uv_set) {
  const std::vector<vec2>& uv = mesh.uv[uv_set];
  // Holds sides 0 and 1 of a vertex: of faces whose picture is not mirrored, and of those whose
  // picture is.
  struct Sides {
    dvec3 sum[2] = {dvec3(0), dvec3(0)};
    char used[2] = {0, 0};
    uint32_t vertex[2] = {0, 0};
  };
  std::vector<Sides> sides(mesh.positions.size());
  std::vector<char> side_of(mesh.triangles.size(), 0);
  for (size_t i = 0; i < mesh.triangles.size(); i++) {
    const uvec3& t = mesh.triangles[i];
    double determinant = 0;
    dvec3 tangent = face_tangent(mesh, uv, t, determinant);
    int side = determinant > 0;  // v points down in glTF, so an upright picture has it negative
    side_of[i] = char(side);
    for (int corner = 0; corner < 3; corner++) {
      sides[t[corner]].sum[side] += tangent;
      sides[t[corner]].used[side] = 1;
    }
  }
  std::vector<uint32_t> from;
  std::vector<vec4> tangents;
  for (size_t i = 0; i < sides.size(); i++)
    for (int side = 0; side < 2; side++) {
      if (!sides[i].used[side] && !(side == 0 && !sides[i].used[1])) continue;
      sides[i].vertex[side] = uint32_t(from.size());
      from.push_back(uint32_t(i));
      tangents.push_back(vec4(upright(sides[i].sum[side], mesh.normals[i]), side ? -1.0f : 1.0f));
    }
  mesh.tangents.clear();
  gather_vertices(mesh, from);
  mesh.tangents = std::move(tangents);
  for (size_t i = 0; i < mesh.triangles.size(); i++)
    for (int corner = 0; corner < 3; corner++) {
      uint32_t& vertex = mesh.triangles[i][corner];
      vertex = sides[vertex].vertex[int(side_of[i])];
    }
  return from;
}

void update_tangents(Mesh& mesh, int uv_set) {
  std::vector<dvec3> sum(mesh.positions.size(), dvec3(0));
  double determinant = 0;
  for (const uvec3& t : mesh.triangles) {
    dvec3 tangent = face_tangent(mesh, mesh.uv[uv_set], t, determinant);
    for (int corner = 0; corner < 3; corner++) sum[t[corner]] += tangent;
  }
  for (size_t i = 0; i < sum.size(); i++)
    mesh.tangents[i] = vec4(upright(sum[i], mesh.normals[i]), mesh.tangents[i].w);
}

void turn_winding(Mesh& mesh) {
  for (uvec3& t : mesh.triangles) std::swap(t.y, t.z);
  for (vec4& tangent : mesh.tangents) tangent.w = -tangent.w;
}

int tangent_uv(const Material& m) {
  for (const TextureRef* map : {&m.normal_texture, &m.clearcoat_normal_texture})
    if (map->texture >= 0) return map->uv_set;
  return m.anisotropy > 0 ? m.anisotropy_texture.uv_set : -1;
}

}  // namespace wellspring::world
