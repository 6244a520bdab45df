// SPDX-License-Identifier: Apache-2.0
// Holds what instant radiosity draws for one pass over a picture: sets of VPLs, the lights
// that each region asks, and the photon map of caustics.
#pragma once
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "base/simd.h"
#include "base/vec.h"
#include "light/transport_settings.h"
#include "light/walk/light_walk.h"

namespace wellspring::light {

// Finds photons by place in a grid of cells twice the query's radius wide, hashed, so that a query
// reads 8 cells and nothing is stored for empty ones (Wald et al. 2002, section 4.1). The radius is
// fixed when the grid is made. Photons lie side by side, cell by cell, and are read eight at a
// time.

struct Photon {
  vec3 position{0};
  uint32_t depth = 1;  // path edges from the source, without those in solid glass
  vec3 flux{0};
  vec3 direction{0};     // unit, to where the photon came from
  vec3 normal{0, 1, 0};  // geometric normal of the surface that the photon hit
  float hue = -1;        // hue_of its walk; `flux` has that colour
};

// Holds one number of every photon, and eight more that may be read.
struct PhotonColumn {
  std::vector<float> values;
  Lanes at(size_t i) const { return load_lanes(&values[i]); }
};
struct PhotonColumns3 {
  PhotonColumn x, y, z;
  vec3 at(size_t i) const { return {x.values[i], y.values[i], z.values[i]}; }
};

struct PhotonGrid {
  float radius = 0;
  double per_metre = 0;         // cells per metre
  uint32_t mask = 0;            // buckets - 1
  std::vector<uint32_t> first;  // first photon of each bucket, and the end
  // The photons' columns, bucket by bucket.
  PhotonColumns3 position, flux, direction, normal;
  PhotonColumn depth;
  PhotonColumn hue;  // empty: no photon has a hue
  size_t size() const { return first.empty() ? 0 : first.back(); }
  Photon photon(size_t i) const {
    return {position.at(i), uint32_t(depth.values[i]),
            flux.at(i),     direction.at(i),
            normal.at(i),   hue.values.empty() ? -1.0f : hue.values[i]};
  }
};

// Makes a grid of photons; those whose place or flux is not finite are left out. `radius` > 0.
PhotonGrid make_photon_grid(const std::vector<Photon>& photons, float radius);

// Returns a place, counted in cells.
inline dvec3 in_photon_cells(const PhotonGrid& grid, vec3 place) {
  return dvec3(place) * grid.per_metre;
}
inline uint32_t photon_bucket(const PhotonGrid& grid, int64_t x, int64_t y, int64_t z) {
  uint64_t hash = uint64_t(x) * 0x9e3779b97f4a7c15ull ^ uint64_t(y) * 0xc2b2ae3d27d4eb4full ^
                  uint64_t(z) * 0x165667b19e3779f9ull;
  return uint32_t((hash ^ hash >> 32) * 0xd6e8feb86659fd93ull >> 32) & grid.mask;
}

// Holds the photons around places between the same eight cells' middles. Neighbouring places mostly
// have the same ones, so a caller that looks for many in a row keeps this.
struct PhotonCells {
  double x, y, z;  // coordinates of the first cell
  int count = -1;  // runs of photons; -1: none looked for yet
  uint32_t begin[8], end[8];
};
// Makes `cells` the cells around a finite place.
void find_photon_cells(const PhotonGrid& grid, vec3 place, PhotonCells& cells);

// Calls visit(at, within) for eights of photons from number `at` on, which have each photon within
// the radius of `place` once: in the lanes of `within` that are not 0.
template <class Visit>
void for_each_photons(const PhotonGrid& grid, vec3 place, PhotonCells& cells, const Visit& visit) {
  if (grid.size() == 0 || !is_finite(place)) return;
  find_photon_cells(grid, place, cells);
  float radius2 = grid.radius * grid.radius;
  const LaneMask lane = {0, 1, 2, 3, 4, 5, 6, 7};
  for (int i = 0; i < cells.count; i++)
    for (uint32_t p = cells.begin[i], end = cells.end[i]; p < end; p += lane_count) {
      Lanes dx = grid.position.x.at(p) - place.x, dy = grid.position.y.at(p) - place.y,
            dz = grid.position.z.at(p) - place.z;
      LaneMask within = (dx * dx + dy * dy + dz * dz <= radius2) & (lane < int(end - p));
      if (negative_lanes(within)) visit(size_t(p), within);
    }
}

// Calls visit(photon) once for each photon within the radius of `place`.
template <class Visit>
void for_each_photon(const PhotonGrid& grid, vec3 place, PhotonCells& cells, const Visit& visit) {
  for_each_photons(grid, place, cells, [&](size_t at, LaneMask within) {
    for (int i = 0; i < lane_count; i++)
      if (within[i]) visit(grid.photon(at + size_t(i)));
  });
}

enum class PointLightKind : uint8_t {
  lambertian,  // by Lambert's law: area light, or light scattered by a Lambertian surface
  scattering,  // by the bsdf of its arrival
  distant,     // light from infinity
  punctual,    // a punctual light of the scene
};

struct PointLight {
  PointLightKind kind = PointLightKind::lambertian;
  bool double_sided = false;
  bool exact = false;    // in every set alike: its light needs no filter
  uint16_t depth = 0;    // path edges from the source
  uint32_t index = 0;    // index of its arrival or punctual light
  vec3 position{0};      // distant: unit direction to it
  vec3 normal{0, 1, 0};  // geometric
  vec3 target{0};        // a shadow ray ends here, clear of the surface
  vec3 radiance{0};      // Lambertian: intensity at cosine 1; scattering: flux; else a factor
  float hue = -1;        // hue_of its walk; `radiance` has that colour
};

// A point light that a region of the picture asks (region_lights.h).
struct RegionLight {
  uint32_t light = 0;  // index in the pass
  float factor = 1;    // factor on the light's radiance
};
struct RegionLights {
  static constexpr int across = 4;  // pixels of one list in a row of a region: 16 are a packet
  static constexpr int finer =
      2;                        // lists interleave as sets do, in a pattern so many times as wide
  int width = 0, height = 0;    // pixels of a region
  int columns = 0;              // 0: no regions, every pixel asks its whole set
  std::vector<uint32_t> first;  // index in `lights` of each region * lists + list, and the end
  std::vector<RegionLight> lights;
};

struct LightLanes;  // virtual_lights.h

// Holds what one pass has drawn.
struct InstantPass {
  int columns = 1, rows = 1, width = 1;  // sets, and pixels in a row of the picture
  float clip = 0;
  bool compensate = false, sharp = false;  // sharp: caustics can exist
  std::vector<PointLight> lights;          // set by set, depths ascending in a set
  std::vector<uint32_t> first;             // index in `lights` of each set, and the end
  std::vector<Arrival> arrivals;
  std::shared_ptr<const LightLanes> lanes;  // lanes of all lights
  RegionLights regions;
  std::vector<PhotonGrid> photons;  // one for each set; none without caustics
  // The pass was drawn with these.
  TransportSettings settings;
  uint64_t seed = 0;
  uint32_t index = 0;
  int sets() const { return columns * rows; }
  int lists() const { return sets() * RegionLights::finer * RegionLights::finer; }
};

// Returns the list of a pixel among those of its region.
inline int list_of_pixel(const InstantPass& pass, uint32_t pixel) {
  int x = int(pixel % uint32_t(pass.width)), y = int(pixel / uint32_t(pass.width));
  int columns = pass.columns * RegionLights::finer, rows = pass.rows * RegionLights::finer;
  return y % rows * columns + x % columns;
}
inline int set_of_list(const InstantPass& pass, int list) {
  int columns = pass.columns * RegionLights::finer;
  return list / columns % pass.rows * pass.columns + list % columns % pass.columns;
}

// Returns the region that a pixel is in; -1: there are none.
inline int region_of_pixel(const InstantPass& pass, uint32_t pixel) {
  const RegionLights& regions = pass.regions;
  if (regions.columns == 0) return -1;
  int x = int(pixel % uint32_t(pass.width)), y = int(pixel / uint32_t(pass.width));
  size_t region = size_t(y / regions.height * regions.columns + x / regions.width);
  return (region + 1) * size_t(pass.lists()) < regions.first.size() ? int(region) : -1;
}

}  // namespace wellspring::light
