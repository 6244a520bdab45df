// SPDX-License-Identifier: Apache-2.0
#include "light/visible/guides.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "base/parallel.h"
#include "base/rng.h"
#include "light/sample/medium.h"
#include "light/walk/first_surface.h"
#include "light/walk/walk.h"
#include "world/large_texture.h"

namespace wellspring::light {
namespace {

constexpr int most_specular = 8;     // mirrors on the way: they may face each other
constexpr float least_tint = 0.02f;  // least share that is followed further
constexpr int grain = 256;           // rays

bool is_polished(const Bsdf& bsdf) { return bsdf.alpha < polished_alpha; }

// Returns the share of light that a polished surface mirrors if it lets nothing through.
vec3 mirrored_share(const Bsdf& bsdf, vec3 direction) {
  float r = (bsdf.eta - 1) / (bsdf.eta + 1), cosine = std::abs(dot(bsdf.normal, direction));
  float fresnel = r * r + (1 - r * r) * std::pow(1 - std::min(cosine, 1.0f), 5.0f);  // Schlick 1994
  vec3 dielectric = bsdf.facet_base + bsdf.facet_slope * fresnel;
  return glm::mix(dielectric, bsdf.metal, bsdf.metallic);
}

// Returns what a polished surface that light goes through does with most of it: mirrors or refracts
// it.
BsdfSample turn(const Surface& surface, const Bsdf& bsdf, const Material& material,
                vec3 direction) {
  vec3 n = dot(bsdf.normal, direction) > 0 ? -bsdf.normal : bsdf.normal;
  BsdfSample turned;
  turned.direction = glm::reflect(direction, n);
  turned.weight = vec3(1);
  if (bsdf.thin) {
    turned.direction = direction;
    turned.bounce = Bounce::pass;
    turned.weight = is_pane(surface, material) ? pane_transmittance(surface, material, direction)
                                               : bsdf.transmit;
    return turned;
  }
  turned.glass = true;
  vec3 through = glm::refract(direction, n, 1 / bsdf.eta);
  if (through == vec3(0)) return turned;  // total reflection
  float here = -dot(direction, n), beyond = -dot(through, n);
  float across = (here - bsdf.eta * beyond) / (here + bsdf.eta * beyond),
        along = (bsdf.eta * here - beyond) / (bsdf.eta * here + beyond);
  if (across * across + along * along > 1) return turned;  // more than half is reflected
  turned.direction = through;
  turned.bounce = Bounce::refract;
  turned.weight = bsdf.transmit;
  return turned;
}

vec3 share(vec3 v) { return is_finite(v) ? clamp(v, vec3(0), vec3(1)) : vec3(0); }

// Returns diffuse and glossy reflectance together, of a surface that shows no picture of others.
vec3 reflectance(const Bsdf& bsdf) {
  vec3 glossy = bsdf.metallic * bsdf.metal + (1 - bsdf.metallic) * bsdf.facet_base;
  return bsdf.diffuse + bsdf.transmit + glossy;
}

Guide eval_guide(const Transport& transport, const Ray& ray) {
  Walk walk;
  walk.ray = ray;
  if (transport.tables.any_solid) walk.media.here = find_media(transport, ray.origin);
  vec3 tint(1), albedo(0);
  Guide guide;
  for (;;) {
    Hit hit = transport.world.intersect(walk.ray);
    if (!hit.valid()) {
      albedo += tint * share(eval_environment(transport.tables.environment, walk.ray.direction));
      break;
    }
    Surface surface = meet_surface(transport, walk.ray, hit, walk.media);
    const Material& material = transport.world.material_of(hit.instance);
    tint *= eval_absorption(transport, walk.media.here.innermost(), hit.t);
    Bsdf bsdf = make_bsdf_in(transport, walk.media, surface, material, walk.ray.direction);
    bool last = material.unlit || walk.depth > most_specular || !is_polished(bsdf);
    bool clear = max_component(bsdf.transmit) > 0 && !last;
    albedo += tint * share(surface_emission(surface, material) + (material.unlit ? vec3(0)
                                                                  : last         ? reflectance(bsdf)
                                                                                 : bsdf.diffuse));
    if (!clear && guide.normal == vec3(0) && (last || has_diffuse(bsdf)))
      guide.normal = bsdf.normal;
    if (last) break;
    BsdfSample turned;
    if (clear) {
      turned = turn(surface, bsdf, material, walk.ray.direction);
    } else {
      vec3 n = dot(bsdf.normal, walk.ray.direction) > 0 ? -bsdf.normal : bsdf.normal;
      turned.direction = glm::reflect(walk.ray.direction, n);
      turned.weight = mirrored_share(bsdf, walk.ray.direction);
    }
    tint *= turned.weight;
    if (!(max_component(tint) > least_tint) || !advance(walk, surface, turned)) {
      if (guide.normal == vec3(0)) guide.normal = bsdf.normal;
      break;
    }
  }
  guide.albedo = share(albedo);
  return guide;
}

}  // namespace

void eval_guides(const World& world, const Lights& lights, std::span<const Ray> rays,
                 std::span<Guide> guides) {
  if (rays.size() != guides.size()) throw std::invalid_argument("eval_guides: one answer a ray");
  Transport transport{world, *lights.tables};
  parallel_ranges(int(rays.size()), grain, [&](int begin, int end) {
    for (size_t i = size_t(begin); i < size_t(end); i++) guides[i] = eval_guide(transport, rays[i]);
  });
}

GuidePlanes make_guides(const World& world, const Lights& lights, const View& view, int rays) {
  Transport transport{world, *lights.tables};
  GuidePlanes planes;
  planes.albedo.resize(size_t(view.width) * size_t(view.height));
  planes.normal.resize(planes.albedo.size());
  parallel_ranges(view.height, 1, [&](int begin, int end) {
    for (int y = begin; y < end; y++)
      for (int x = 0; x < view.width; x++) {
        Guide sum;
        for (int i = 0; i < rays; i++) {
          vec2 at = spread_in_pixel(i);
          Guide one = eval_guide(transport, view_ray(view, float(x) + at.x, float(y) + at.y));
          sum.albedo += one.albedo, sum.normal += one.normal;
        }
        size_t pixel = size_t(y) * size_t(view.width) + size_t(x);
        planes.albedo[pixel] = sum.albedo / float(rays);
        planes.normal[pixel] = sum.normal / float(rays);
      }
  });
  return planes;
}

namespace {

constexpr size_t packet = 64;  // rays intersected before their surfaces are looked at

PrimaryHit see_nothing(const LightTables& tables, vec3 direction) {
  PrimaryHit seen;
  seen.normal = -direction;
  seen.distance = std::numeric_limits<float>::infinity();
  seen.glow = eval_environment(tables.environment, direction);
  return seen;
}

// Follows the whole way, as samples go: through panes and whatever the eye is in.
PrimaryHit see_slowly(const Transport& transport, const Ray& ray) {
  Request request;
  request.ray = ray;
  Sampler sampler(0, 0);
  Sample sample;
  FirstSurface first = find_first_surface(transport, 2, request, sampler, sample);
  PrimaryHit seen;
  seen.distance = sample.distance;
  seen.glow = sample.rest;
  bool hit = sample.flags & sample_hit;
  seen.normal = hit ? sample.normal : -ray.direction;
  if (!hit) return seen;
  seen.object = sample.object;
  seen.scatters = first.scatters;
  if (first.scatters) seen.albedo = first.tint * demodulated_reflectance(first).albedo;
  return seen;
}

PrimaryHit see_surface(const Transport& transport, const Ray& ray, const Hit& hit) {
  const World& world = transport.world;
  if (met_lambertian(transport, hit)) {
    LambertSurface surface = eval_lambert_surface(world, ray, hit);
    vec3 albedo = make_lambert(surface, ray.direction).reflectance;
    if (!(max_component(albedo) > least_albedo)) albedo = vec3(0);
    return {surface.normal, hit.t, albedo, vec3(0), world.object_of(hit.instance), true};
  }
  Surface surface = eval_surface(world, ray, hit);
  if (surface.transmission > 0 || surface.anisotropy > 0) return see_slowly(transport, ray);
  const Material& material = world.material_of(hit.instance);
  PrimaryHit seen;
  seen.normal = surface.normal;
  seen.distance = hit.t;
  seen.object = surface.object;
  seen.glow = surface_emission(surface, material);
  seen.scatters = !material.unlit;
  if (seen.scatters) seen.albedo = demodulated_albedo(surface, traits_of(transport, hit).metal);
  return seen;
}

void see_packet(const Transport& transport, std::span<const Ray> rays, PrimaryHit* seen) {
  const LightTables& tables = transport.tables;
  const World& world = transport.world;
  Hit hits[packet];
  bool plain = !tables.any_solid;
  if (plain) world.intersect_many(rays.data(), hits, int(rays.size()));
  for (size_t i = 0; i < rays.size(); i++) {
    const Hit& hit = hits[i];
    bool pane = plain && hit.valid() && traits_of(transport, hit).maybe_pane;
    if (!plain || pane) seen[i] = see_slowly(transport, rays[i]);
    else if (hit.valid()) seen[i] = see_surface(transport, rays[i], hit);
    else seen[i] = see_nothing(tables, rays[i].direction);
  }
}

}  // namespace

void see(const World& world, const Lights& lights, std::span<const Ray> rays,
         std::span<PrimaryHit> seen) {
  if (rays.size() != seen.size()) throw std::invalid_argument("see: one answer a ray");
  Transport transport{world, *lights.tables};
  int packets = int((rays.size() + packet - 1) / packet);
  parallel_ranges(packets, 4, [&](int begin, int end) {
    for (size_t start = size_t(begin) * packet; start < size_t(end) * packet; start += packet)
      see_packet(transport, rays.subspan(start, std::min(rays.size() - start, packet)),
                 &seen[start]);
  });
}

void fetch_pieces(const World& world, const Lights& lights, const View& view) {
  if (world.pictures().empty()) return;
  PieceClient client(shared_store());
  std::vector<PieceMotion> motions;
  // The second time it looks for what lies beside the first pieces.
  for (int round = 0; round < 2; round++) {
    make_guides(world, lights, view, 1);
    client.want(take_wishes(world, motions));
    client.fetch();
  }
}

}  // namespace wellspring::light
