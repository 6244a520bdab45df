// SPDX-License-Identifier: Apache-2.0
// Reflective shadow maps (Dachsbacher and Stamminger 2005) by rays: what each source sees, and the
// flux that is reflected there. A point light has the six faces of a cube, a spot the cap of its
// cone, parallel light an orthographic window around the scene, an emitting surface the hemispheres
// over its triangles. Thin panes are looked through and tint.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "light/splat/aim_source.h"
#include "light/transport_settings.h"
#include "world/world.h"

namespace wellspring::light {

struct ReflectiveTexel {
  vec3 position{0};
  float distance = 0;    // to the source; parallel light: to where its rays start
  vec3 normal{0, 1, 0};  // geometric, on the side that is lit
  float area = 0;        // of surface, square metres, that it stands for: about
  vec3 flux{0};          // reflected, watts; 0: nothing is there, or it reflects nothing
  float extent = 0;      // as SurfacePlace has it
};

// A source's texels: `faces` times rows times columns; of those from `first` on, `cells` says which
// is (face, row, column).
struct ReflectiveMap {
  uint32_t source = 0, first = 0, count = 0;
  int faces = 1, rows = 1, columns = 1;
};

// Kept from picture to picture, so that arrays are not made anew. Texels of a map follow each other
// along Morton's curve: neighbours in the list are neighbours in the map.
struct ReflectiveShadowMap {
  std::vector<ReflectiveTexel> texels;
  std::vector<ReflectiveMap> maps;
  std::vector<uint32_t> cells;
  float mean_distance = 0;      // of texels with flux, of sources that are somewhere
  uint64_t rays = 0;            // cast for it
  std::vector<SourceRay> aims;  // one a texel: workspace
  std::vector<double> shares;
};

// Which random numbers: of one seed, passes complement each other.
struct SplatSeed {
  uint64_t seed = 1;
  uint32_t pass = 0;
};

// About settings.texels texels, shared among the sources by their power and its root; a source that
// would get less than one gets one at random, and that one is worth more. Sources whose light is
// not finite are left out. All cores.
void make_reflective_shadow_map(const Transport& transport, std::span<const SplatSource> sources,
                                const SplatSettings& settings, SplatSeed seed,
                                ReflectiveShadowMap& map);

}  // namespace wellspring::light
