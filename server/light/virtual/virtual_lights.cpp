// SPDX-License-Identifier: Apache-2.0
#include "light/virtual/virtual_lights.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/simd.h"
#include "light/random/sampler.h"
#include "world/surface.h"

namespace wellspring::light {
namespace {

// Share of the choice that leaves out the effect, for what the probes happen not to see.
constexpr double blind = 0.1;

// Empties the lights and makes room for twice as many as are wanted in the mean.
void clear_lights(VirtualLights& lights, size_t wanted) {
  const size_t most = (2 * wanted + 64 + lane_count - 1) / lane_count * lane_count;
  for (RawVector<float>* column :
       {&lights.x, &lights.y, &lights.z, &lights.nx, &lights.ny, &lights.nz, &lights.red,
        &lights.green, &lights.blue, &lights.radius2})
    if (column->size() < most) column->resize(most);
  if (lights.target.size() < most) lights.target.resize(most);
  lights.count = lights.padded = 0;
}

// Adds a light. `worth`: number of such texels that it stands for.
void add_light(const ReflectiveTexel& texel, double worth, float least2, float bound2,
               VirtualLights& lights) {
  const size_t i = size_t(lights.count);
  if (i >= lights.x.size()) return;
  vec3 intensity = texel.flux * float(worth / double(pi));
  if (!is_finite(intensity) || !(max_component(intensity) > 0)) return;
  lights.x[i] = texel.position.x, lights.y[i] = texel.position.y, lights.z[i] = texel.position.z;
  lights.nx[i] = texel.normal.x, lights.ny[i] = texel.normal.y, lights.nz[i] = texel.normal.z;
  lights.red[i] = intensity.x, lights.green[i] = intensity.y, lights.blue[i] = intensity.z;
  float own = std::max(texel.area * float(worth) / pi, least2) * bound2;
  lights.radius2[i] = std::clamp(own, 1e-12f, 1e12f);
  SurfacePlace place;
  place.position = texel.position, place.geometric_normal = texel.normal;
  place.extent = texel.extent;
  lights.target[i] = offset_origin(place, texel.normal);
  lights.count++;
}

double luminous(const ReflectiveTexel& texel) {
  double flux = double(luminance(texel.flux));
  return flux > 0 && std::isfinite(flux) ? flux : 0;
}

// Returns the effect of a texel on the probes, shadows left out, as a share of its flux, about.
double effect_on(std::span<const LitProbe> probes, const ReflectiveTexel& texel, float least2) {
  double sum = 0;
  for (const LitProbe& probe : probes) {
    vec3 way = texel.position - probe.position;
    float here = dot(way, probe.normal), there = -dot(way, texel.normal), d2 = dot(way, way);
    if (here > 0 && there > 0 && d2 < 1e30f)
      sum += double(here) * double(there) / (double(d2) * (double(d2) + double(least2)) + 1e-30);
  }
  return sum;
}

void weigh_texels(const ReflectiveShadowMap& map, VirtualLightChoice choice,
                  std::span<const LitProbe> probes, float least2, std::vector<double>& weights) {
  const bool effect = choice == VirtualLightChoice::by_effect && !probes.empty();
  const bool even = choice == VirtualLightChoice::uniform;
  weights.resize(map.texels.size());
  parallel_ranges(int(weights.size()), 256, [&](int begin, int end) {
    for (size_t i = size_t(begin); i < size_t(end); i++) {
      double flux = luminous(map.texels[i]);
      weights[i] = even ? 1 : flux;
      if (effect) weights[i] *= effect_on(probes, map.texels[i], least2);
    }
  });
  if (!effect) return;
  double sum = 0, flux = 0;
  for (size_t i = 0; i < weights.size(); i++) sum += weights[i], flux += luminous(map.texels[i]);
  for (size_t i = 0; flux > 0 && i < weights.size(); i++) {
    double by_flux = luminous(map.texels[i]) / flux;
    weights[i] = sum > 0 ? (1 - blind) * weights[i] / sum + blind * by_flux : by_flux;
  }
}

// Chooses each texel by its own weight and by a number of its own, which is the golden ratio's
// sequence along the list: neighbours in the list are neighbours in a map, so that the chosen ones
// are spread everywhere, and a weight that changes changes no other choice.
void choose_by_weight(const ReflectiveShadowMap& map, int wanted, double start, float least2,
                      float bound2, VirtualLights& lights) {
  constexpr double golden = 0.6180339887498949;
  double sum = 0;
  for (double w : lights.weights) sum += w;
  if (!(sum > 0)) return;
  double number = start;
  for (size_t i = 0; i < map.texels.size(); i++) {
    number += golden;
    number -= number >= 1 ? 1 : 0;
    const double often = lights.weights[i] * wanted / sum;
    const double times = std::floor(often + number);
    if (times > 0) add_light(map.texels[i], times / often, least2, bound2, lights);
  }
}

// Gives each map its share of points; Sobol' points of its square are texels.
void choose_by_sequence(const ReflectiveShadowMap& map, int wanted, SplatSeed seed, float start,
                        float least2, float bound2, VirtualLights& lights) {
  const double all = double(map.texels.size());
  double passed = double(start);
  for (const ReflectiveMap& one : map.maps) {
    double share = double(one.count) * wanted / all;
    int points = int(share);
    passed += share - points;
    if (passed >= 1) passed -= 1, points++;
    if (points < 1) continue;
    // A map that had no whole point stands for others like it.
    double worth = double(one.count) / (share < 1 ? share : double(points));
    uint64_t stream = mix64(seed.seed ^ mix64(0x736f626f6cull + one.source));
    for (int i = 0; i < points; i++) {
      Sampler sampler(stream, seed.pass * uint32_t(points) + uint32_t(i));
      vec2 u = sampler.next2();
      float face = u.x * float(one.faces);
      int f = std::min(int(face), one.faces - 1);
      int x = std::min(int((face - float(f)) * float(one.columns)), one.columns - 1),
          y = std::min(int(u.y * float(one.rows)), one.rows - 1);
      add_light(map.texels[map.cells[one.first + size_t((f * one.rows + y) * one.columns + x)]],
                worth, least2, bound2, lights);
    }
  }
}

}  // namespace

void fill_up(VirtualLights& lights) {
  for (lights.padded = lights.count; lights.padded % lane_count; lights.padded++) {
    const size_t i = size_t(lights.padded);
    lights.x[i] = lights.y[i] = lights.z[i] = 0;
    lights.nx[i] = lights.nz[i] = 0, lights.ny[i] = 1;
    lights.red[i] = lights.green[i] = lights.blue[i] = 0;
    lights.radius2[i] = 1;
  }
}

void choose_virtual_lights(const ReflectiveShadowMap& map, const SplatSettings& settings,
                           SplatSeed seed, std::span<const LitProbe> probes,
                           VirtualLights& lights) {
  const int wanted = std::clamp(settings.virtual_lights, 1, most_virtual_lights);
  clear_lights(lights, size_t(wanted));
  float least = settings.least_distance > 0 ? settings.least_distance : 0.02f * map.mean_distance;
  float least2 = std::clamp(least * least, 1e-12f, 1e12f);
  float bound = std::max(settings.bound, 0.0f);
  Sampler sampler(mix64(seed.seed ^ 0x63686f696365ull), seed.pass);
  const float start = sampler.next();
  if (settings.choice == VirtualLightChoice::low_discrepancy) {
    choose_by_sequence(map, wanted, seed, start, least2, bound * bound, lights);
  } else {
    weigh_texels(map, settings.choice, probes, least2, lights.weights);
    choose_by_weight(map, wanted, double(start), least2, bound * bound, lights);
  }
  fill_up(lights);
}

}  // namespace wellspring::light
