// SPDX-License-Identifier: Apache-2.0
#include "light/dynamic/direct_light.h"

#include <algorithm>
#include <cmath>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/simd.h"
#include "light/sample/light_tables.h"
#include "light/sample/sample_light.h"
#include "light/visible/pixel_grid.h"

namespace wellspring {
namespace {

constexpr int wide = lane_count, high = RayPacket::lanes / lane_count;  // pixels of a packet
constexpr float darkest = 1e-5f;  // radiance: of less nobody sees a shadow
// How far shadow rays begin from the surface: metres, and of the depth, where normals are those of
// smooth meshes and a depth has the precision of a float.
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
  return r;
}

// What of the intensity would arrive if nothing were in between, over pi; and the shadow ray.
struct Arriving {
  Lanes strength, dx, dy, dz, t_max;
};

Arriving eval_arriving(const Lit& lit, const Rows& r, Lanes ox, Lanes oy, Lanes oz) {
  const PunctualLight& light = *lit.light;
  Arriving a;
  if (light.type == PunctualType::directional) {
    const vec3 to = -light.direction;
    a.dx = all_lanes(to.x), a.dy = all_lanes(to.y), a.dz = all_lanes(to.z);
    a.strength = positive_lanes(r.nx * to.x + r.ny * to.y + r.nz * to.z) * (1 / pi);
    a.t_max = all_lanes(std::numeric_limits<float>::infinity());
    return a;
  }
  a.dx = light.position.x - ox, a.dy = light.position.y - oy, a.dz = light.position.z - oz;
  const Lanes lx = light.position.x - r.px, ly = light.position.y - r.py,
              lz = light.position.z - r.pz;
  const Lanes distance2 = lanes_max(lx * lx + ly * ly + lz * lz, all_lanes(1e-20f));
  const Lanes inverse = 1.0f / lanes_sqrt(distance2);
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

// What thin panes let through of a ray that something is in the way of.
vec3 pass_panes(const Transport& transport, const RayPacket& rays, int i) {
  Ray ray;
  ray.origin = {rays.origin_x[i], rays.origin_y[i], rays.origin_z[i]};
  ray.direction = {rays.direction_x[i], rays.direction_y[i], rays.direction_z[i]};
  ray.t_max = rays.t_max[i];
  if (!may_cross_pane(transport.tables.pane_boxes, ray)) return vec3(0);
  return eval_visibility(transport, ray);
}

// One packet's pixels, from (x, y) on.
void light_pixels(const Transport& transport, std::span<const Lit> lights, const SurfaceBuffer& s,
                  const PixelGrid& grid, int x, int y, LightPlanes& to) {
  Rows rows[high];
  Lanes sum[high][3] = {};
  const int lines = std::min(high, s.view.height - y);
  for (int k = 0; k < lines; k++) rows[k] = read_rows(s, grid, x, y + k);
  for (const Lit& lit : lights) {
    RayPacket rays;
    Lanes strength[high];
    uint32_t active = 0;
    const float brightest = max_component(lit.light->intensity);
    for (int k = 0; k < lines; k++) {
      const Rows& r = rows[k];
      const Lanes ox = r.px + r.lift * r.nx, oy = r.py + r.lift * r.ny, oz = r.pz + r.lift * r.nz;
      const Arriving a = eval_arriving(lit, r, ox, oy, oz);
      const LaneMask seen = r.there & (a.strength * brightest > darkest);
      strength[k] = keep_lanes(seen, a.strength);
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
      for (int c = 0; c < 3; c++) sum[k][c] += free * lit.light->intensity[c];
    }
    if (!transport.tables.any_pane) continue;
    for (uint32_t bits = blocked & active; bits; bits &= bits - 1) {
      const int i = std::countr_zero(bits), k = i / wide, lane = i % wide;
      const vec3 passes = pass_panes(transport, rays, i);
      for (int c = 0; c < 3; c++)
        sum[k][c][lane] += strength[k][lane] * passes[c] * lit.light->intensity[c];
    }
  }
  for (int k = 0; k < lines; k++) {
    const size_t at = size_t(y + k) * size_t(s.view.width) + size_t(x);
    const int count = std::min(wide, s.view.width - x);
    for (int i = 0; i < count; i++) {
      to.red[at + size_t(i)] += sum[k][0][i];
      to.green[at + size_t(i)] += sum[k][1][i];
      to.blue[at + size_t(i)] += sum[k][2][i];
    }
  }
}

}  // namespace

size_t memory_bytes(const LightPlanes& planes) {
  return bytes_of(planes.red, planes.green, planes.blue);
}

void clear_planes(size_t pixels, LightPlanes& planes) {
  for (auto* plane : {&planes.red, &planes.green, &planes.blue}) {
    plane->resize(pixels + surface_buffer_pad);
    std::fill(plane->begin(), plane->end(), 0.0f);
  }
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

}  // namespace wellspring
