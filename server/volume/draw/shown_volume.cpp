// SPDX-License-Identifier: Apache-2.0
#include "volume/draw/shown_volume.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "base/parallel.h"
#include "image/srgb.h"

namespace wellspring::volume {
namespace {

constexpr int least_side = 16;  // samples; smaller levels are of no use

// Returns a channel of a colour as linear light.
double light_at(const Volume& volume, int x, int y, int z, int channel) {
  const double value = volume.at(x, y, z, channel);
  if (volume.kind == SampleKind::f32 || volume.kind == SampleKind::f64) return value;
  const double most = volume.kind == SampleKind::u8 ? 255 : 65535;
  return double(image::decode_srgb(uint8_t(std::clamp(255 * value / most, 0.0, 255.0))));
}

double measured_at(const Volume& volume, int x, int y, int z) {
  if (volume.channels == 1) return volume.at(x, y, z);
  double most = light_at(volume, x, y, z, 0);
  for (int channel = 1; channel < volume.channels; channel++)
    most = std::max(most, light_at(volume, x, y, z, channel));
  return most;
}

void add_colors(const Volume& volume, VolumeLevel& level) {
  for (std::vector<uint8_t>& plane : level.colors) plane.resize(level.codes.size());
  parallel_each(volume.size.z, [&](int z) {
    size_t index = size_t(z) * size_t(volume.size.x) * size_t(volume.size.y);
    for (int y = 0; y < volume.size.y; y++)
      for (int x = 0; x < volume.size.x; x++, index++) {
        const double most = measured_at(volume, x, y, z);
        for (int channel = 0; channel < 3; channel++) {
          const double share = most > 0 ? light_at(volume, x, y, z, channel) / most : 1;
          level.colors[channel][index] =
              uint8_t(std::lrint(255 * std::sqrt(std::clamp(share, 0.0, 1.0))));
        }
      }
  });
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
template <class Code>
std::vector<Code> halve(const std::vector<Code>& from, glm::ivec3 size) {
  const glm::ivec3 half = (size + 1) / 2;
  std::vector<Code> to(size_t(half.x) * size_t(half.y) * size_t(half.z));
  parallel_each(half.z, [&](int z) {
    for (int y = 0; y < half.y; y++)
      for (int x = 0; x < half.x; x++) {
        uint32_t sum = 0;
        for (int corner = 0; corner < 8; corner++) {
          const glm::ivec3 at = glm::min(
              2 * glm::ivec3(x, y, z) + glm::ivec3(corner & 1, corner >> 1 & 1, corner >> 2),
              size - 1);
          sum +=
              from[(size_t(at.z) * size_t(size.y) + size_t(at.y)) * size_t(size.x) + size_t(at.x)];
        }
        to[(size_t(z) * size_t(half.y) + size_t(y)) * size_t(half.x) + size_t(x)] =
            Code((sum + 4) / 8);
      }
  });
  return to;
}

VolumeLevel halve_level(const VolumeLevel& from) {
  VolumeLevel to;
  to.size = (from.size + 1) / 2;
  to.codes = halve(from.codes, from.size);
  for (size_t channel = 0; !from.colors[0].empty() && channel < 3; channel++)
    to.colors[channel] = halve(from.colors[channel], from.size);
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
  if (volume.channels == 3) add_colors(volume, finest);
  while (std::max({shown.levels.back().size.x, shown.levels.back().size.y,
                   shown.levels.back().size.z}) > 2 * least_side)
    shown.levels.push_back(halve_level(shown.levels.back()));
  for (VolumeLevel& level : shown.levels) add_normals_and_ranges(level);
  return shown;
}

}  // namespace wellspring::volume
