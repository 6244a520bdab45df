// SPDX-License-Identifier: Apache-2.0
#include "light/visible/shade_facet.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "light/material/gloss_albedo.h"

namespace wellspring::light {
namespace {

template <class T>
T mix3(const T& a, const T& b, const T& c, vec3 w) {
  return a * w.x + b * w.y + c * w.z;
}

vec3 read_picture(const Pictures& pictures, const FacetPicture& place, const TextureRef& reference,
                  vec2 barycentric, float pixel) {
  const Texture& texture = pictures.scene->textures[size_t(reference.texture)];
  if (texture.image < 0) return vec3(1);
  vec2 uv = place.corner + place.edge1 * barycentric.x + place.edge2 * barycentric.y;
  if (!place.known) uv = vec2(reference.uv_transform * vec3(0, 0, 1));
  size_t image = size_t(texture.image);
  return eval_pyramid(pictures.scene->images[image], pictures.pyramids[image], texture, uv,
                      pixel * place.texels);
}

// Base colour, linear.
vec3 see_base(const Pictures& pictures, const Facet& f, vec2 at, float pixel) {
  const Mesh& mesh = *f.placed->mesh;
  const Material& m = *f.material;
  vec3 base = vec3(m.base_color);
  if (m.base_color_texture.texture >= 0)
    base *= read_picture(pictures, f.base, m.base_color_texture, at, pixel);
  if (!mesh.colors.empty())
    base *= vec3(mix3(mesh.colors[f.corner.x], mesh.colors[f.corner.y], mesh.colors[f.corner.z],
                      vec3(1 - at.x - at.y, at.x, at.y)));
  return base;
}

}  // namespace

Pictures make_pictures(const Scene& scene) {
  Pictures pictures{&scene, std::vector<TexturePyramid>(scene.images.size())};
  std::vector<uint8_t> used(scene.images.size(), 0);
  for (const Material& m : scene.materials)
    for (const TextureRef* r : {&m.base_color_texture, &m.metallic_roughness_texture,
                                &m.emission_texture, &m.normal_texture})
      if (r->texture >= 0 && scene.textures[size_t(r->texture)].image >= 0)
        used[size_t(scene.textures[size_t(r->texture)].image)] = 1;
  parallel_for(int(used.size()), [&](int i) {
    if (used[size_t(i)]) pictures.pyramids[size_t(i)] = make_pyramid(scene.images[size_t(i)]);
  });
  return pictures;
}

PrimaryHit see_facet(const Pictures& pictures, const World& world, const Facet& f,
                     MetalDemodulation metal, const Hit& hit, float pixel) {
  const Material& m = *f.material;
  vec2 at = hit.barycentric;
  vec3 weight(1 - at.x - at.y, at.x, at.y);
  PrimaryHit seen;
  seen.distance = hit.t;
  seen.object = f.placed->object;
  vec3 normal = f.one_normal ? f.normal[0] : mix3(f.normal[0], f.normal[1], f.normal[2], weight);
  float length2 = dot(normal, normal);
  normal = length2 > 1e-25f ? normal / std::sqrt(length2) : f.face;
  seen.normal = f.front ? normal : -normal;
  seen.scatters = !m.unlit;
  const vec3 base = see_base(pictures, f, at, pixel);
  float metallic = m.metallic;
  if (m.metallic_roughness_texture.texture >= 0 && m.metallic > 0)
    metallic *= read_picture(pictures, f.shine, m.metallic_roughness_texture, at, pixel).z;
  if (seen.scatters) seen.albedo = demodulated_albedo(base, metallic, metal);
  if (m.unlit || emits(f)) {
    Surface surface;  // what surface_emission() reads
    surface.front = f.front;
    surface.base_color = glm::max(base, vec3(0));
    surface.emission = emits(f) ? m.emission : vec3(0);
    if (emits(f) && m.emission_texture.texture >= 0)
      surface.emission *= read_picture(pictures, place_picture(world, f, m.emission_texture),
                                       m.emission_texture, at, pixel);
    seen.glow = surface_emission(surface, m);
  }
  return seen;
}

Gloss see_gloss(const Pictures& pictures, const Facet& f, vec2 barycentric, float pixel) {
  const Material& m = *f.material;
  Gloss gloss;
  gloss.roughness = clean(m.roughness), gloss.metallic = clean(m.metallic);
  if (m.metallic_roughness_texture.texture >= 0) {
    const vec3 texel =
        read_picture(pictures, f.shine, m.metallic_roughness_texture, barycentric, pixel);
    gloss.roughness *= clean(texel.y), gloss.metallic *= clean(texel.z);
  }
  gloss.f0 = clean(gloss_factors(m).f0 * m.specular_color);
  if (gloss.metallic >= least_metal)
    gloss.f0 = glm::mix(gloss.f0, clean(see_base(pictures, f, barycentric, pixel)), gloss.metallic);
  return gloss;
}

}  // namespace wellspring::light
