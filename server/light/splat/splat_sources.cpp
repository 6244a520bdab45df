// SPDX-License-Identifier: Apache-2.0
#include "light/splat/splat_sources.h"

#include <algorithm>
#include <cmath>

#include "light/sample/light_tables.h"

namespace wellspring::light {
namespace {

float power_or_none(float power) { return std::isfinite(power) && power > 0 ? power : 0; }

float punctual_power(const PunctualLight& light, float radius) {
  float strength = luminance(light.intensity);
  switch (light.type) {
    case PunctualType::point: return 4 * pi * strength;
    // The mean of the fall-off between both cones, about.
    case PunctualType::spot:
      return 2 * pi * strength *
             (1 - 0.5f * (std::cos(light.inner_cone) + std::cos(light.outer_cone)));
    case PunctualType::directional: return pi * radius * radius * strength;
  }
  return 0;
}

}  // namespace

SplatSource make_splat_source(const PunctualLight& light, uint64_t id) {
  SplatSource source;
  source.light = light;
  source.id = id;
  return source;
}

std::vector<SplatSource> make_all_splat_sources(const Transport& transport) {
  const LightTables& tables = transport.tables;
  constexpr uint64_t punctual_ids = 1ull << 40, sky_id = 1ull << 41;
  std::vector<SplatSource> sources;
  auto add = [&](const SplatSource& source) {
    if (eval_source_power(transport, source) > 0) sources.push_back(source);
  };
  for (size_t i = 0; i < tables.punctual.size(); i++) {
    // Of the scene's list, whichever lamps are on.
    uint64_t number = i < tables.punctual_index.size() ? tables.punctual_index[i] : i;
    add(make_splat_source(tables.punctual[i], punctual_ids + number));
  }
  for (size_t begin = 0; begin < tables.emitters.size();) {
    size_t end = begin;
    while (end < tables.emitters.size() &&
           tables.emitters[end].instance == tables.emitters[begin].instance)
      end++;
    SplatSource source;
    source.kind = SplatSourceKind::emitters;
    source.first = uint32_t(begin);
    source.count = uint32_t(end - begin);
    source.id = tables.emitters[begin].instance;
    add(source);
    begin = end;
  }
  SplatSource sky;
  sky.kind = SplatSourceKind::sky;
  sky.id = sky_id;
  add(sky);
  return sources;
}

float eval_source_power(const Transport& transport, const SplatSource& source) {
  const LightTables& tables = transport.tables;
  const float radius = tables.emission.radius, disc = pi * radius * radius;
  const EnvironmentLight& sky = tables.environment;
  const float sun = luminance(sky.sun_radiance) * sky.sun_chord2 * pi * disc;
  switch (source.kind) {
    case SplatSourceKind::punctual: return power_or_none(punctual_power(source.light, radius));
    case SplatSourceKind::emitters: {
      float sum = 0;
      size_t end = std::min(size_t(source.first) + source.count, tables.emitter_power.size());
      for (size_t i = source.first; i < end; i++) sum += power_or_none(tables.emitter_power[i]);
      return power_or_none(sum);
    }
    case SplatSourceKind::sky: return power_or_none(4 * pi * sky.mean_luminance * disc + sun);
    case SplatSourceKind::sun: return power_or_none(sun);
  }
  return 0;
}

}  // namespace wellspring::light
