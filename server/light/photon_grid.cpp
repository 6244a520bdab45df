// SPDX-License-Identifier: Apache-2.0
#include "light/photon_grid.h"

#include <bit>

namespace wellspring {

PhotonGrid make_photon_grid(const std::vector<Photon>& photons, float radius) {
  PhotonGrid grid;
  grid.radius = radius;
  // Few photons share a bucket by chance, and the table stays in the cache.
  grid.mask = std::bit_ceil(uint32_t(std::max<size_t>(photons.size(), 16))) - 1;
  grid.first.assign(size_t(grid.mask) + 2, 0);
  constexpr uint32_t nowhere = 0xffffffffu;
  std::vector<uint32_t> bucket(photons.size(), nowhere);
  for (size_t i = 0; i < photons.size(); i++) {
    if (!is_finite(photons[i].position) || !is_finite(photons[i].flux)) continue;
    dvec3 cell = glm::floor(dvec3(photons[i].position) / (2.0 * double(radius)));
    bucket[i] = photon_bucket(grid, int64_t(cell.x), int64_t(cell.y), int64_t(cell.z));
    grid.first[bucket[i] + 1]++;
  }
  for (size_t b = 1; b < grid.first.size(); b++) grid.first[b] += grid.first[b - 1];
  grid.photons.resize(grid.first.back());
  std::vector<uint32_t> next(grid.first.begin(), grid.first.end() - 1);
  for (size_t i = 0; i < photons.size(); i++)
    if (bucket[i] != nowhere) grid.photons[next[bucket[i]]++] = photons[i];
  return grid;
}

}  // namespace wellspring
