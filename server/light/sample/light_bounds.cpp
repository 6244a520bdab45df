// SPDX-License-Identifier: Apache-2.0
#include "light/sample/light_bounds.h"

#include <cmath>

#include "world/surface.h"

namespace wellspring::light {
namespace {

constexpr size_t most_picture_cells = size_t(1) << 20;  // of all emitters together

LightBounds bounds_of(const PunctualLight& light) {
  LightBounds b;
  b.low = b.high = light.position;
  b.strength = luminance(light.intensity);
  b.cos_spread = -1;
  if (light.type == PunctualType::spot) {
    b.axis = light.direction;
    b.cos_spread = std::cos(light.inner_cone);
    b.cos_reach = std::cos(std::max(light.outer_cone - light.inner_cone, 0.0f) + 1e-3f);
  }
  if (std::isfinite(light.range) && light.range > 0) b.range = light.range;
  return b;
}

}  // namespace

LightTree make_emitter_tree(std::span<const EmitterTriangle> emitters, std::span<const float> power,
                            LightChoice choice) {
  std::vector<LightBounds> bounds;
  bounds.reserve(emitters.size());
  for (size_t i = 0; i < emitters.size(); i++) {
    const EmitterTriangle& e = emitters[i];
    LightBounds b;
    vec3 second = e.corner + e.edge1, third = e.corner + e.edge2;
    b.low = glm::min(e.corner, glm::min(second, third));
    b.high = glm::max(e.corner, glm::max(second, third));
    b.axis = e.normal;
    b.two_sided = e.double_sided;
    b.strength = power[i] / (pi * (e.double_sided ? 2.0f : 1.0f));
    bounds.push_back(b);
  }
  return make_light_tree(bounds, choice);
}

void add_punctual_choice(LightTables& tables) {
  tables.few_punctual = {}, tables.near_choice = {}, tables.distant_choice = {};
  if (tables.punctual.size() <= size_t(FewLights::most)) {
    tables.few_punctual = make_few_lights(tables.punctual, tables.cones);
    return;
  }
  std::vector<LightBounds> near, distant;
  for (const PunctualLight& light : tables.punctual) {
    LightBounds b = bounds_of(light), dark;
    bool is_distant = light.type == PunctualType::directional;
    near.push_back(is_distant ? dark : b);
    distant.push_back(is_distant ? b : dark);
  }
  tables.near_choice = make_light_tree(near, LightChoice::by_place);
  tables.distant_choice = make_light_tree(distant, LightChoice::by_strength);
}

void add_emission_picture(const World& world, float texels, EmitterTriangle& emitter,
                          LightTables& tables) {
  if (tables.picture_cells >= most_picture_cells) return;
  const Material& material = world.material_of(emitter.instance);
  Ray ray;
  ray.origin = emitter.corner + emitter.normal;
  ray.direction = -emitter.normal;
  Hit hit;
  hit.t = 1;
  hit.instance = emitter.instance;
  hit.triangle = emitter.triangle;
  EmissionPicture picture = make_emission_picture(texels, [&](vec2 barycentric) {
    hit.barycentric = barycentric;
    Surface surface = eval_surface(world, ray, hit);
    return luminance(surface_emission(surface, material)) * surface.alpha;
  });
  if (picture.cells.cells.empty()) return;
  tables.picture_cells += picture.cells.cells.size();
  emitter.picture = int(tables.pictures.size());
  tables.pictures.push_back(std::move(picture));
}

}  // namespace wellspring::light
