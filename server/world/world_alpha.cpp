// SPDX-License-Identifier: Apache-2.0
#include "world/world_alpha.h"

#include <bit>

#include "base/rng.h"

namespace wellspring::world {
namespace {

float uniform_of(const Ray& ray, uint32_t instance, uint32_t triangle) {
  auto pair = [](float a, float b) {
    return uint64_t(std::bit_cast<uint32_t>(a)) << 32 | std::bit_cast<uint32_t>(b);
  };
  uint64_t hash = mix64(uint64_t(instance) << 32 | triangle);
  hash = mix64(hash ^ pair(ray.origin.x, ray.origin.y));
  hash = mix64(hash ^ pair(ray.origin.z, ray.direction.x));
  hash = mix64(hash ^ pair(ray.direction.y, ray.direction.z));
  return float(hash >> 40) * 0x1p-24f;
}

}  // namespace

bool may_pass(const Mesh& mesh, const Material& material) {
  if (material.alpha_mode == AlphaMode::opaque) return false;
  if (material.repaints) return true;
  float threshold = material.alpha_mode == AlphaMode::mask ? material.alpha_cutoff : 1.0f;
  if (material.base_color_texture.texture >= 0 || material.base_color.w < threshold) return true;
  for (const vec4& color : mesh.colors)
    if (material.base_color.w * color.w < threshold) return true;
  return false;
}

bool may_be_pane(const Material& material) {
  return material.transmission > 0 && !(material.thickness > 0) && material.metallic < 1;
}

bool passes(const Scene& scene, const PlacedMesh& placed, uint32_t instance, uint32_t triangle,
            vec2 barycentric, const Ray& ray) {
  const Mesh& mesh = *placed.mesh;
  const Material& material = *placed.material;
  uvec3 corner = mesh.triangles[triangle];
  vec3 weight{1 - barycentric.x - barycentric.y, barycentric.x, barycentric.y};
  float alpha = material.base_color.w;
  if (!mesh.colors.empty())
    alpha *= mesh.colors[corner.x].w * weight.x + mesh.colors[corner.y].w * weight.y +
             mesh.colors[corner.z].w * weight.z;
  const TextureRef& reference = material.base_color_texture;
  if (reference.texture >= 0) {
    const std::vector<vec2>& set = mesh.uv[reference.uv_set];
    vec2 uv{0};
    if (!set.empty())
      uv = set[corner.x] * weight.x + set[corner.y] * weight.y + set[corner.z] * weight.z;
    const Texture& texture = scene.textures[size_t(reference.texture)];
    if (texture.image >= 0)
      alpha *= eval_texture(scene.images[size_t(texture.image)], texture,
                            vec2(reference.uv_transform * vec3(uv, 1)))
                   .w;
  }
  if (material.alpha_mode == AlphaMode::mask) return alpha < material.alpha_cutoff;
  return uniform_of(ray, instance, triangle) >= alpha;
}

}  // namespace wellspring::world
