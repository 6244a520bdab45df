// SPDX-License-Identifier: Apache-2.0
#include <cstring>

#include "base/rng.h"
#include "light/bake/bake_file.h"

namespace wellspring::light {
namespace {

struct Hash {
  uint64_t value = 0;
  void bytes(const void* data, size_t size) {
    const char* p = static_cast<const char*>(data);
    value = mix64(value ^ size);
    for (size_t i = 0; i < size; i += 8) {
      uint64_t word = 0;
      std::memcpy(&word, p + i, std::min<size_t>(8, size - i));
      value = mix64(value ^ word);
    }
  }
  template <class... T>
  void add(const T&... v) {
    (bytes(&v, sizeof v), ...);
  }
  template <class T>
  void list(const std::vector<T>& v) {
    bytes(v.data(), v.size() * sizeof(T));
  }
};

void add_material(const Scene& scene, const Material& m, std::vector<char>& known, Hash& hash) {
  hash.add(m.base_color, m.metallic, m.roughness, m.normal_scale, m.emission, m.alpha_mode,
           m.alpha_cutoff, m.double_sided, m.unlit, m.ior, m.transmission, m.thickness,
           m.attenuation_color, m.attenuation_distance, m.dispersion, m.specular, m.specular_color,
           m.clearcoat, m.clearcoat_roughness, m.clearcoat_normal_scale, m.sheen_color,
           m.sheen_roughness, m.anisotropy, m.anisotropy_rotation, m.repaints);
  each_texture(m, [&](const TextureRef& reference) {
    hash.add(reference.texture, reference.uv_set, reference.uv_transform);
    if (reference.texture < 0) return;
    const Texture& texture = scene.textures[size_t(reference.texture)];
    hash.add(texture.image, texture.wrap_u, texture.wrap_v, texture.nearest);
    if (texture.image < 0 || known[size_t(texture.image)]) return;
    known[size_t(texture.image)] = 1;
    const Image& image = scene.images[size_t(texture.image)];
    hash.add(image.width, image.height, image.srgb);
    hash.list(image.texels8);
    hash.list(image.texels);
  });
}

}  // namespace

uint64_t hash_scene(const Scene& scene) {
  Hash hash;
  std::vector<char> images(scene.images.size(), 0), meshes(scene.meshes.size(), 0);
  for (const Instance& instance : scene.instances) {
    hash.add(instance.mesh, instance.to_world);
    if (meshes[size_t(instance.mesh)]) continue;
    meshes[size_t(instance.mesh)] = 1;
    const Mesh& mesh = scene.meshes[size_t(instance.mesh)];
    hash.list(mesh.positions), hash.list(mesh.normals), hash.list(mesh.tangents);
    hash.list(mesh.uv[0]), hash.list(mesh.uv[1]), hash.list(mesh.colors);
    hash.list(mesh.triangles);
    add_material(scene, scene.materials[size_t(mesh.material)], images, hash);
  }
  for (const PunctualLight& l : scene.lights)
    hash.add(l.type, l.position, l.direction, l.intensity, l.range, l.inner_cone, l.outer_cone);
  for (const Lamp& lamp : scene.lamps) hash.list(lamp.lights), hash.list(lamp.materials);
  const Environment& e = scene.environment;
  hash.add(e.radiance, e.image, e.sun.direction, e.sun.radiance, e.sun.angular_radius);
  if (e.image >= 0) {
    hash.list(scene.images[size_t(e.image)].texels8);
    hash.list(scene.images[size_t(e.image)].texels);
  }
  return hash.value;
}

}  // namespace wellspring::light
