// SPDX-License-Identifier: Apache-2.0
#include "light/visible/facet.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "light/material/bsdf_gloss.h"

namespace wellspring::light {

FacetPicture place_picture(const World& world, const Facet& facet, const TextureRef& reference) {
  const Scene& scene = world.scene();
  const Mesh& mesh = *facet.placed->mesh;
  FacetPicture p;
  if (reference.texture < 0) return p;
  const std::vector<vec2>& uv = mesh.uv[reference.uv_set];
  int image = scene.textures[size_t(reference.texture)].image;
  if (uv.empty() || image < 0) return p;
  auto at = [&](int k) { return vec2(reference.uv_transform * vec3(uv[facet.corner[k]], 1)); };
  p.corner = at(0), p.edge1 = at(1) - p.corner, p.edge2 = at(2) - p.corner;
  const Image& of = scene.images[size_t(image)];
  float area = 0.5f * std::abs(p.edge1.x * p.edge2.y - p.edge1.y * p.edge2.x);
  p.texels =
      std::sqrt(area * float(of.width) * float(of.height)) / std::max(facet.root_area, 1e-20f);
  p.known = true;
  return p;
}

void place_shine(const World& world, Facet& f) {
  if (!f.shine.known) f.shine = place_picture(world, f, f.material->metallic_roughness_texture);
}

void place_relief(const World& world, Facet& f) {
  const PlacedMesh& placed = *f.placed;
  const std::vector<vec4>& tangents = placed.mesh->tangents;
  if (f.relief.known || f.material->normal_texture.texture < 0 || tangents.empty()) return;
  vec3 normal = f.normal[0] + f.normal[1] + f.normal[2], tangent(0);
  for (int k = 0; k < 3; k++) tangent += vec3(tangents[f.corner[k]]);
  if (!placed.moving) tangent = mat3(placed.to_world) * tangent;
  tangent -= normal * (dot(normal, tangent) / std::max(dot(normal, normal), 1e-30f));
  const float length2 = dot(tangent, tangent);
  if (!(length2 > 1e-25f)) return;
  f.tangent = tangent / std::sqrt(length2);
  const float turn = (tangents[f.corner.x].w < 0) != placed.mirrored ? -1.0f : 1.0f;
  f.bitangent =
      cross(normal, f.tangent) * (turn / std::sqrt(std::max(dot(normal, normal), 1e-30f)));
  f.relief = place_picture(world, f, f.material->normal_texture);
}

Facet make_facet(const World& world, uint32_t instance, uint32_t triangle, vec3 eye) {
  Facet f;
  f.instance = instance;
  f.triangle = triangle;
  f.placed = &world.placed(instance);
  f.material = f.placed->material;
  const PlacedMesh& placed = *f.placed;
  const Mesh& mesh = *placed.mesh;
  f.corner = mesh.triangles[triangle];
  float area = 0;
  f.face = eval_face(world, instance, triangle, &area);
  vec3 place = mesh.positions[f.corner.x];
  if (placed.apart) place = mat3(placed.to_world) * place + (vec3(placed.to_world[3]) - eye);
  else if (placed.in_place) place -= eye;
  else place = vec3(placed.to_world * vec4(place, 1)) - eye;
  const float beyond = dot(f.face, place);
  f.front = beyond <= 0, f.plane_distance = std::abs(beyond);
  for (int k = 0; k < 3; k++) {
    vec3 n = mesh.normals[f.corner[k]];
    f.normal[k] = placed.in_place ? n : placed.normal_to_world * n;
  }
  f.one_normal = f.normal[0] == f.normal[1] && f.normal[0] == f.normal[2];
  f.root_area = std::sqrt(area);
  f.base = place_picture(world, f, f.material->base_color_texture);
  if (f.material->metallic > 0) place_shine(world, f);
  return f;
}

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

// Returns the base colour, linear; `large` as see_facet() has it.
vec3 see_base(const Pictures& pictures, const Facet& f, vec2 at, float pixel,
              const vec3* large = nullptr) {
  const Mesh& mesh = *f.placed->mesh;
  const Material& m = *f.material;
  vec3 base = vec3(m.base_color);
  if (large) base *= *large;
  else if (m.base_color_texture.texture >= 0)
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
                     MetalDemodulation metal, const Hit& hit, float pixel, const vec3* large) {
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
  const vec3 base = see_base(pictures, f, at, pixel, large);
  float metallic = m.metallic;
  if (m.metallic_roughness_texture.texture >= 0 && m.metallic > 0)
    metallic *= read_picture(pictures, f.shine, m.metallic_roughness_texture, at, pixel).z;
  if (seen.scatters) seen.albedo = demodulated_albedo(base, metallic, metal);
  if (m.unlit || emits(f)) {
    Surface surface;  // input of surface_emission()
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
