// SPDX-License-Identifier: Apache-2.0
#include "light/sample/finish_samples.h"

#include <cstddef>
#include <limits>

#include "base/simd.h"

namespace wellspring::light {
namespace {

// Light of a sample is finite and not negative. Bit by bit: one branch for all.
bool is_light(const Sample& sample) {
  constexpr float most = std::numeric_limits<float>::max();
  static_assert(offsetof(Sample, rest) == offsetof(Sample, albedo) + 6 * sizeof(float));
  const vec3 sum = sample.radiance();
  const Lanes first = load_lanes(&sample.albedo.x);  // all but the last number of `rest`
  const Lanes others = {sample.rest.z, sum.x, sum.y, sum.z, 0, 0, 0, 0}, zero{};
  // NaN is neither.
  LaneMask fine = (first >= zero) & (first <= most) & (others >= zero) & (others <= most);
  return negative_lanes(fine) == 0xff;
}

}  // namespace

void finish_samples(const Lights& lights, const TransportSettings& settings,
                    std::span<Sample> samples) {
  for (Sample& sample : samples) {
    if (!is_light(sample)) {
      lights.bad_samples->fetch_add(1, std::memory_order_relaxed);
      sample.albedo = sample.smooth = sample.rest = sample.glow = vec3(0);
      sample.flags &= uint8_t(~sample_sure);
    }
    if (!(settings.clamp > 0)) continue;
    // What owes nothing to chance, such as a lamp that is looked at, is as bright as it is.
    vec3 sure = sample.flags & sample_sure ? sample.rest : sample.glow;
    // Nor does what a map knows.
    vec3 mapped = sample.flags & sample_mapped ? min(sample.smooth, vec3(1)) : vec3(0);
    vec3 chance = sample.radiance() - sure - sample.albedo * sample.known * mapped;
    float largest = max_component(chance), share = settings.clamp / largest;
    if (!(largest > settings.clamp)) continue;
    sample.smooth = mapped + (sample.smooth - mapped) * share;
    sample.rest = sure + (sample.rest - sure) * share;
  }
}

}  // namespace wellspring::light
