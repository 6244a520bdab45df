// SPDX-License-Identifier: Apache-2.0
// Sources of light whose bounce is wanted: all of a scene, or those that move. A punctual light is
// held by value, so that one that is carried about need not be in the scene's tables.
#pragma once
#include <span>
#include <vector>

#include "light/sample/transport.h"
#include "world/emitter.h"

namespace wellspring::light {

enum class SplatSourceKind : uint8_t {
  punctual,  // `light`
  emitters,  // triangles [first, first + count) of LightTables::emitters
  sky,       // LightTables::environment, its sun included
  sun,       // its sun alone
};

struct SplatSource {
  SplatSourceKind kind = SplatSourceKind::punctual;
  PunctualLight light;
  float radius = 0;  // metres around a point or spot in which its rays meet nothing
  uint32_t first = 0, count = 0;
  // Names its random numbers: a source that moves keeps the rays that it sends, as long as its id
  // and the settings stay.
  uint64_t id = 0;
};

SplatSource make_splat_source(const PunctualLight& light, uint64_t id);
// Every source of the tables, each once: punctual lights, runs of emitting triangles of one
// instance, the sky. Sources without power are left out.
std::vector<SplatSource> make_all_splat_sources(const Transport& transport);

// Flux that leaves a source, luminance, in watts; parallel light: what enters the scene. 0 of what
// is black, not finite or without extent.
float eval_source_power(const Transport& transport, const SplatSource& source);

}  // namespace wellspring::light
