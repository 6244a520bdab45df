// SPDX-License-Identifier: Apache-2.0
#include "light/dynamic/light_taps.h"

namespace wellspring::light {
namespace {

constexpr float plane_share = 0.02f;   // of the depth: farther off the plane is another surface
constexpr float other_object = 0.01f;  // how much others count that lie in one plane
constexpr float least_weight = 1e-4f;

// How much a pixel of the light shows of the same surface, 0 to 1.
float likeness(const SurfaceBuffer& light, const PixelGrid& grid, int x, int y,
               const SeenPoint& seen) {
  const size_t at = size_t(y) * size_t(light.view.width) + size_t(x);
  const float depth = light.depth[at];
  if (!(depth < std::numeric_limits<float>::infinity())) return 0;
  const vec3 normal(light.nx[at], light.ny[at], light.nz[at]);
  float facing = std::max(dot(normal, seen.normal), 0.0f);
  facing *= facing, facing *= facing;
  const vec3 to = depth * grid.at(float(x), float(y)) - seen.place;
  const float off = dot(to, seen.normal) / (plane_share * seen.depth);
  const float same = light.object[at] == seen.object ? 1.0f : other_object;
  return same * facing / (1 + off * off);
}

}  // namespace

TapWeights weigh_taps(const SurfaceBuffer& light, const PixelGrid& grid, const TapPair& x,
                      const TapPair& y, const SeenPoint& seen) {
  TapWeights weights;
  float like[4], sum = 0;
  for (int k = 0; k < 4; k++) {
    like[k] = likeness(light, grid, k & 1 ? x.second : x.first, k >> 1 ? y.second : y.first, seen);
    weights.of[k] = (k & 1 ? x.share : 1 - x.share) * (k >> 1 ? y.share : 1 - y.share) * like[k];
    sum += weights.of[k];
  }
  if (sum > least_weight) {
    for (float& weight : weights.of) weight /= sum;
    return weights;
  }
  weights = {};
  const int best = int(std::max_element(like, like + 4) - like);
  if (like[best] > 0) weights.of[best] = 1;
  return weights;
}

}  // namespace wellspring::light
