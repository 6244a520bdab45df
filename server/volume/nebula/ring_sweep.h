// SPDX-License-Identifier: Apache-2.0
// Runs over a ring matrix once for both of its products, so that each row is read from memory once.
#pragma once
#include <span>
#include <vector>

#include "base/parallel.h"
#include "volume/nebula/rings.h"

namespace wellspring::volume {

inline ColorLanes all_colors(double value) { return ColorLanes{value, value, value, 0}; }

// Returns what a row's ray gathers.
inline ColorLanes gather_row(const RingRows& rows, size_t row, const ColorLanes* light) {
  const float* length = rows.length.data();
  const uint16_t* ring = rows.ring.data();
  const uint32_t end = rows.begin[row + 1];
  uint32_t i = rows.begin[row];
  ColorLanes sum[4]{};
  for (; i + 4 <= end; i += 4)
    for (uint32_t k = 0; k < 4; ++k) sum[k] += double(length[i + k]) * light[ring[i + k]];
  for (; i < end; ++i) sum[0] += double(length[i]) * light[ring[i]];
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

inline void spread_row(const RingRows& rows, size_t row, ColorLanes value, ColorLanes* back) {
  const float* length = rows.length.data();
  const uint16_t* ring = rows.ring.data();
  for (uint32_t i = rows.begin[row]; i < rows.begin[row + 1]; ++i)
    back[ring[i]] += double(length[i]) * value;
}

// Returns A times the light: what each ray gathers.
std::vector<ColorLanes> gather_rays(const RingSystem& system, std::span<const ColorLanes> light);

// Keeps the memory of sweeps from one to the next.
struct RingSweep {
  std::vector<std::vector<ColorLanes>> parts;  // for each piece of the matrix
  std::vector<ColorLanes> back;                // the sum of the transposed product
};

// Sets `sweep.back` to the transposed matrix times what `answer(ray, gathered)` returns for every
// ray, where `gathered` is A times `light` there; it is 0 if `light` is empty. Calls of different
// rays run at the same time.
template <class Answer>
void sweep_rings(RingSweep& sweep, const RingSystem& system, std::span<const ColorLanes> light,
                 const Answer& answer) {
  const size_t rings = size_t(system.grid.count());
  sweep.parts.resize(system.pieces.size());
  parallel_each(int(system.pieces.size()), [&](int piece) {
    const RingRows& rows = system.pieces[size_t(piece)];
    std::vector<ColorLanes>& part = sweep.parts[size_t(piece)];
    part.assign(rings, ColorLanes{});
    for (size_t row = 0; row + 1 < rows.begin.size(); ++row) {
      const ColorLanes gathered =
          light.empty() ? ColorLanes{} : gather_row(rows, row, light.data());
      spread_row(rows, row, answer(size_t(rows.first_ray) + row, gathered), part.data());
    }
  });
  sweep.back.assign(rings, ColorLanes{});
  for (const std::vector<ColorLanes>& part : sweep.parts)
    for (size_t i = 0; i < rings; ++i) sweep.back[i] += part[i];
}

}  // namespace wellspring::volume
