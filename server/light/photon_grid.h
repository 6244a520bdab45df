// SPDX-License-Identifier: Apache-2.0
// Photons found by place: a grid of cells twice the query's radius wide, hashed, so that a query looks
// at 8 cells and nothing is stored for empty ones (Wald et al. 2002, section 4.1). The radius is fixed
// when the grid is made.
#pragma once
#include <cmath>
#include <cstdint>
#include <vector>

#include "base/vec.h"

namespace wellspring {

struct Photon {
  vec3 position{0};
  uint32_t depth = 1;    // edges from the source
  vec3 flux{0};
  vec3 direction{0};     // to where it came from
  vec3 normal{0, 1, 0};  // geometric, of the surface it hit
};

struct PhotonGrid {
  float radius = 0;
  uint32_t mask = 0;            // buckets - 1
  std::vector<uint32_t> first;  // of each bucket, and the end
  std::vector<Photon> photons;  // bucket by bucket
};

// Photons that are nowhere (not finite) are left out. `radius` > 0.
PhotonGrid make_photon_grid(const std::vector<Photon>& photons, float radius);

inline uint32_t photon_bucket(const PhotonGrid& grid, int64_t x, int64_t y, int64_t z) {
  uint64_t hash = uint64_t(x) * 0x9e3779b97f4a7c15ull ^ uint64_t(y) * 0xc2b2ae3d27d4eb4full ^
                  uint64_t(z) * 0x165667b19e3779f9ull;
  return uint32_t((hash ^ hash >> 32) * 0xd6e8feb86659fd93ull >> 32) & grid.mask;
}

// visit(photon) for each within the radius of `place`, each once.
template <class Visit>
void for_each_photon(const PhotonGrid& grid, vec3 place, const Visit& visit) {
  if (grid.photons.empty() || !is_finite(place)) return;
  dvec3 corner = glm::floor(dvec3(place) / (2.0 * double(grid.radius)) - 0.5);
  int64_t x = int64_t(corner.x), y = int64_t(corner.y), z = int64_t(corner.z);
  uint32_t seen[8];
  float radius2 = grid.radius * grid.radius;
  for (int i = 0; i < 8; i++) {
    uint32_t bucket = photon_bucket(grid, x + (i & 1), y + (i >> 1 & 1), z + (i >> 2));
    seen[i] = bucket;
    bool again = false;  // cells may share a bucket
    for (int k = 0; k < i; k++) again |= seen[k] == bucket;
    if (again) continue;
    for (uint32_t p = grid.first[bucket]; p < grid.first[bucket + 1]; p++) {
      vec3 d = grid.photons[p].position - place;
      if (dot(d, d) <= radius2) visit(grid.photons[p]);
    }
  }
}

}  // namespace wellspring
