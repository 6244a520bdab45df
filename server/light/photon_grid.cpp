// SPDX-License-Identifier: Apache-2.0
#include "light/photon_grid.h"

#include <algorithm>
#include <bit>

namespace wellspring {
namespace {

constexpr uint32_t nowhere = 0xffffffffu;

void set(PhotonColumns3& columns, size_t i, vec3 v) {
  columns.x.values[i] = v.x, columns.y.values[i] = v.y, columns.z.values[i] = v.z;
}

}  // namespace

PhotonGrid make_photon_grid(const std::vector<Photon>& photons, float radius) {
  PhotonGrid grid;
  grid.radius = radius;
  // Few photons share a bucket by chance, and the table stays in the cache.
  grid.mask = std::bit_ceil(uint32_t(std::max<size_t>(photons.size(), 16))) - 1;
  grid.first.assign(size_t(grid.mask) + 2, 0);
  std::vector<uint32_t> bucket(photons.size(), nowhere);
  for (size_t i = 0; i < photons.size(); i++) {
    if (!is_finite(photons[i].position) || !is_finite(photons[i].flux)) continue;
    dvec3 cell = glm::floor(dvec3(photons[i].position) / (2.0 * double(radius)));
    bucket[i] = photon_bucket(grid, int64_t(cell.x), int64_t(cell.y), int64_t(cell.z));
    grid.first[bucket[i] + 1]++;
  }
  for (size_t b = 1; b < grid.first.size(); b++) grid.first[b] += grid.first[b - 1];
  size_t room = grid.first.back() + size_t(lane_count);
  for (PhotonColumns3* columns : {&grid.position, &grid.flux, &grid.direction, &grid.normal})
    for (PhotonColumn* column : {&columns->x, &columns->y, &columns->z})
      column->values.assign(room, 0.0f);
  grid.depth.values.assign(room, 0.0f);
  bool hued = std::any_of(photons.begin(), photons.end(), [](const Photon& p) { return p.hue >= 0; });
  if (hued) grid.hue.values.assign(room, -1.0f);
  std::vector<uint32_t> next(grid.first.begin(), grid.first.end() - 1);
  for (size_t i = 0; i < photons.size(); i++) {
    if (bucket[i] == nowhere) continue;
    size_t at = next[bucket[i]]++;
    set(grid.position, at, photons[i].position);
    set(grid.flux, at, photons[i].flux);
    set(grid.direction, at, photons[i].direction);
    set(grid.normal, at, photons[i].normal);
    grid.depth.values[at] = float(photons[i].depth);
    if (hued) grid.hue.values[at] = photons[i].hue;
  }
  return grid;
}

}  // namespace wellspring
