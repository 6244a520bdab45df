// SPDX-License-Identifier: Apache-2.0
#include "light/splat/reflective_shadow_map.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/parallel.h"
#include "light/splat/aim_source.h"
#include "light/material/bsdf.h"
#include "light/sample/emission.h"
#include "light/sample/light_tables.h"
#include "light/sample/medium.h"
#include "light/sample/sample_light.h"

namespace wellspring::light {
namespace {

constexpr int most_texels = 1 << 20;
constexpr float least_cosine = 0.1f;  // of a texel's area
// Metal rougher than that reflects about as a matte surface does.
constexpr float matte_alpha = 0.09f;

// Sources' shares of all texels; the sum is 1, or 0 where nothing emits light.
void share_texels(const Transport& transport, std::span<const SplatSource> sources,
                  std::vector<double>& shares) {
  shares.clear();
  double sum = 0, roots = 0;
  for (const SplatSource& source : sources) {
    shares.push_back(double(eval_source_power(transport, source)));
    sum += shares.back();
    roots += std::sqrt(shares.back());
  }
  // Half by power. A sun outshines every lamp, but not where its light does not reach.
  for (double& share : shares)
    share = sum > 0 ? 0.5 * share / sum + 0.5 * std::sqrt(share) / roots : 0;
}

struct MapShape {
  int faces, rows, columns;
};
MapShape shape_map(const Transport& transport, const SplatSource& source, int texels) {
  if (source.kind == SplatSourceKind::emitters || source.kind == SplatSourceKind::sky)
    return {1, 1, texels};
  bool point = source.kind == SplatSourceKind::punctual && source.light.type == PunctualType::point;
  if (point && texels < 6) return {1, 1, texels};
  int faces = point ? 6 : 1;
  float aspect = point ? 1 : window_aspect(transport, source);
  float side = std::sqrt(float(texels / faces) * aspect);
  int columns = std::clamp(int(side), 1, texels), rows = std::max(1, texels / faces / columns);
  return {faces, rows, columns};
}

// Calls visit(x, y) along Morton's curve.
template <class Visit>
void for_each_cell(int columns, int rows, const Visit& visit) {
  if (rows == 1) {
    for (int x = 0; x < columns; x++) visit(x, 0);
    return;
  }
  uint32_t side = std::bit_ceil(uint32_t(std::max(columns, rows)));
  auto every_second = [](uint32_t code) {
    code &= 0x55555555u;
    code = (code | code >> 1) & 0x33333333u;
    code = (code | code >> 2) & 0x0f0f0f0fu;
    code = (code | code >> 4) & 0x00ff00ffu;
    return int((code | code >> 8) & 0xffffu);
  };
  for (uint64_t code = 0; code < uint64_t(side) * side; code++) {
    int x = every_second(uint32_t(code)), y = every_second(uint32_t(code) >> 1);
    if (x < columns && y < rows) visit(x, y);
  }
}

void add_map(const Transport& transport, const SplatSource& source, uint32_t index, double wanted,
             int texels, SplatSeed seed, ReflectiveShadowMap& map) {
  MapShape shape = shape_map(transport, source, texels);
  ReflectiveMap added{index, uint32_t(map.aims.size()), 0, shape.faces, shape.rows, shape.columns};
  added.count = uint32_t(shape.faces * shape.rows * shape.columns);
  // One that was chosen by chance stands for those that were not.
  float worth = wanted < 1 ? float(1 / wanted) : 1 / float(added.count);
  map.cells.resize(size_t(added.first) + added.count);
  SourceAim aim = aim_source(transport, source);
  uint64_t stream = mix64(seed.seed ^ mix64(source.id ^ 0x72736dull));
  for (int face = 0; face < shape.faces; face++)
    for_each_cell(shape.columns, shape.rows, [&](int x, int y) {
      uint32_t number = uint32_t(map.aims.size()) - added.first;
      Sampler sampler(stream, seed.pass * added.count + number);
      map.cells[added.first + uint32_t((face * shape.rows + y) * shape.columns + x)] =
          uint32_t(map.aims.size());
      SourceRay& to = map.aims.emplace_back();
      aim_at_cell(aim, {face, y, x, shape.rows, shape.columns, shape.faces}, sampler, to);
      to.flux *= worth;
      to.spread *= worth;
      if (!is_finite(to.flux) || !(max_component(to.flux) > 0)) to.flux = vec3(0);
    });
  map.maps.push_back(added);
}

vec3 matte_reflectance(const Bsdf& bsdf) {
  vec3 diffuse = bsdf.diffuse * (bsdf.has_coat ? bsdf.coat_passes : 1.0f);
  if (bsdf.metallic > 0 && bsdf.alpha >= matte_alpha) diffuse += bsdf.metal * bsdf.metallic;
  return min(diffuse * bsdf.beneath, vec3(1));
}

// What is there, behind panes that are looked through.
void light_texel(const Transport& transport, const SourceRay& aim, Hit hit,
                 ReflectiveTexel& texel) {
  texel = {};
  Ray ray = aim.ray;
  vec3 flux = aim.flux;
  float distance = 0;
  for (int panes = 0; hit.valid() && panes <= most_panes; panes++) {
    Surface surface = eval_surface(transport.world, ray, hit);
    const Material& material = transport.world.material_of(hit.instance);
    distance += hit.t;
    if (!is_pane(surface, material)) {
      if (material.unlit) return;
      Bsdf bsdf = make_bsdf_in(transport, {}, surface, material, ray.direction);
      texel.position = surface.position;
      texel.normal = surface.geometric_normal;
      texel.extent = surface.extent;
      texel.distance = distance;
      texel.flux = flux * matte_reflectance(bsdf) * range_window(distance, aim.range);
      float cosine = std::max(-dot(surface.geometric_normal, ray.direction), least_cosine);
      texel.area = aim.spread * (aim.parallel ? 1 : distance * distance) / cosine;
      bool fine = is_finite(texel.flux) && is_finite(texel.position) && is_finite(texel.normal) &&
                  std::isfinite(texel.area);
      if (!fine) texel = {};
      return;
    }
    flux *= pane_transmittance(surface, material, ray.direction);
    if (!(max_component(flux) > 0)) return;
    ray.origin = offset_origin(surface, ray.direction);
    hit = transport.world.intersect(ray);
  }
}

}  // namespace

void make_reflective_shadow_map(const Transport& transport, std::span<const SplatSource> sources,
                                const SplatSettings& settings, SplatSeed seed,
                                ReflectiveShadowMap& map) {
  map.maps.clear(), map.aims.clear(), map.cells.clear();
  share_texels(transport, sources, map.shares);
  const double texels = std::clamp(settings.texels, 1, most_texels);
  Sampler sampler(mix64(seed.seed ^ 0x736861726564ull), seed.pass);
  double passed = double(sampler.next());  // systematic sampling of what is left of whole numbers
  for (size_t i = 0; i < sources.size(); i++) {
    double wanted = texels * map.shares[i];
    if (!(wanted > 0)) continue;
    int whole = int(wanted);
    if (wanted < 1) {
      passed += wanted;
      if (passed < 1) continue;
      passed -= 1;
      whole = 1;
    }
    add_map(transport, sources[i], uint32_t(i), wanted, whole, seed, map);
  }
  const int count = int(map.aims.size());
  map.texels.resize(size_t(count));
  map.rays = uint64_t(count);
  parallel_ranges(count, 64, [&](int begin, int end) {
    constexpr int together = 64;
    Ray rays[together];
    Hit hits[together];
    for (int first = begin; first < end; first += together) {
      int number = std::min(together, end - first);
      for (int i = 0; i < number; i++) rays[i] = map.aims[size_t(first + i)].ray;
      transport.world.intersect_many(rays, hits, number);
      for (int i = 0; i < number; i++)
        light_texel(transport, map.aims[size_t(first + i)], hits[i], map.texels[size_t(first + i)]);
    }
  });
  double sum = 0, number = 0;
  for (int i = 0; i < count; i++)
    if (!map.aims[size_t(i)].parallel && max_component(map.texels[size_t(i)].flux) > 0)
      sum += double(map.texels[size_t(i)].distance), number++;
  map.mean_distance = number > 0 ? float(sum / number) : 0;
}

}  // namespace wellspring::light
