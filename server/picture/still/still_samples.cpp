// SPDX-License-Identifier: Apache-2.0
#include "picture/still/still_samples.h"

#include <algorithm>
#include <cmath>

#include "cache/packing.h"

namespace wellspring {

void resize_samples(StillSamples& samples, size_t pixels) {
  samples.mean = std::vector<uint32_t>(pixels);
  samples.deviation = std::vector<uint8_t>(pixels);
  samples.count = std::vector<uint8_t>(pixels);
}

void invalidate_samples(const StillImage& still, StillSamples& samples) {
  for (size_t i = 0; i < std::min(still.count.size(), samples.count.size()); i++)
    if (still.count[i] == 0) samples.count[i] = 0;
}

void add_sample(StillSamples& samples, size_t pixel, vec3 light, uint32_t random) {
  int n = samples.count[pixel];
  vec3 mean = n > 0 ? unpack_rgb9e5(samples.mean[pixel]) : light, step = light - mean;
  float share = 1 / float(n + 1), square = dot(step, step) * (1 / 3.0f), variance = 0;
  if (n > 0) {
    float before = unpack_deviation(samples.deviation[pixel]);
    variance = before * before * float(n - 1) / float(n) + square * share;  // Welford 1962
  }
  samples.mean[pixel] = pack_rgb9e5(max(mean + step * share, vec3(0)), random);
  samples.deviation[pixel] = pack_deviation(std::sqrt(variance), random >> 8);
  samples.count[pixel] = uint8_t(std::min(n + 1, most_still_samples));
}

}  // namespace wellspring
