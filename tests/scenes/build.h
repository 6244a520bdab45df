// SPDX-License-Identifier: Apache-2.0
// Small words to write a scene in code: materials, quads, boxes, spheres. Shared by unit tests and
// benches.
#pragma once
#include <cmath>

#include "world/scene.h"
#include "world/view.h"

namespace wellspring::scenes {

inline Scene empty_scene() {
  Scene scene;
  scene.materials.emplace_back();
  scene.objects.push_back("");
  return scene;
}

inline Material diffuse(vec3 albedo) {
  Material m;
  m.base_color = vec4(albedo, 1);
  m.metallic = 0;
  m.roughness = 1;
  m.ior = 1;  // no gloss on top: purely Lambertian
  return m;
}
inline Material emitter(vec3 radiance) {
  Material m = diffuse(vec3(0));
  m.emission = radiance;
  return m;
}
inline Material metal(vec3 color, float roughness) {
  Material m;
  m.base_color = vec4(color, 1);
  m.metallic = 1;
  m.roughness = roughness;
  return m;
}
inline Material plastic(vec3 color, float roughness, float ior = 1.5f) {
  Material m = diffuse(color);
  m.roughness = roughness;
  m.ior = ior;
  return m;
}
// thickness 0: a thin pane; else a solid.
inline Material glass(float ior, float roughness, float thickness) {
  Material m = plastic(vec3(1), roughness, ior);
  m.transmission = 1;
  m.thickness = thickness;
  m.double_sided = true;
  return m;
}

inline int add_material(Scene& scene, Material material) {
  scene.materials.push_back(std::move(material));
  return int(scene.materials.size()) - 1;
}

// Functions that ask for a material take one that is to be added, or the number of one that is
// there.
inline int number_of(Scene& scene, const Material& material) {
  return add_material(scene, material);
}
inline int number_of(Scene&, int material) { return material; }

// Returns the number of a new texture, which shows the image.
inline int add_texture(Scene& scene, Image image, bool nearest = false) {
  scene.images.push_back(std::move(image));
  scene.textures.push_back({.image = int(scene.images.size()) - 1, .nearest = nearest});
  return int(scene.textures.size()) - 1;
}

inline mat4 at(vec3 position) { return glm::translate(mat4(1), position); }

// Returns the index of the new instance.
inline int add_mesh(Scene& scene, Mesh mesh, const char* object, mat4 to_world = mat4(1)) {
  scene.meshes.push_back(std::move(mesh));
  scene.objects.push_back(object);
  scene.instances.push_back(
      {int(scene.meshes.size()) - 1, to_world, uint32_t(scene.objects.size()) - 1});
  return int(scene.instances.size()) - 1;
}

// Two triangles over a, a+u, a+u+v, a+v; the front is where cross(u, v) points. uv runs along u and
// v.
inline void append_quad(Mesh& mesh, vec3 a, vec3 u, vec3 v) {
  uint32_t first = uint32_t(mesh.positions.size());
  vec3 normal = normalize(cross(u, v));
  for (vec2 t : {vec2(0, 0), vec2(1, 0), vec2(1, 1), vec2(0, 1)}) {
    mesh.positions.push_back(a + t.x * u + t.y * v);
    mesh.normals.push_back(normal);
    mesh.uv[0].push_back(t);
  }
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}
inline int add_quad(Scene& scene, const auto& material, vec3 a, vec3 u, vec3 v,
                    const char* object = "quad") {
  Mesh mesh;
  mesh.material = number_of(scene, material);
  append_quad(mesh, a, u, v);
  return add_mesh(scene, std::move(mesh), object);
}

// An upright square that faces +Z, `half` to each side of (0, 0, z).
inline int add_wall(Scene& scene, const auto& material, float z, float half = 9,
                    const char* object = "wall") {
  return add_quad(scene, material, {-half, -half, z}, {2 * half, 0, 0}, {0, 2 * half, 0}, object);
}

// A box of full extents `size` about the origin; `inward`: its fronts face the inside.
inline Mesh box_mesh(int material, vec3 size, bool inward = false) {
  Mesh mesh;
  mesh.material = material;
  vec3 h = 0.5f * size;
  for (int axis = 0; axis < 3; axis++)
    for (float sign : {-1.0f, 1.0f}) {
      vec3 n(0), u(0), v(0);
      n[axis] = sign;
      u[(axis + 1) % 3] = 1;
      v[(axis + 2) % 3] = sign;  // cross(u, v) points along n
      if (inward) std::swap(u, v);
      vec3 center = n * h;
      append_quad(mesh, center - u * h - v * h, 2.0f * u * h, 2.0f * v * h);
    }
  return mesh;
}

// Latitude-longitude sphere about the origin with smooth normals.
inline Mesh sphere_mesh(int material, float radius, int rings = 32) {
  Mesh mesh;
  mesh.material = material;
  int columns = 2 * rings;
  for (int y = 0; y <= rings; y++)
    for (int x = 0; x <= columns; x++) {
      float theta = pi * float(y) / float(rings), phi = 2 * pi * float(x) / float(columns);
      vec3 n(std::sin(theta) * std::cos(phi), std::cos(theta), -std::sin(theta) * std::sin(phi));
      mesh.positions.push_back(n * radius);
      mesh.normals.push_back(n);
      mesh.uv[0].push_back({float(x) / float(columns), float(y) / float(rings)});
    }
  for (int y = 0; y < rings; y++)
    for (int x = 0; x < columns; x++) {
      uint32_t a = uint32_t(y * (columns + 1) + x), b = a + uint32_t(columns) + 1;
      if (y > 0) mesh.triangles.push_back({a, b, a + 1});
      if (y < rings - 1) mesh.triangles.push_back({a + 1, b, b + 1});
    }
  return mesh;
}

inline int add_box(Scene& scene, const auto& material, vec3 size, const char* object,
                   mat4 to_world = mat4(1)) {
  return add_mesh(scene, box_mesh(number_of(scene, material), size), object, to_world);
}
inline int add_room(Scene& scene, const auto& material, vec3 size, const char* object,
                    mat4 to_world = mat4(1)) {
  return add_mesh(scene, box_mesh(number_of(scene, material), size, true), object, to_world);
}
inline int add_sphere(Scene& scene, const auto& material, float radius, const char* object,
                      mat4 to_world = mat4(1), int rings = 32) {
  return add_mesh(scene, sphere_mesh(number_of(scene, material), radius, rings), object, to_world);
}

}  // namespace wellspring::scenes
