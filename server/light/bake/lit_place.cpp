// SPDX-License-Identifier: Apache-2.0
#include "light/bake/lit_place.h"

namespace wellspring::light {
namespace {

constexpr float least_facing = 0.05f;  // cosine between a node's normal and a face of it
constexpr float least_passing = 0.05f;
constexpr float most_brightness = 25;  // of a gathered sample, times the mean light

BakePlace light_surface(const BakeScene& scene, const Ray& ray, const Hit& hit,
                       const Surface& surface) {
  BakePlace lit;
  lit.surface = surface;
  const Material& material = scene.world.material_of(hit.instance);
  lit.bsdf = make_bsdf_in(scene.parts.front(), Media{}, lit.surface, material, ray.direction);
  lit.bsdf.diffuse = vec3(1);
  const float passes = lit.bsdf.coat_passes * lit.bsdf.beneath;
  lit.uncoated = passes > least_passing ? 1 / passes : 1;
  return lit;
}

}  // namespace

BakePlace light_seen_place(const BakeScene& scene, const Ray& ray, const Hit& hit) {
  return light_surface(scene, ray, hit, eval_surface(scene.world, ray, hit));
}

BakePlace light_node_place(const BakeScene& scene, const Ray& ray, const Hit& hit, vec3 normal) {
  Surface surface = eval_surface(scene.world, ray, hit);
  const bool faces = dot(normal, surface.geometric_normal) > least_facing;
  surface.normal = faces ? normal : eval_mesh_normal(scene.world, ray, hit);
  return light_surface(scene, ray, hit, surface);
}

bool leave(const BakePlace& lit, Sampler& sampler, Walk& walk) {
  sampler.seek(Dimensions::first_surface + Dimensions::scatter);
  BsdfSample scattered = sample_bsdf(lit.bsdf, Lobes::diffuse, sampler);
  if (!advance(walk, lit.surface, scattered)) return false;
  walk.from_normal = lit.surface.geometric_normal;
  return true;
}

void cut_off(const BakeScene& scene, std::span<vec3> light) {
  if (!scene.known) return;
  const float most = most_brightness * scene.known->mean;
  vec3 sum(0);
  for (vec3 l : light) sum += l;
  if (!(luminance(sum) > most)) return;
  for (vec3& l : light) l *= most / luminance(sum);
}

}  // namespace wellspring::light
