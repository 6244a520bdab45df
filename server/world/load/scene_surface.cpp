// SPDX-License-Identifier: Apache-2.0
#include "world/load/scene_surface.h"

#include "base/load_error.h"
#include "world/load/scene_load.h"

namespace wellspring::world {

SurfaceMesh read_scene_surface(const std::string& file, double metres) {
  const Scene scene = load_scene(file);
  SurfaceMesh surface;
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[size_t(instance.mesh)];
    const dmat4 to_world(instance.to_world);
    const bool mirrors = glm::determinant(glm::dmat3(to_world)) < 0;
    if (surface.positions.size() + mesh.positions.size() > UINT32_MAX)
      throw LoadError(file, "", "has too many vertices");
    const uint32_t first = uint32_t(surface.positions.size());
    for (vec3 position : mesh.positions)
      surface.positions.push_back(
          (dvec3(to_world * glm::dvec4(dvec3(position), 1)) + scene.origin) * metres);
    for (uvec3 triangle : mesh.triangles) {
      if (mirrors) std::swap(triangle.y, triangle.z);
      surface.triangles.push_back(triangle + first);
    }
  }
  if (surface.triangles.empty()) throw LoadError(file, "", "has no triangles");
  weld(surface);
  return surface;
}

}  // namespace wellspring::world
