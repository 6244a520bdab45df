// SPDX-License-Identifier: Apache-2.0
#include "cache/point_glow.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "base/parallel.h"
#include "cache/packing.h"
#include "light/first_surface.h"
#include "light/light_tables.h"
#include "world/surface.h"

namespace wellspring {
namespace {

constexpr float reach = 1e-4f;        // of a point's coordinates and a metre: beside its surface
constexpr float least_told = 0.01f;   // reflectance by which a tint is told
constexpr float surely_none = 0.97f;  // that packing makes of a tint of 1, and more
constexpr int most_near = 8;          // triangles

// What panes and media before the surface leave of its light: of its reflectance, likewise.
vec3 tint_of(const Surface& surface, vec3 albedo) {
  if (surface.metallic > 0 || surface.transmission > 0) return vec3(1);
  vec3 bare = kept_albedo(surface, KeptMetal::none), tint(1);
  float mean = 0;
  int told = 0;
  for (int c = 0; c < 3; c++) {
    if (!(bare[c] >= least_told)) continue;
    tint[c] = std::min(albedo[c] / bare[c], 1.0f);
    mean += tint[c], told++;
  }
  for (int c = 0; c < 3 && told > 0; c++)
    if (!(bare[c] >= least_told)) tint[c] = mean / float(told);
  return std::min({tint.x, tint.y, tint.z}) > surely_none ? vec3(1) : tint;
}

uint32_t find_glow(const PointCache& points, size_t i, const World& world) {
  vec3 place(points.x[i], points.y[i], points.z[i]), way = -unpack_normal(points.normal[i]);
  float near = reach * (1 + max_component(abs(place)));
  Hit hits[most_near], best;
  int count = world.find_near(place, way, near, near, hits, most_near);
  for (int k = 0; k < count; k++)
    if (world.object_of(hits[k].instance) == points.color[i].object &&
        !(std::abs(hits[k].t) >= std::abs(best.t)))
      best = hits[k];
  if (!best.valid()) return 0;
  Surface surface = eval_surface(world, {.origin = place - way, .direction = way}, best);
  return pack_glow(world, surface, points.color[i].albedo);
}

}  // namespace

bool may_glow(const World& world, uint32_t instance) {
  const Material& material = world.material_of(instance);
  return !material.unlit && material.emission != vec3(0);
}

uint32_t pack_glow(const World& world, const Surface& surface, uint32_t albedo) {
  if (world.material_of(surface.instance).unlit || surface.emission == vec3(0)) return 0;
  return pack_rgb9e5(tint_of(surface, unpack_albedo(albedo)) * surface.emission);
}

void begin_glow(PointCache& points) { points.glow.assign(points.x.size(), 0); }
void forget_glow(PointCache& points) { BigVector<uint32_t>().swap(points.glow); }

void learn_glow(PointCache& points, const World& world) {
  forget_glow(points);
  std::vector<char> shines;  // by object
  for (uint32_t i = 0; i < uint32_t(world.instance_count()); i++) {
    if (!may_glow(world, i)) continue;
    size_t object = world.object_of(i);
    if (object >= shines.size()) shines.resize(object + 1);
    shines[object] = 1;
  }
  auto may = [&](uint32_t i) {
    uint32_t object = points.color[i].object;
    return is_alive(points, i) && object < shines.size() && shines[object] &&
           !(points.flags[i] & point_infinite);
  };
  if (shines.empty()) return;
  std::atomic<bool> any = false;
  parallel_ranges(points.capacity(), 1 << 14, [&](int begin, int end) {
    for (int i = begin; i < end; i++)
      if (may(uint32_t(i))) return any.store(true);
  });
  if (!any) return;
  begin_glow(points);
  parallel_ranges(points.capacity(), 512, [&](int begin, int end) {
    for (int i = begin; i < end; i++)
      if (may(uint32_t(i))) points.glow[size_t(i)] = find_glow(points, size_t(i), world);
  });
}

}  // namespace wellspring
