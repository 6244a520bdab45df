// SPDX-License-Identifier: Apache-2.0
#include "world/scene.h"

namespace wellspring::world {

Material repainted(const Material& m, const Repaint& change) {
  constexpr float most = 1e9f;  // the bound for files
  Material made = m;
  bool colors = is_finite(vec3(change.base_color)) && std::isfinite(change.base_color.w);
  if (colors) made.base_color = glm::clamp(m.base_color + change.base_color, vec4(0), vec4(1));
  if (is_finite(change.emission))
    made.emission = glm::clamp(m.emission + change.emission, vec3(0), vec3(most));
  const mat3& uv = change.uv;
  if (is_finite(uv[0]) && is_finite(uv[1]) && is_finite(uv[2]))
    each_texture(made, [&](TextureRef& use) { use.uv_transform += uv; });
  return made;
}

Material dimmed(const Material& m, vec3 factor, int spectrum) {
  Material made = m;
  made.emission *= factor;
  if (spectrum >= 0) made.spectra.emission = spectrum;
  // An unlit material's colour is its light.
  if (m.unlit) made.base_color = vec4(vec3(m.base_color) * factor, m.base_color.w);
  return made;
}

namespace {

Bounds bounds_of(const Scene& scene, bool unlit_too) {
  Bounds bounds;
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[size_t(instance.mesh)];
    if (!unlit_too && mesh.material >= 0 && scene.materials[size_t(mesh.material)].unlit) continue;
    for (const uvec3& triangle : mesh.triangles)
      for (int corner = 0; corner < 3; corner++) {
        vec3 p = vec3(instance.to_world * vec4(mesh.positions[triangle[corner]], 1));
        if (!is_finite(p)) continue;
        bounds.low = glm::min(bounds.low, p);
        bounds.high = glm::max(bounds.high, p);
      }
  }
  return bounds;
}

}  // namespace

Bounds scene_bounds(const Scene& scene) { return bounds_of(scene, true); }
Bounds lit_bounds(const Scene& scene) { return bounds_of(scene, false); }

size_t triangle_count(const Scene& scene) {
  size_t count = 0;
  for (const Instance& instance : scene.instances)
    count += scene.meshes[size_t(instance.mesh)].triangles.size();
  return count;
}

bool has_light(const Scene& scene) {
  if (max_component(scene.environment.radiance) > 0) return true;
  const SunDisc& sun = scene.environment.sun;
  if (max_component(sun.radiance) > 0 && sun.angular_radius > 0) return true;
  for (const PunctualLight& light : scene.lights)
    if (max_component(light.intensity) > 0) return true;
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[size_t(instance.mesh)];
    if (!mesh.triangles.empty() &&
        max_component(scene.materials[size_t(mesh.material)].emission) > 0)
      return true;
  }
  return false;
}

}  // namespace wellspring::world
