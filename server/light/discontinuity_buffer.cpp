// SPDX-License-Identifier: Apache-2.0
#include "light/discontinuity_buffer.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "base/parallel.h"

namespace wellspring {
namespace {

// Irradiance is known where something reflects it.
bool has_smooth(const Sample& s) { return s.flags & sample_hit && max_component(s.albedo) > 0; }

}  // namespace

bool is_continuous(const Sample& a, const Sample& b, const DiscontinuitySettings& settings,
                   float pixel) {
  if (a.object != b.object) return false;
  if (!(dot(a.normal, b.normal) >= settings.normal)) return false;
  vec3 step = b.position - a.position;
  float apart = std::max(std::abs(dot(step, a.normal)), std::abs(dot(step, b.normal)));
  return apart <= settings.distance * pixel * std::min(a.distance, b.distance);
}

void filter_smooth(const View& view, const DiscontinuitySettings& settings,
                   std::span<Sample> samples) {
  if (samples.size() != size_t(view.width) * size_t(view.height))
    throw std::invalid_argument("filter_smooth: one sample a pixel");
  int across = std::clamp(settings.columns / 2, 0, 3), down = std::clamp(settings.rows / 2, 0, 3);
  if (across == 0 && down == 0) return;
  float pixel = 2 * view.tan_half_fov / float(view.height);
  // Calls visit(bit, index) for the other pixels of the window around (x, y).
  auto for_each_neighbour = [&](int x, int y, const auto& visit) {
    int bit = 0;
    for (int v = y - down; v <= y + down; v++)
      for (int u = x - across; u <= x + across; u++, bit++)
        if (u >= 0 && v >= 0 && u < view.width && v < view.height && (u != x || v != y))
          visit(bit, size_t(v) * size_t(view.width) + size_t(u));
  };
  // Bits of the neighbours that go on.
  std::vector<uint64_t> goes_on(samples.size(), 0);
  parallel_ranges(view.height, 8, [&](int top, int bottom) {
    for (int y = top; y < bottom; y++)
      for (int x = 0; x < view.width; x++) {
        size_t at = size_t(y) * size_t(view.width) + size_t(x);
        const Sample& center = samples[at];
        if (!has_smooth(center)) continue;
        for_each_neighbour(x, y, [&](int bit, size_t i) {
          if (has_smooth(samples[i]) && is_continuous(center, samples[i], settings, pixel))
            goes_on[at] |= uint64_t(1) << bit;
        });
      }
  });
  std::vector<vec3> filtered(samples.size());
  parallel_ranges(view.height, 8, [&](int top, int bottom) {
    for (int y = top; y < bottom; y++)
      for (int x = 0; x < view.width; x++) {
        size_t at = size_t(y) * size_t(view.width) + size_t(x);
        vec3 sum(0);
        float rest = 1;
        int mine = std::popcount(goes_on[at]);
        for_each_neighbour(x, y, [&](int bit, size_t i) {
          if (!(goes_on[at] >> bit & 1)) return;
          float weight = 1 / float(1 + std::max(mine, std::popcount(goes_on[i])));
          sum += weight * samples[i].smooth;
          rest -= weight;
        });
        filtered[at] = sum + rest * samples[at].smooth;
      }
  });
  parallel_ranges(int(samples.size()), 4096, [&](int begin, int end) {
    for (int i = begin; i < end; i++) samples[size_t(i)].smooth = filtered[size_t(i)];
  });
}

}  // namespace wellspring
