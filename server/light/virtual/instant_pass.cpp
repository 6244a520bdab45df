// SPDX-License-Identifier: Apache-2.0
#include "light/virtual/instant_pass.h"

#include <algorithm>
#include <bit>

namespace wellspring::light {
namespace {

constexpr uint32_t nowhere = 0xffffffffu;

void set(PhotonColumns3& columns, size_t i, vec3 v) {
  columns.x.values[i] = v.x, columns.y.values[i] = v.y, columns.z.values[i] = v.z;
}

}  // namespace

PhotonGrid make_photon_grid(const std::vector<Photon>& photons, float radius) {
  PhotonGrid grid;
  grid.radius = radius;
  grid.per_metre = 1 / (2.0 * double(radius));
  // Few photons share a bucket by chance, and the table stays in the cache.
  grid.mask = std::bit_ceil(uint32_t(std::max<size_t>(photons.size(), 16))) - 1;
  grid.first.assign(size_t(grid.mask) + 2, 0);
  std::vector<uint32_t> bucket(photons.size(), nowhere);
  for (size_t i = 0; i < photons.size(); i++) {
    if (!is_finite(photons[i].position) || !is_finite(photons[i].flux)) continue;
    dvec3 cell = glm::floor(in_photon_cells(grid, photons[i].position));
    bucket[i] = photon_bucket(grid, int64_t(cell.x), int64_t(cell.y), int64_t(cell.z));
    grid.first[bucket[i] + 1]++;
  }
  for (size_t b = 1; b < grid.first.size(); b++) grid.first[b] += grid.first[b - 1];
  size_t room = grid.first.back() + size_t(lane_count);
  for (PhotonColumns3* columns : {&grid.position, &grid.flux, &grid.direction, &grid.normal})
    for (PhotonColumn* column : {&columns->x, &columns->y, &columns->z})
      column->values.assign(room, 0.0f);
  grid.depth.values.assign(room, 0.0f);
  bool hued =
      std::any_of(photons.begin(), photons.end(), [](const Photon& p) { return p.hue >= 0; });
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

void find_photon_cells(const PhotonGrid& grid, vec3 place, PhotonCells& cells) {
  dvec3 corner = glm::floor(in_photon_cells(grid, place) - 0.5);
  if (cells.count >= 0 && corner.x == cells.x && corner.y == cells.y && corner.z == cells.z) return;
  cells.x = corner.x, cells.y = corner.y, cells.z = corner.z;
  cells.count = 0;
  int64_t x = int64_t(corner.x), y = int64_t(corner.y), z = int64_t(corner.z);
  for (int i = 0; i < 8; i++) {
    uint32_t bucket = photon_bucket(grid, x + (i & 1), y + (i >> 1 & 1), z + (i >> 2));
    uint32_t begin = grid.first[bucket], end = grid.first[bucket + 1];
    bool again = begin == end;  // the bucket is empty, or another cell's, too
    for (int k = 0; k < cells.count; k++) again |= cells.begin[k] == begin;
    if (again) continue;
    cells.begin[cells.count] = begin;
    cells.end[cells.count++] = end;
  }
}

}  // namespace wellspring::light
