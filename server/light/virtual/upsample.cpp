// SPDX-License-Identifier: Apache-2.0
#include "light/virtual/upsample.h"

#include <algorithm>

#include "base/parallel.h"
#include "base/simd.h"

namespace wellspring::light {
namespace {

constexpr int steps[8][2] = {{-1, -1}, {0, -1}, {1, -1}, {-1, 0}, {1, 0}, {-1, 1}, {0, 1}, {1, 1}};

int number_of(int dx, int dy) {
  for (int k = 0; k < 8; k++)
    if (steps[k][0] == dx && steps[k][1] == dy) return k;
  return 0;
}

// Sets bit k of each texel that may be mixed with its neighbour k.
void join_texels(const MinMaxPyramid& pyramid, const SplatSettings& settings, int level,
                 const IlluminationLevel& light, RawVector<uint8_t>& joined) {
  const size_t count = size_t(light.columns) * size_t(light.rows);
  if (joined.size() < count) joined.resize(count);
  parallel_ranges(light.rows, 8, [&](int begin, int end) {
    for (int y = begin; y < end; y++)
      for (int x = 0; x < light.columns; x++) {
        uint8_t bits = 0;
        if (light.at(x, y).held > 0) {
          const MinMaxCell& own = pyramid.at(level, x, y);
          for (int k = 0; k < 8; k++) {
            int i = x + steps[k][0], j = y + steps[k][1];
            if (i < 0 || j < 0 || i >= light.columns || j >= light.rows) continue;
            if (!(light.at(i, j).held > 0)) continue;
            if (!is_discontinuous(join_cells(own, pyramid.at(level, i, j)), settings))
              bits |= uint8_t(1 << k);
          }
        }
        joined[size_t(y) * size_t(light.columns) + size_t(x)] = bits;
      }
  });
}

HalfLanes load_texel(const IlluminationTexel& texel) { return load_lanes<HalfLanes>(&texel.red); }

// Returns the light of the finer texel in a quarter of (x, y): sx, sy are -1 or 1.
HalfLanes mix(const IlluminationLevel& coarse, uint8_t joined, int x, int y, int sx, int sy) {
  HalfLanes sum = load_texel(coarse.at(x, y)) * 9.0f;
  float weight = 9;
  auto add = [&](int dx, int dy, float share) {
    if (!(joined >> number_of(dx, dy) & 1)) return;
    sum += load_texel(coarse.at(x + dx, y + dy)) * share;
    weight += share;
  };
  add(sx, 0, 3), add(0, sy, 3), add(sx, sy, 1);
  return sum * (1 / weight);
}

// Returns the paper's factor on light that was computed coarsely.
float detail_of(const SplatPixels& pixels, const PixelGrid& grid, float detail, int x, int y) {
  const size_t i = size_t(y) * size_t(pixels.view.width) + size_t(x);
  vec3 way = -place_from_eye(pixels, grid, x, y);
  float length2 = dot(way, way);
  if (!(length2 > 0)) return 1;
  float cosine = dot(way, vec3(pixels.nx[i], pixels.ny[i], pixels.nz[i])) / std::sqrt(length2);
  return detail * std::max(cosine, 0.0f) + 1 - detail;
}

}  // namespace

void upsample(const SplatPixels& pixels, const MinMaxPyramid& pyramid,
              const SplatSettings& settings, IlluminationPyramid& illumination, UpsampleRoom& room,
              std::span<vec3> irradiance) {
  const PixelGrid grid = make_pixel_grid(pixels);
  const float detail = std::clamp(settings.detail, 0.0f, 1.0f);
  for (int level = int(illumination.levels.size()) - 2; level >= 0; level--) {
    const IlluminationLevel& coarse = illumination.levels[size_t(level) + 1];
    IlluminationLevel& fine = illumination.levels[size_t(level)];
    join_texels(pyramid, settings, level + 1, coarse, room.joined);
    parallel_ranges(fine.rows, 8, [&](int begin, int end) {
      for (int y = begin; y < end; y++)
        for (int x = 0; x < fine.columns; x++) {
          IlluminationTexel& to = fine.at(x, y);
          const int cx = x / 2, cy = y / 2;
          if (to.held > 0 || !(coarse.at(cx, cy).held > 0)) continue;
          if (level == 0 && !is_lit(pixels, size_t(y) * size_t(fine.columns) + size_t(x))) continue;
          uint8_t joined = room.joined[size_t(cy) * size_t(coarse.columns) + size_t(cx)];
          HalfLanes light = mix(coarse, joined, cx, cy, x & 1 ? 1 : -1, y & 1 ? 1 : -1);
          if (level == 0 && detail > 0) light *= detail_of(pixels, grid, detail, x, y);
          store_lanes(&to.red, light);
          to.held = 1;
        }
    });
  }
  const IlluminationLevel& pixel = illumination.levels[0];
  const size_t count = std::min(irradiance.size(), size_t(pixel.columns) * size_t(pixel.rows));
  parallel_ranges(int(count), 4096, [&](int begin, int end) {
    for (size_t i = size_t(begin); i < size_t(end); i++)
      irradiance[i] = {pixel.texels[i].red, pixel.texels[i].green, pixel.texels[i].blue};
  });
}

}  // namespace wellspring::light
