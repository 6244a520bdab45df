// SPDX-License-Identifier: Apache-2.0
#include "volume/draw/shown_volume.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "base/parallel.h"

namespace wellspring::volume {
namespace {

constexpr int least_side = 16;  // samples; smaller levels are of no use

double measured_at(const Volume& volume, int x, int y, int z) {
  double sum = 0;
  for (int channel = 0; channel < volume.channels; channel++) sum += volume.at(x, y, z, channel);
  return sum / volume.channels;
}

// Returns the least and the largest finite value.
std::pair<double, double> range_of(const Volume& volume) {
  struct Range {
    double low = std::numeric_limits<double>::infinity(), high = -low;
  };
  std::vector<Range> ranges(size_t(volume.size.z));
  parallel_each(volume.size.z, [&](int z) {
    Range& range = ranges[size_t(z)];
    for (int y = 0; y < volume.size.y; y++)
      for (int x = 0; x < volume.size.x; x++) {
        const double value = measured_at(volume, x, y, z);
        if (!std::isfinite(value)) continue;
        range.low = std::min(range.low, value), range.high = std::max(range.high, value);
      }
  });
  Range all;
  for (const Range& one : ranges)
    all.low = std::min(all.low, one.low), all.high = std::max(all.high, one.high);
  if (!(all.low <= all.high)) return {0, 1};
  if (all.low == all.high) all.high = all.low + std::max(1.0, std::abs(all.low) * 1e-6);
  return {all.low, all.high};
}

void add_normals_and_ranges(VolumeLevel& level) {
  Grid grid(level.size);
  std::ranges::copy(level.codes, grid.values.begin());
  level.normals = make_normals(grid);
  level.cells = (level.size + cell_side - 1) / cell_side;
  level.ranges.assign(size_t(level.cells.x) * size_t(level.cells.y) * size_t(level.cells.z), {});
  parallel_each(level.cells.z, [&](int cz) {
    for (int cy = 0; cy < level.cells.y; cy++)
      for (int cx = 0; cx < level.cells.x; cx++) {
        const glm::ivec3 cell(cx, cy, cz);
        const glm::ivec3 from = cell * cell_side;
        const glm::ivec3 to = glm::min(from + cell_side + 1, level.size);
        CodeRange range;
        for (int z = from.z; z < to.z; z++)
          for (int y = from.y; y < to.y; y++) {
            const uint16_t* row = &level.codes[grid.index(0, y, z)];
            for (int x = from.x; x < to.x; x++)
              range = {std::min(range.least, row[x]), std::max(range.most, row[x])};
          }
        level.ranges[(size_t(cz) * size_t(level.cells.y) + size_t(cy)) * size_t(level.cells.x) +
                     size_t(cx)] = range;
      }
  });
}

// Averages boxes of 2 x 2 x 2 samples; where a side is odd, the last sample counts twice.
VolumeLevel halve_level(const VolumeLevel& from) {
  VolumeLevel to;
  to.size = (from.size + 1) / 2;
  to.codes.resize(size_t(to.size.x) * size_t(to.size.y) * size_t(to.size.z));
  parallel_each(to.size.z, [&](int z) {
    for (int y = 0; y < to.size.y; y++)
      for (int x = 0; x < to.size.x; x++) {
        uint32_t sum = 0;
        for (int corner = 0; corner < 8; corner++) {
          const glm::ivec3 at = glm::min(
              2 * glm::ivec3(x, y, z) + glm::ivec3(corner & 1, corner >> 1 & 1, corner >> 2),
              from.size - 1);
          sum +=
              from.codes[(size_t(at.z) * size_t(from.size.y) + size_t(at.y)) * size_t(from.size.x) +
                         size_t(at.x)];
        }
        to.codes[(size_t(z) * size_t(to.size.y) + size_t(y)) * size_t(to.size.x) + size_t(x)] =
            uint16_t((sum + 4) / 8);
      }
  });
  return to;
}

}  // namespace

ShownVolume make_shown_volume(const Volume& volume) {
  if (volume.samples() >= size_t(1) << 31)
    throw std::length_error("a volume of 2^31 samples or more cannot be shown");
  ShownVolume shown;
  shown.to_metres = volume.to_metres;
  shown.voxel = std::min({glm::length(glm::dvec3(volume.to_metres[0])),
                          glm::length(glm::dvec3(volume.to_metres[1])),
                          glm::length(glm::dvec3(volume.to_metres[2]))});
  std::tie(shown.low, shown.high) = range_of(volume);
  VolumeLevel& finest = shown.levels.emplace_back();
  finest.size = volume.size;
  finest.codes.resize(volume.samples());
  parallel_each(volume.size.z, [&](int z) {
    size_t index = size_t(z) * size_t(volume.size.x) * size_t(volume.size.y);
    for (int y = 0; y < volume.size.y; y++)
      for (int x = 0; x < volume.size.x; x++, index++) {
        const double value = measured_at(volume, x, y, z);
        finest.codes[index] =
            std::isfinite(value) ? uint16_t(std::lrint(shown.code_of(value))) : uint16_t(0);
      }
  });
  while (std::max({shown.levels.back().size.x, shown.levels.back().size.y,
                   shown.levels.back().size.z}) > 2 * least_side)
    shown.levels.push_back(halve_level(shown.levels.back()));
  for (VolumeLevel& level : shown.levels) add_normals_and_ranges(level);
  return shown;
}

}  // namespace wellspring::volume
