// SPDX-License-Identifier: Apache-2.0
#include "light/walk/known_light.h"

#include <algorithm>

#include "light/material/bsdf.h"
#include "light/material/microfacet.h"
#include "light/sample/light_tables.h"

namespace wellspring::light {
namespace {

// Radii of the sphere around what moves; so far away it takes a tenth of the sky.
constexpr float near_radii = 2.5f;
constexpr float sharp_alpha = 0.09f;  // a roughness of 0.3

// Returns whether the line from `a` to `b`, or on and on towards `b`, passes the sphere.
bool passes(vec3 a, vec3 b, bool endless, vec3 centre, float radius) {
  vec3 line = b - a, to = centre - a;
  float length2 = dot(line, line);
  if (!(length2 > 0)) return false;
  float at = std::max(dot(to, line) / length2, 0.0f);
  if (!endless) at = std::min(at, 1.0f);
  vec3 away = to - at * line;
  return dot(away, away) < radius * radius;
}

}  // namespace

uint32_t find_chart(const IlluminationCharts& charts, const World& world, const Ray& ray,
                    const Hit& hit) {
  if (world.is_moving(hit.instance)) return no_chart;
  bool front = dot(eval_face(world, hit.instance, hit.triangle), ray.direction) < 0;
  return charts.find(hit.instance, hit.triangle, front);
}

static uint32_t find_chart(const Transport& transport, const Ray& ray, const Hit& hit) {
  return transport.maps ? find_chart(*transport.maps->places, transport.world, ray, hit) : no_chart;
}

bool has_known_light(const Transport& transport, const Ray& ray, const Hit& hit) {
  return find_chart(transport, ray, hit) != no_chart;
}

// Finds the light as it falls on `seen`, the normal that the surface faces along; null: its mesh's.
static KnownLight find_known_light(const Transport& transport, const Ray& ray, const Hit& hit,
                                   vec3 position, const vec3* seen) {
  KnownLight known;
  const uint32_t at = find_chart(transport, ray, hit);
  if (at == no_chart) return known;
  const IlluminationMap& maps = *transport.maps;
  const IlluminationChart& chart = maps.places->charts[at];
  const IlluminationTaps taps = find_taps(maps, chart, position);
  known.known = true;
  known.light = eval_illumination(maps.nodes, taps);
  if (chart.bent || (chart.sloped && seen)) {
    const vec3 mesh = eval_mesh_normal(transport.world, ray, hit);
    known.light *= eval_illumination_turn(maps, maps.nodes, chart, taps, mesh, seen ? *seen : mesh);
  }
  known.unit = known_light(maps, known.light);
  known.raised = maps.least_known();
  return known;
}

KnownLight find_known_light(const Transport& transport, const Ray& ray, const Hit& hit,
                            vec3 position) {
  return find_known_light(transport, ray, hit, position, nullptr);
}

KnownLight find_known_light(const Transport& transport, const Ray& ray, const Hit& hit,
                            const Surface& surface) {
  return find_known_light(transport, ray, hit, surface.position, &surface.normal);
}

bool find_kept_light(const Transport& transport, const Ray& ray, const Hit& hit, bool sharp,
                     vec3& light) {
  if (!transport.known) return false;
  const IlluminationMap& map = *transport.known;
  const uint32_t chart = find_chart(*map.places, transport.world, ray, hit);
  if (chart == no_chart) return false;
  const vec3 place = ray.origin + hit.t * ray.direction;
  if (sharp && may_be_shaded(transport, place)) return false;
  light = eval_illumination(map, map.places->charts[chart], place);
  return true;
}

bool has_sharp_gloss(const Bsdf& bsdf) { return bsdf.alpha < sharp_alpha && has_specular(bsdf); }

vec3 kept_reflectance(const Bsdf& b) {
  vec3 reflected = b.diffuse * b.coat_passes;
  if (!has_sharp_gloss(b))
    reflected += b.metallic * fresnel_schlick(b.metal, b.view.z) +
                 vec3((1 - b.metallic) * (1 - b.coat_passes));
  return b.beneath * reflected;
}

bool may_be_shaded(const Transport& transport, vec3 position) {
  const Bounds box = transport.world.moving_bounds();
  if (!(box.low.x <= box.high.x)) return false;
  const vec3 centre = 0.5f * (box.low + box.high);
  const float radius = 0.5f * length(box.high - box.low);
  vec3 away = position - centre;
  if (dot(away, away) < near_radii * near_radii * radius * radius) return true;
  for (const PunctualLight& light : transport.tables.punctual) {
    bool distant = light.type == PunctualType::directional;
    if (passes(position, distant ? position - light.direction : light.position, distant, centre,
               radius))
      return true;
  }
  return false;
}

}  // namespace wellspring::light
