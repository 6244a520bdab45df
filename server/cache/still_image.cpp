// SPDX-License-Identifier: Apache-2.0
#include "cache/still_image.h"

#include <algorithm>

#include "base/parallel.h"
#include "base/rng.h"
#include "cache/packing.h"

namespace wellspring {

namespace {

constexpr int still_drawn = 4 * still_places;  // drawn pictures that the mean looks back on
constexpr int relit_samples = 6;     // that a mean from before the light changed is worth
constexpr float darkest = 0.004f;    // reflectance through which light can be told
constexpr float contrast = 4;        // of a surface within a pixel, at most

// What the light of a colour is, told by the reflectance it was seen with.
vec3 light_of(vec3 color, vec3 albedo) { return color / max(albedo, vec3(darkest)); }

}  // namespace

void relight_still_pixel(const PointCache& points, uint32_t point, size_t pixel,
                         StillImage& still) {
  uint8_t& count = still.count[pixel];
  int n = count & ~still_fresh;
  if (n == still_relit) return;  // switched again before anything was seen
  count = 0;
  if (n <= relit_samples) return;
  const PointColor& color = points.color[point];
  vec3 albedo = unpack_albedo(color.albedo);
  vec3 glow = points.glow.empty() ? vec3(0) : unpack_rgb9e5(points.glow[point]);
  vec3 light = light_of(
      albedo * unpack_rgb9e5(color.smooth) + unpack_rgb9e5(color.rest) + glow, albedo);
  vec3 mean(unpack_half(still.mean[0][pixel]), unpack_half(still.mean[1][pixel]),
            unpack_half(still.mean[2][pixel]));
  bool known =
      albedo != vec3(0) && !(points.flags[point] & point_specular) && luminance(light) > 1e-4f;
  if (!known) return;
  count = still_relit;
  vec3 surface = clamp(mean / max(light, vec3(1e-5f)), albedo / contrast, albedo * contrast);
  for (size_t c = 0; c < 3; c++) still.mean[c][pixel] = pack_half(surface[int(c)]);
}

vec2 still_place(int pictures) {
  // The additive recurrence of the plastic number's powers (Roberts 2018), which is as even in any
  // row of its places.
  uint32_t i = uint32_t(pictures % (still_places * 64));
  auto part = [i](uint32_t step) { return float((0x80000000u + step * i) >> 8) * 0x1p-24f; };
  return {part(3242174889u), part(2447445414u)};
}

void accumulate_drawn(const std::function<bool(uint32_t)>& moves, bool changes, uint32_t seed,
                      StillImage& still, Frame& frame) {
  const int longest = changes ? still_places : still_drawn;
  size_t width = size_t(frame.width);
  parallel_ranges(frame.height, 8, [&](int begin, int end) {
    uint32_t last = 0;  // neighbours mostly show the same
    bool last_moves = moves(last);
    for (size_t i = size_t(begin) * width; i < size_t(end) * width; i++) {
      if (frame.object[i] != last) last_moves = moves(last = frame.object[i]);
      if (last_moves) {
        still.count[i] = 0;
        continue;
      }
      int n = still.count[i] & ~still_fresh;
      if (n == still_relit) n = 0;
      n = std::min(n + 1, longest);
      vec3 mean(unpack_half(still.mean[0][i]), unpack_half(still.mean[1][i]),
                unpack_half(still.mean[2][i]));
      // Later pictures count more: their light was known better.
      mean = n == 1 ? frame.color[i] : mean + (frame.color[i] - mean) * (1.5f / (float(n) + 0.5f));
      uint64_t random = mix64(uint64_t(seed) << 32 | i);
      for (size_t c = 0; c < 3; c++)
        still.mean[c][i] = pack_half(mean[int(c)], uint32_t(random >> (16 * c)));
      still.count[i] = uint8_t(n);
      frame.color[i] = mean;
    }
  });
}

void accumulate_still(const PointCache& points, const PointImage& image, uint32_t seed,
                      StillImage& still, Frame& frame) {
  parallel_ranges(image.height, 8, [&](int begin, int end) {
    size_t first = size_t(begin) * size_t(image.width), last = size_t(end) * size_t(image.width);
    for (size_t i = first; i < last; i++) {
      uint32_t point = image.point[i];
      if (point == no_point || (points.flags[point] & point_moving)) {
        still.count[i] = 0;
        continue;
      }
      int n = still.count[i] & ~still_fresh;
      vec3 mean(unpack_half(still.mean[0][i]), unpack_half(still.mean[1][i]),
                unpack_half(still.mean[2][i]));
      bool fresh = still.count[i] & still_fresh;
      if (n == still_relit) {
        mean *= light_of(frame.color[i], unpack_albedo(points.color[point].albedo));
        n = relit_samples;
      }
      if (fresh) {
        n = std::min(n + 1, still_longest);
        // Later samples count more: the light they were shown in was known better.
        mean =
            n == 1 ? frame.color[i] : mean + (frame.color[i] - mean) * (1.5f / (float(n) + 0.5f));
        uint64_t random = mix64(uint64_t(seed) << 32 | i);
        for (size_t c = 0; c < 3; c++)
          still.mean[c][i] = pack_half(mean[int(c)], uint32_t(random >> (16 * c)));
        still.count[i] = uint8_t(n);
      }
      if (n == 0) continue;
      float share = float(n) / (float(n) + 2);
      frame.color[i] += (mean - frame.color[i]) * share;
      frame.confidence[i] = std::max(frame.confidence[i], float(n) / (float(n) + 8));
    }
  });
}

}  // namespace wellspring
