// SPDX-License-Identifier: Apache-2.0
#include "tessellate.h"

#include <algorithm>
#include <cmath>

namespace wellspring::test {
namespace {

// Each triangle in n * n alike.
Mesh cut_mesh(const Mesh& mesh, int n) {
  Mesh fine;
  fine.name = mesh.name;
  fine.material = mesh.material;
  for (const uvec3& t : mesh.triangles) {
    uint32_t first = uint32_t(fine.positions.size());
    for (int row = 0; row <= n; row++)
      for (int i = 0; i <= row; i++) {
        vec3 w(float(n - row) / float(n), float(row - i) / float(n), float(i) / float(n));
        fine.positions.push_back(w.x * mesh.positions[t.x] + w.y * mesh.positions[t.y] +
                                 w.z * mesh.positions[t.z]);
        fine.normals.push_back(
            normalize(w.x * mesh.normals[t.x] + w.y * mesh.normals[t.y] + w.z * mesh.normals[t.z]));
      }
    auto corner = [&](int row, int i) { return first + uint32_t(row * (row + 1) / 2 + i); };
    for (int row = 0; row < n; row++)
      for (int i = 0; i <= row; i++) {
        fine.triangles.push_back({corner(row, i), corner(row + 1, i), corner(row + 1, i + 1)});
        if (i < row)
          fine.triangles.push_back({corner(row, i), corner(row + 1, i + 1), corner(row, i + 1)});
      }
  }
  return fine;
}

}  // namespace

Scene tessellate(const Scene& scene, size_t triangles) {
  Scene fine = scene;
  size_t before = std::max<size_t>(triangle_count(scene), 1);
  int n = std::max(1, int(std::lround(std::sqrt(double(triangles) / double(before)))));
  for (Mesh& mesh : fine.meshes)
    if (max_component(scene.materials[size_t(mesh.material)].emission) == 0)
      mesh = cut_mesh(mesh, n);
  return fine;
}

}  // namespace wellspring::test
