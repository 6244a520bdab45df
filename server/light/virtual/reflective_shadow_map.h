// SPDX-License-Identifier: Apache-2.0
// Makes reflective shadow maps (Dachsbacher and Stamminger 2005) by rays: the surfaces each source
// sees, and the flux that is reflected there. A point light has the six faces of a cube, a spot the
// cap of its cone, parallel light an orthographic window around the scene, an emitting surface the
// hemispheres over its triangles. Thin panes are looked through and tint.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "light/random/sampler.h"
#include "light/sample/transport.h"
#include "light/transport_settings.h"
#include "world/scene.h"
#include "world/world.h"

namespace wellspring::light {

// Lists sources of light whose bounce is wanted: all of a scene, or those that move. A punctual
// light is held by value, so that one that is carried about need not be in the scene's tables.

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
  // Seeds its random numbers: a source that moves keeps the rays that it sends, as long as its id
  // and the settings stay.
  uint64_t id = 0;
};

SplatSource make_splat_source(const PunctualLight& light, uint64_t id);
// Returns every source of the tables, each once: punctual lights, runs of emitting triangles of one
// instance, the sky. Sources without power are left out.
std::vector<SplatSource> make_all_splat_sources(const Transport& transport);

// Returns the flux that leaves a source, luminance, in watts; for parallel light the flux that
// enters the scene. Returns 0 if the source is black, not finite or without extent.
float eval_source_power(const Transport& transport, const SplatSource& source);

// Aims rays from a source through the cells of its reflective shadow map. Cells of a map partition
// the light that the source emits: the ray goes anywhere within its cell, and the flux divided by
// the number of cells is an unbiased estimate of the cell's.

// Holds a source with what its rays have in common.
struct SourceAim {
  const Transport& transport;
  const SplatSource& source;
  vec3 along{0}, across{0}, axis{0, 0, -1};  // right-handed frame around its direction
  float outer = -1, scale = 1;               // spot: cosine, and fall-off as SpotCone has it
  vec3 corner{0}, width{0}, height{0};       // window of parallel light
  double power = 0;                          // power of the emitting triangles
  // Emitting triangles are chosen in their order by ascending numbers: the last choice and the
  // power before it.
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
// Returns the width over height of the window or cap.
float window_aspect(const Transport& transport, const SplatSource& source);
// Aims a ray through a cell. Cells of one row must be asked for in ascending order. `to.flux` and
// `to.spread` are as if the map were this cell alone.
void aim_at_cell(const SourceAim& aim, const MapCell& cell, Sampler& sampler, SourceRay& to);

struct ReflectiveTexel {
  vec3 position{0};
  float distance = 0;    // to the source; parallel light: to the start of its rays
  vec3 normal{0, 1, 0};  // geometric, on the side that is lit
  float area = 0;        // area of the surface that the texel stands for, square metres, about
  vec3 flux{0};          // reflected, watts; 0: nothing is there, or it reflects nothing
  float extent = 0;      // as SurfacePlace has it
};

// A map is kept from picture to picture, so that arrays are not made anew. Texels of a map follow
// each other along Morton's curve: neighbours in the list are neighbours in the map.
struct ReflectiveShadowMap {
  std::vector<ReflectiveTexel> texels;
  float mean_distance = 0;      // mean over texels with flux, of sources that have a position
  uint64_t rays = 0;            // rays cast for it
  std::vector<SourceRay> aims;  // one a texel: workspace
  std::vector<double> shares;
};

// Chooses the random numbers: with one seed, passes complement each other.
struct SplatSeed {
  uint64_t seed = 1;
  uint32_t pass = 0;
};

// Makes about settings.texels texels, shared among the sources by their power and its root; a
// source that would get less than one gets one at random, which then stands for more. Sources whose
// light is not finite are left out. Runs on all cores.
void make_reflective_shadow_map(const Transport& transport, std::span<const SplatSource> sources,
                                const SplatSettings& settings, SplatSeed seed,
                                ReflectiveShadowMap& map);

}  // namespace wellspring::light
