// SPDX-License-Identifier: Apache-2.0
#include "picture/still/reconstruct_still.h"

#include <atomic>

#include "base/memory.h"
#include "base/parallel.h"

namespace wellspring::picture {
namespace {

constexpr float prior_weight = 0.5f;  // samples that the drawn picture counts as
}  // namespace

size_t memory_bytes(const StillReconstruction& work) {
  return bytes_of(work.guides.albedo, work.guides.normal, work.followed, work.color, work.shares);
}

double mean_count(const StillSamples& samples) {
  if (samples.count.empty()) return 0;
  std::atomic<uint64_t> sum{0};
  parallel_ranges(int(samples.count.size()), 1 << 16, [&](int begin, int end) {
    uint64_t here = 0;
    for (size_t i = size_t(begin); i < size_t(end); i++) here += samples.count[i];
    sum += here;
  });
  return double(sum) / double(samples.count.size());
}

void begin_reconstruction(const StillSamples& samples, const Frame& drawn, Denoiser& denoiser,
                          StillReconstruction& work) {
  const size_t pixels = drawn.color.size();
  work.width = drawn.width, work.height = drawn.height;
  work.color.resize(pixels);
  parallel_ranges(int(pixels), 1 << 14, [&](int begin, int end) {
    for (size_t i = size_t(begin); i < size_t(end); i++) {
      float n = samples.count[i];
      work.color[i] = drawn.color[i];
      const float share = n / (n + prior_weight);
      if (n > 0) work.color[i] += (mean_of(samples, i) - drawn.color[i]) * share;
    }
  });
  denoiser.start({work.width, work.height, work.color, work.guides.albedo, work.guides.normal});
}

void finish_reconstruction(const StillSamples& samples, const Denoiser& denoiser,
                           StillReconstruction& work, Frame& frame) {
  denoiser.finish(work.color);
  mix_in_means(samples, {work.width, work.height}, work.shares, work.color);
  frame.color = work.color;
}

}  // namespace wellspring::picture
