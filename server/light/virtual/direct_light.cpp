// SPDX-License-Identifier: Apache-2.0
#include "light/virtual/direct_light.h"

#include <algorithm>
#include <cmath>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/simd.h"
#include "light/material/bsdf_gloss.h"
#include "light/sample/light_tables.h"
#include "light/sample/sample_light.h"
#include "light/visible/facet.h"
#include "light/visible/surface_buffer.h"

namespace wellspring::light {
namespace {

// Share of the depth; farther off the plane lies another surface
constexpr float plane_share = 0.02f;
constexpr float other_object = 0.01f;  // weight of another object in the same plane
constexpr float least_weight = 1e-4f;

// Returns how much a pixel of the light shows of the same surface, 0 to 1.
float likeness(const SurfaceBuffer& light, const PixelGrid& grid, int x, int y,
               const SeenPoint& seen) {
  const size_t at = size_t(y) * size_t(light.view.width) + size_t(x);
  const float depth = light.depth[at];
  if (!(depth < std::numeric_limits<float>::infinity())) return 0;
  const vec3 normal(light.nx[at], light.ny[at], light.nz[at]);
  float facing = std::max(dot(normal, seen.normal), 0.0f);
  facing *= facing, facing *= facing;
  const vec3 to = depth * grid.at(float(x), float(y)) - seen.place;
  const float off = dot(to, seen.normal) / (plane_share * seen.depth);
  const float same = light.object[at] == seen.object ? 1.0f : other_object;
  return same * facing / (1 + off * off);
}

}  // namespace

TapWeights weigh_taps(const SurfaceBuffer& light, const PixelGrid& grid, const TapPair& x,
                      const TapPair& y, const SeenPoint& seen) {
  TapWeights weights;
  float like[4], sum = 0;
  for (int k = 0; k < 4; k++) {
    like[k] = likeness(light, grid, k & 1 ? x.second : x.first, k >> 1 ? y.second : y.first, seen);
    weights.of[k] = (k & 1 ? x.share : 1 - x.share) * (k >> 1 ? y.share : 1 - y.share) * like[k];
    sum += weights.of[k];
  }
  if (sum > least_weight) {
    for (float& weight : weights.of) weight /= sum;
    return weights;
  }
  weights = {};
  const int best = int(std::max_element(like, like + 4) - like);
  if (like[best] > 0) weights.of[best] = 1;
  return weights;
}

namespace {

constexpr int wide = lane_count, high = RayPacket::lanes / lane_count;  // pixels of a packet
constexpr float darkest = 1e-5f;  // radiance: no visitor sees a shadow of less
// Distance of shadow rays' origins from the surface: in metres, and as a share of the depth, as
// normals are those of smooth meshes and a depth has the precision of a float.
constexpr float clear_of_surface = 2e-3f, clear_share = 1e-3f;

struct Lit {
  const PunctualLight* light;
  SpotCone cone;
  float radius;
};

struct Rows {
  Lanes px, py, pz, nx, ny, nz;  // places and normals
  Lanes lift;                    // metres along the normal at which rays begin
  LaneMask there;
};

Rows read_rows(const SurfaceBuffer& s, const PixelGrid& grid, int x, int y) {
  constexpr Lanes lane{0, 1, 2, 3, 4, 5, 6, 7};
  const size_t at = size_t(y) * size_t(s.view.width) + size_t(x);
  Rows r;
  Lanes depth = load_lanes(&s.depth[at]);
  r.there = (depth < std::numeric_limits<float>::infinity()) & (lane < float(s.view.width - x));
  depth = keep_lanes(r.there, depth);
  const vec3 from = grid.at(float(x), float(y)), &eye = s.view.position;
  r.px = eye.x + depth * (from.x + lane * grid.right.x);
  r.py = eye.y + depth * (from.y + lane * grid.right.y);
  r.pz = eye.z + depth * (from.z + lane * grid.right.z);
  r.nx = load_lanes(&s.nx[at]), r.ny = load_lanes(&s.ny[at]), r.nz = load_lanes(&s.nz[at]);
  r.lift = clear_of_surface + clear_share * depth;
  if (!s.lift.empty()) r.lift = lanes_max(r.lift, load_lanes(&s.lift[at]));
  return r;
}

// Holds the share of the intensity that would arrive if nothing were in between, over pi; and the
// shadow ray.
struct Arriving {
  Lanes strength, dx, dy, dz, t_max;
  Lanes ux, uy, uz;  // towards the light, unit
  Lanes size;        // its radius over its distance
};

Arriving eval_arriving(const Lit& lit, const Rows& r, Lanes ox, Lanes oy, Lanes oz) {
  const PunctualLight& light = *lit.light;
  Arriving a;
  if (light.type == PunctualType::directional) {
    const vec3 to = -light.direction;
    a.dx = all_lanes(to.x), a.dy = all_lanes(to.y), a.dz = all_lanes(to.z);
    a.strength = positive_lanes(r.nx * to.x + r.ny * to.y + r.nz * to.z) * (1 / pi);
    a.t_max = all_lanes(std::numeric_limits<float>::infinity());
    a.ux = a.dx, a.uy = a.dy, a.uz = a.dz, a.size = all_lanes(0);
    return a;
  }
  a.dx = light.position.x - ox, a.dy = light.position.y - oy, a.dz = light.position.z - oz;
  const Lanes lx = light.position.x - r.px, ly = light.position.y - r.py,
              lz = light.position.z - r.pz;
  const Lanes distance2 = lanes_max(lx * lx + ly * ly + lz * lz, all_lanes(1e-20f));
  const Lanes inverse = 1.0f / lanes_sqrt(distance2);
  a.ux = lx * inverse, a.uy = ly * inverse, a.uz = lz * inverse;
  a.size = lit.radius * inverse;
  a.t_max = positive_lanes(1.0f - lit.radius * inverse);
  a.strength = positive_lanes(r.nx * lx + r.ny * ly + r.nz * lz) * inverse /
               lanes_max(distance2, all_lanes(least_distance * least_distance)) * (1 / pi);
  if (std::isfinite(light.range) && light.range > 0) {
    const Lanes ratio2 = distance2 * (1 / (light.range * light.range));
    a.strength *= positive_lanes(1.0f - ratio2 * ratio2);
  }
  if (light.type == PunctualType::spot) {
    const vec3& way = light.direction;
    const Lanes cosine = -(lx * way.x + ly * way.y + lz * way.z) * inverse;
    const Lanes t =
        lanes_min(positive_lanes((cosine - lit.cone.outer) * lit.cone.scale), all_lanes(1));
    a.strength *= t * t;
  }
  return a;
}

// Holds how eight pixels reflect.
struct RowGloss {
  bool any = false;
  GlossLanes of;
  Lanes alpha, vx, vy, vz, nv;  // `v`: towards the eye, unit
  Lanes coat;                   // dielectric's reflectance for light from all around
};

RowGloss read_gloss(const SurfaceBuffer& s, const Rows& r, int x, int y) {
  RowGloss g;
  if (s.gloss.empty()) return g;
  const size_t at = size_t(y) * size_t(s.view.width) + size_t(x);
  const int count = std::min(wide, s.view.width - x);
  for (int i = 0; i < count; i++) g.any |= s.gloss[at + size_t(i)] != 0;
  if (!g.any) return g;
  g.of = unpack_gloss(&s.gloss[at], &s.metallic[at]);
  g.alpha = lanes_max(g.of.roughness * g.of.roughness, all_lanes(least_alpha));
  const vec3& eye = s.view.position;
  g.vx = eye.x - r.px, g.vy = eye.y - r.py, g.vz = eye.z - r.pz;
  const Lanes length2 = g.vx * g.vx + g.vy * g.vy + g.vz * g.vz;
  const Lanes inverse = 1.0f / lanes_sqrt(lanes_max(length2, all_lanes(1e-20f)));
  g.vx *= inverse, g.vy *= inverse, g.vz *= inverse;
  g.nv = lanes_max(r.nx * g.vx + r.ny * g.vy + r.nz * g.vz, all_lanes(1e-3f));
  const Lanes f0 = lanes_max(lanes_max(g.of.f0[0], g.of.f0[1]), g.of.f0[2]);
  g.coat = gloss_albedo(f0, g.of.roughness, 1.0f - g.of.metallic, g.nv);
  return g;
}

// Returns GGX's distribution times its shadowing, by Smith, over four cosines, times pi: radiance
// over that of a white diffuse surface, but for Fresnel's factor. `hl`: cosine between light and
// facet.
Lanes eval_highlight(const Rows& r, const RowGloss& g, const Arriving& a, Lanes& hl) {
  Lanes hx = a.ux + g.vx, hy = a.uy + g.vy, hz = a.uz + g.vz;
  const Lanes inverse =
      1.0f / lanes_sqrt(lanes_max(hx * hx + hy * hy + hz * hz, all_lanes(1e-12f)));
  hx *= inverse, hy *= inverse, hz *= inverse;
  hl = lanes_min(positive_lanes(hx * a.ux + hy * a.uy + hz * a.uz), all_lanes(1));
  // A light of some size lights a wider lobe (Karis 2013, "Real shading in Unreal Engine 4").
  const Lanes alpha = lanes_min(g.alpha + 0.5f * a.size, all_lanes(1)), alpha2 = alpha * alpha;
  const Lanes nh = lanes_min(positive_lanes(r.nx * hx + r.ny * hy + r.nz * hz), all_lanes(1));
  const Lanes nl = lanes_max(r.nx * a.ux + r.ny * a.uy + r.nz * a.uz, all_lanes(1e-3f));
  const Lanes base = 1.0f - nh * nh * (1.0f - alpha2);
  const Lanes shadowing = nl * lanes_sqrt(g.nv * g.nv * (1.0f - alpha2) + alpha2) +
                          g.nv * lanes_sqrt(nl * nl * (1.0f - alpha2) + alpha2);
  return 0.5f * alpha2 / (base * base * shadowing);
}

// Returns the reflectance of facets under a cosine: exact for dielectrics (Cook and Torrance 1982,
// equation 18), by Schlick for metal.
Lanes eval_fresnel(Lanes f0, Lanes metallic, Lanes cosine) {
  const Lanes m = 1.0f - cosine, m2 = m * m;
  const Lanes metal = f0 + (1.0f - f0) * (m2 * m2 * m);
  const Lanes root = lanes_min(lanes_sqrt(f0), all_lanes(0.99f));
  const Lanes eta = (1.0f + root) / (1.0f - root);
  const Lanes g = lanes_sqrt(eta * eta - 1.0f + cosine * cosine);
  const Lanes first = (g - cosine) / (g + cosine);
  const Lanes second = (cosine * (g + cosine) - 1.0f) / (cosine * (g - cosine) + 1.0f);
  const Lanes coat = 0.5f * first * first * (1.0f + second * second);
  const LaneMask some = f0 > 0;
  return some ? coat + (metal - coat) * metallic : all_lanes(0);
}

// Adds up what eight pixels reflect of the light that arrives: as white diffuse surfaces, and as
// gloss.
struct RowLight {
  Lanes matte[3] = {}, gloss[3] = {};
  void add(const RowGloss& g, const Lanes (&light)[3], Lanes highlight, Lanes hl) {
    if (!g.any) {
      for (int c = 0; c < 3; c++) matte[c] += light[c];
      return;
    }
    const Lanes beneath = (1.0f - g.of.metallic) * (1.0f - g.coat);
    for (int c = 0; c < 3; c++) {
      matte[c] += light[c] * beneath;
      gloss[c] += light[c] * highlight * eval_fresnel(g.of.f0[c], g.of.metallic, hl);
    }
  }
  void put(const RowGloss& g, const SurfaceBuffer& s, int x, int y, LightPlanes& to) const {
    RawVector<float>* const planes[] = {&to.red, &to.green, &to.blue};
    RawVector<float>* const glossy[] = {&to.gloss_red, &to.gloss_green, &to.gloss_blue};
    const size_t at = size_t(y) * size_t(s.view.width) + size_t(x);
    const int count = std::min(wide, s.view.width - x);
    for (size_t c = 0; c < 3; c++)
      for (int i = 0; i < count; i++) {
        (*planes[c])[at + size_t(i)] += matte[c][i];
        if (g.any) (*glossy[c])[at + size_t(i)] += gloss[c][i];
      }
  }
};

// Lights one packet's pixels, from (x, y) on.
void light_pixels(const Transport& transport, std::span<const Lit> lights, const SurfaceBuffer& s,
                  const PixelGrid& grid, int x, int y, LightPlanes& to) {
  Rows rows[high];
  RowGloss gloss[high];
  RowLight sum[high];
  const int lines = std::min(high, s.view.height - y);
  for (int k = 0; k < lines; k++) {
    rows[k] = read_rows(s, grid, x, y + k);
    gloss[k] = read_gloss(s, rows[k], x, y + k);
  }
  for (const Lit& lit : lights) {
    RayPacket rays;
    Lanes strength[high], highlight[high] = {}, hl[high] = {};
    uint32_t active = 0;
    const float brightest = max_component(lit.light->intensity);
    for (int k = 0; k < lines; k++) {
      const Rows& r = rows[k];
      const Lanes ox = r.px + r.lift * r.nx, oy = r.py + r.lift * r.ny, oz = r.pz + r.lift * r.nz;
      const Arriving a = eval_arriving(lit, r, ox, oy, oz);
      const LaneMask seen = r.there & (a.strength * brightest > darkest);
      strength[k] = keep_lanes(seen, a.strength);
      if (gloss[k].any) highlight[k] = eval_highlight(r, gloss[k], a, hl[k]);
      active |= negative_lanes(seen) << (k * wide);
      const int first = k * wide;
      store_lanes(rays.origin_x + first, ox), store_lanes(rays.origin_y + first, oy);
      store_lanes(rays.origin_z + first, oz), store_lanes(rays.direction_x + first, a.dx);
      store_lanes(rays.direction_y + first, a.dy), store_lanes(rays.direction_z + first, a.dz);
      store_lanes(rays.t_max + first, a.t_max);
    }
    if (active == 0) continue;
    const uint32_t blocked = transport.world.occluded_packet(rays, active);
    for (int k = 0; k < lines; k++) {
      const Lanes free = keep_lanes(~lanes_of_bits(blocked >> (k * wide) & 0xff), strength[k]);
      Lanes light[3] = {free, free, free};
      if (transport.tables.any_pane)
        for (uint32_t bits = (blocked & active) >> (k * wide) & 0xff; bits; bits &= bits - 1) {
          const int lane = std::countr_zero(bits);
          const vec3 passes = eval_blocked(transport, rays, k * wide + lane);
          for (int c = 0; c < 3; c++) light[c][lane] = strength[k][lane] * passes[c];
        }
      for (int c = 0; c < 3; c++) light[c] *= lit.light->intensity[c];
      sum[k].add(gloss[k], light, highlight[k], hl[k]);
    }
  }
  for (int k = 0; k < lines; k++) sum[k].put(gloss[k], s, x, y + k, to);
}

}  // namespace

size_t memory_bytes(const LightPlanes& planes) {
  return bytes_of(planes.red, planes.green, planes.blue, planes.gloss_red, planes.gloss_green,
                  planes.gloss_blue);
}

void clear_planes(const SurfaceBuffer& surfaces, LightPlanes& planes) {
  const size_t pixels = surfaces.pixels() + surface_buffer_pad;
  for (auto* plane : {&planes.red, &planes.green, &planes.blue}) plane->assign(pixels, 0.0f);
  for (auto* plane : {&planes.gloss_red, &planes.gloss_green, &planes.gloss_blue})
    plane->assign(surfaces.gloss.empty() ? 0 : pixels, 0.0f);
}

void add_direct_light(const World& world, const Lights& lights, std::span<const DynamicLight> from,
                      const SurfaceBuffer& surfaces, LightPlanes& to) {
  std::vector<Lit> lit;
  for (const DynamicLight& one : from)
    if (max_component(one.light.intensity) > 0)
      lit.push_back({&one.light, make_spot_cone(one.light), one.radius});
  if (lit.empty()) return;
  const Transport transport{world, *lights.tables};
  const PixelGrid grid(surfaces.view);
  const int across = (surfaces.view.width + wide - 1) / wide,
            down = (surfaces.view.height + high - 1) / high;
  parallel_ranges(across * down, 16, [&](int begin, int end) {
    for (int i = begin; i < end; i++)
      light_pixels(transport, lit, surfaces, grid, i % across * wide, i / across * high, to);
  });
}

}  // namespace wellspring::light
