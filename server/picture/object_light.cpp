// SPDX-License-Identifier: Apache-2.0
#include "picture/object_light.h"

#include <bit>

namespace wellspring {
namespace {

// Cells to each side. Most find their object near; only for others more is read.
constexpr int nearest = 3, farthest = 6;
static_assert(farthest <= cell_pad && 2 * farthest + 1 <= 2 * lane_count);
constexpr float far_weight = 0.02f;   // what those count for that near ones are not enough for
constexpr float near_enough = 0.02f;  // weight
constexpr float turned_away = 0.05f;  // what such cells count for
constexpr float most_samples = 16, no_sample = 0.1f;  // likewise of many and of what was filled in

// Bit k: the cell at index i + k shows it, or anything.
unsigned find_cells(const Cells& cells, size_t i, int count, uint32_t object, LightOf of) {
  unsigned found = 0;
  for (int half = 0; half * lane_count < count; half++) {
    LaneBits theirs = load_lanes<LaneBits>(&cells.object[i + size_t(half * lane_count)]);
    LaneMask use =
        of == LightOf::any_object ? LaneMask(theirs != no_object) : LaneMask(theirs == object);
    found |= negative_lanes(use) << half * lane_count;
  }
  return found & ((1u << count) - 1);
}

// Of cells `around`, for the lanes `asked`.
void add_window(const Cells& cells, const CellPlaces& at, const Pixels& p,
                const Lanes& inverse_normal2, LaneMask asked, const LaneMask& mirrors, LightOf of,
                int around, float scale, Surroundings& sum, Lanes& all) {
  float share = 1 / float((around - 1) * (around - 1));  // since pixels' columns differ by one
  int column = std::clamp(int(std::floor(at.x[lane_count / 2])), 0, cells.width - 1),
      row = int(std::floor(at.y + 0.5f));
  int top = std::max(row - around, 0), bottom = std::min(row + around, cells.height - 1);
  for (unsigned left = negative_lanes(asked); left != 0;) {
    uint32_t object = p.object[std::countr_zero(left)];
    LaneMask here = of == LightOf::any_object ? asked : asked & (p.object == object);
    left &= ~negative_lanes(here);
    for (int y = top; y <= bottom; y++) {
      size_t first = size_t(cells.index(column - around, y));
      unsigned found = find_cells(cells, first, 2 * around + 1, object, of);
      for (; found != 0; found &= found - 1) {
        int k = std::countr_zero(found);
        size_t i = first + size_t(k);
        Lanes dx = at.x - float(column - around + k);
        float dy = at.y - float(y);
        Lanes distance2 = dx * dx + dy * dy, fade = positive_lanes(1.0f - distance2 * share);
        Lanes facing = positive_lanes(cells.normal[0][i] * p.nx + cells.normal[1][i] * p.ny +
                                      cells.normal[2][i] * p.nz);
        Lanes weight = fade * fade / (0.5f + distance2) *
                       (turned_away + facing * facing * inverse_normal2) *
                       (scale * (no_sample + std::min(cells.samples[i], most_samples)));
        float albedo[3], smooth[3], rest[3];
        for (size_t c = 0; c < 3; c++) {
          albedo[c] = cells.albedo[c][i], smooth[c] = cells.smooth[c][i];
          rest[c] = cells.rest[c][i];
        }
        bool dark = albedo[0] + albedo[1] + albedo[2] < no_reflectance;
        if (dark) weight = keep_lanes(mirrors & (p.object == cells.object[i]), weight);
        else
          for (int c = 0; c < 3; c++) rest[c] = std::min(rest[c], most_rest * smooth[c]);
        weight = keep_lanes(here, weight);
        add(sum.smooth, weight, smooth[0], smooth[1], smooth[2]);
        add(sum.rest, weight, rest[0], rest[1], rest[2]);
        add(sum.albedo, weight, albedo[0], albedo[1], albedo[2]);
        all += weight;
      }
    }
  }
}

}  // namespace

Lanes add_object_light(const Cells& cells, const CellPlaces& at, const Pixels& p,
                       const LaneMask& asked, const LaneMask& mirrors, LightOf of,
                       Surroundings& sum) {
  Lanes all{}, inverse_normal2 = 1.0f / p.normal2;
  add_window(cells, at, p, inverse_normal2, asked, mirrors, of, nearest, 1, sum, all);
  LaneMask more = asked & (all < near_enough);
  if (any_lane(more))
    add_window(cells, at, p, inverse_normal2, more, mirrors, of, farthest, far_weight, sum, all);
  return all;
}

}  // namespace wellspring
