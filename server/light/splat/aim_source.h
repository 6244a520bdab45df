// SPDX-License-Identifier: Apache-2.0
// Rays from a source through the cells of its reflective shadow map. Cells of a map partition what
// the source emits: the ray goes anywhere within its cell, and the flux divided by the number of
// cells is an unbiased estimate of the cell's.
#pragma once
#include "light/random/sampler.h"
#include "light/splat/splat_sources.h"
#include "world/world.h"

namespace wellspring::light {

// A source with what its rays have in common.
struct SourceAim {
  const Transport& transport;
  const SplatSource& source;
  vec3 along{0}, across{0}, axis{0, 0, -1};  // right-handed frame around its direction
  float outer = -1, scale = 1;               // of a spot: cosine, and fall-off as SpotCone has it
  vec3 corner{0}, width{0}, height{0};       // window of parallel light
  double power = 0;                          // of emitting triangles
  // Emitting triangles are chosen in their order by ascending numbers: where the last choice was.
  mutable uint32_t next = 0;
  mutable double passed = 0;
};
struct SourceRay {
  Ray ray;
  vec3 flux{0};
  float range = 0, spread = 0;  // spread: steradians, or square metres of parallel light
  bool parallel = false;
};
struct MapCell {
  int face, row, column, rows, columns, faces;
};

SourceAim aim_source(const Transport& transport, const SplatSource& source);
// Width over height of the window or cap.
float window_aspect(const Transport& transport, const SplatSource& source);
// Cells of one row must be asked for in ascending order. `to.flux` and `to.spread`: as if the map
// were this cell alone.
void aim_at_cell(const SourceAim& aim, const MapCell& cell, Sampler& sampler, SourceRay& to);

}  // namespace wellspring::light
