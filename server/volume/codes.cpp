// SPDX-License-Identifier: Apache-2.0
#include "volume/codes.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

}  // namespace

CodeScale code_scale_of(const Volume& volume) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::vector<CodeScale> slices(size_t(volume.size.z), {infinity, -infinity});
  parallel_each(volume.size.z, [&](int z) {
    CodeScale& range = slices[size_t(z)];
    for (int y = 0; y < volume.size.y; y++)
      for (int x = 0; x < volume.size.x; x++) {
        const double value = measured_at(volume, x, y, z);
        if (!std::isfinite(value)) continue;
        range.low = std::min(range.low, value), range.high = std::max(range.high, value);
      }
  });
  CodeScale all{infinity, -infinity};
  for (const CodeScale& one : slices)
    all.low = std::min(all.low, one.low), all.high = std::max(all.high, one.high);
  if (!(all.low <= all.high)) return {};
  if (all.low == all.high) all.high = all.low + std::max(1.0, std::abs(all.low) * 1e-6);
  return all;
}

void code_row(const Volume& volume, const CodeScale& scale, int y, int z, uint16_t* to) {
  for (int x = 0; x < volume.size.x; x++) {
    const double value = measured_at(volume, x, y, z);
    to[x] = std::isfinite(value) ? uint16_t(std::lrint(scale.code_of(value))) : uint16_t(0);
  }
}

void color_row(const Volume& volume, int channel, int y, int z, uint16_t* to) {
  for (int x = 0; x < volume.size.x; x++) {
    const double most = measured_at(volume, x, y, z);
    const double share = most > 0 ? light_at(volume, x, y, z, channel) / most : 1;
    to[x] = uint16_t(std::lrint(double(most_code) * std::sqrt(std::clamp(share, 0.0, 1.0))));
  }
}

std::vector<glm::ivec3> level_sizes(glm::ivec3 finest) {
  std::vector<glm::ivec3> sizes{finest};
  while (std::max({sizes.back().x, sizes.back().y, sizes.back().z}) > 2 * least_side)
    sizes.push_back((sizes.back() + 1) / 2);
  return sizes;
}

void halve_row(const uint16_t* front, const uint16_t* behind, glm::ivec2 size, int y,
               uint16_t* to) {
  const size_t near = size_t(2 * y) * size_t(size.x),
               far = size_t(std::min(2 * y + 1, size.y - 1)) * size_t(size.x);
  for (int x = 0; x < (size.x + 1) / 2; x++) {
    const size_t left = size_t(2 * x), right = size_t(std::min(2 * x + 1, size.x - 1));
    uint32_t sum = 4;
    for (const uint16_t* slice : {front, behind})
      for (const size_t row : {near, far}) sum += slice[row + left] + uint32_t(slice[row + right]);
    to[x] = uint16_t(sum / 8);
  }
}

void find_ranges(std::span<const uint16_t* const> slices, glm::ivec2 size, CodeRange* to) {
  const glm::ivec3 cells = cells_of({size, 1});
  for (int cy = 0; cy < cells.y; cy++)
    for (int cx = 0; cx < cells.x; cx++) {
      const glm::ivec2 from = glm::ivec2(cx, cy) * cell_side;
      const glm::ivec2 end = glm::min(from + cell_side + 1, size);
      CodeRange range;
      for (const uint16_t* slice : slices)
        for (int y = from.y; y < end.y; y++) {
          const uint16_t* row = slice + size_t(y) * size_t(size.x);
          for (int x = from.x; x < end.x; x++)
            range = {std::min(range.least, row[x]), std::max(range.most, row[x])};
        }
      *to++ = range;
    }
}

}  // namespace wellspring::volume
