// SPDX-License-Identifier: Apache-2.0
#include "kiosk/gesture/skin.h"

#include <algorithm>
#include <cmath>

namespace wellspring::kiosk {

namespace {

constexpr float widest = 3;          // deviations that still are skin
constexpr float least_variance = 6;  // hands differ a little from faces
constexpr float renewal = 0.1f;      // of what is known, a frame
constexpr int darkest = 40, brightest = 250;

float distance_squared(vec2 off, vec3 spread) {
  const float determinant = std::max(1e-3f, spread.x * spread.z - spread.y * spread.y);
  return (spread.z * off.x * off.x - 2 * spread.y * off.x * off.y + spread.x * off.y * off.y) /
         determinant;
}

}  // namespace

void SkinColor::learn(const ChromaPicture& picture, vec2 center, float side) {
  vec2 mean = mean_;
  vec3 spread(400, 0, 400);
  // The second and third time without what lies apart.
  for (int round = 0; round < 3; round++) {
    vec2 sum{0};
    vec3 squares{0};
    float count = 0;
    for (int y = std::max(0, int(center.y - 0.35f * side));
         y < std::min(picture.height, int(center.y + 0.4f * side)); y++)
      for (int x = std::max(0, int(center.x - 0.25f * side));
           x < std::min(picture.width, int(center.x + 0.25f * side)); x++) {
        const size_t i = size_t(y) * size_t(picture.width) + size_t(x);
        if (picture.y[i] < darkest || picture.y[i] > brightest) continue;
        const vec2 c(picture.cb[i], picture.cr[i]);
        if (round > 0 && distance_squared(c - mean, spread) > 4) continue;
        sum += c;
        squares += vec3(c.x * c.x, c.x * c.y, c.y * c.y);
        count++;
      }
    if (count < 20) return;
    mean = sum / count;
    spread = squares / count - vec3(mean.x * mean.x, mean.x * mean.y, mean.y * mean.y);
    spread.x = std::max(spread.x, least_variance);
    spread.z = std::max(spread.z, least_variance);
  }
  const float share = known_ ? renewal : 1;
  mean_ += share * (mean - mean_);
  spread_ += share * (spread - spread_);
  known_ = true;
}

bool SkinColor::has(uint8_t y, uint8_t cb, uint8_t cr) const {
  if (!known_ || y < darkest) return false;
  return distance_squared(vec2(cb, cr) - mean_, spread_) < widest * widest;
}

}  // namespace wellspring::kiosk
