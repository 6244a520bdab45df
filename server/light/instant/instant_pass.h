// SPDX-License-Identifier: Apache-2.0
// What instant radiosity draws for one pass over a picture: sets of point lights, which of them
// each region asks, and photons.
#pragma once
#include <memory>
#include <vector>

#include "light/instant/photon_grid.h"
#include "light/transport_settings.h"
#include "light/walk/light_walk.h"

namespace wellspring::light {

enum class PointLightKind : uint8_t {
  lambertian,  // as seen by Lambert: area light, or light scattered by a Lambertian surface
  scattering,  // whatever the surface does: `arrival`
  distant,     // from infinity
  punctual,    // of the scene
};

struct PointLight {
  PointLightKind kind = PointLightKind::lambertian;
  bool double_sided = false;
  bool exact = false;    // in every set alike: what it lights needs no filter
  uint16_t depth = 0;    // edges from the source
  uint32_t index = 0;    // of what its kind needs: arrival or punctual light
  vec3 position{0};      // distant: unit direction to it
  vec3 normal{0, 1, 0};  // geometric
  vec3 target{0};        // a shadow ray ends here, clear of the surface
  vec3 radiance{0};      // Lambertian: intensity at cosine 1; scattering: flux; else a factor
  float hue = -1;        // hue_of its walk; `radiance` has that colour
};

// Point lights that each region of the picture asks (region_lights.h).
struct RegionLight {
  uint32_t light = 0;  // of the pass
  float factor = 1;    // on its radiance
};
struct RegionLights {
  static constexpr int across = 4;  // pixels of one list in a row of a region: 16 are a packet
  static constexpr int finer =
      2;                        // lists interleave as sets do, in a pattern so many times as wide
  int width = 0, height = 0;    // pixels of a region
  int columns = 0;              // 0: no regions, every pixel asks its whole set
  std::vector<uint32_t> first;  // of region * lists + list, and the end
  std::vector<RegionLight> lights;
};

struct LightLanes;  // light_lanes.h

// What one pass has drawn.
struct InstantPass {
  int columns = 1, rows = 1, width = 1;  // sets, and pixels in a row of the picture
  float clip = 0;
  bool compensate = false, sharp = false;  // sharp: caustics can exist
  std::vector<PointLight> lights;          // set by set, depths ascending in a set
  std::vector<uint32_t> first;             // of each set, and the end
  std::vector<Arrival> arrivals;
  std::shared_ptr<const LightLanes> lanes;  // of all lights
  RegionLights regions;
  std::vector<PhotonGrid> photons;  // of each set; none without caustics
  // What it was drawn with.
  TransportSettings settings;
  uint64_t seed = 0;
  uint32_t index = 0;
  int sets() const { return columns * rows; }
  int lists() const { return sets() * RegionLights::finer * RegionLights::finer; }
};

// The list of a pixel among those of its region.
inline int list_of_pixel(const InstantPass& pass, uint32_t pixel) {
  int x = int(pixel % uint32_t(pass.width)), y = int(pixel / uint32_t(pass.width));
  int columns = pass.columns * RegionLights::finer, rows = pass.rows * RegionLights::finer;
  return y % rows * columns + x % columns;
}
inline int set_of_list(const InstantPass& pass, int list) {
  int columns = pass.columns * RegionLights::finer;
  return list / columns % pass.rows * pass.columns + list % columns % pass.columns;
}

// The region that a pixel is in; -1: there are none.
inline int region_of_pixel(const InstantPass& pass, uint32_t pixel) {
  const RegionLights& regions = pass.regions;
  if (regions.columns == 0) return -1;
  int x = int(pixel % uint32_t(pass.width)), y = int(pixel / uint32_t(pass.width));
  size_t region = size_t(y / regions.height * regions.columns + x / regions.width);
  return (region + 1) * size_t(pass.lists()) < regions.first.size() ? int(region) : -1;
}

}  // namespace wellspring::light
