// SPDX-License-Identifier: Apache-2.0
#include "kiosk/gesture/skin.h"

#include <algorithm>
#include <cmath>

namespace wellspring::kiosk {

namespace {

constexpr float nearest = 0.1f;  // pixels
constexpr int most = 15;

size_t bin_of(const ChromaPicture& picture, size_t i) {
  return size_t(picture.cb[i] >> 3) * 32 + size_t(picture.cr[i] >> 3);
}

// Calls visit(index, offset in radii) for the pixels in use within the radius.
template <class Visit>
void within(const ChromaPicture& picture, vec2 center, float radius, const Visit& visit) {
  const int top = std::max(0, int(std::ceil(center.y - radius)));
  const int bottom = std::min(picture.height - 1, int(std::floor(center.y + radius)));
  const int left = std::max(0, int(std::ceil(center.x - radius)));
  const int right = std::min(picture.width - 1, int(std::floor(center.x + radius)));
  for (int y = top; y <= bottom; y++)
    for (int x = left; x <= right; x++) {
      const size_t i = size_t(y) * size_t(picture.width) + size_t(x);
      const vec2 off = (vec2(float(x), float(y)) - center) / radius;
      if (picture.use[i] && glm::dot(off, off) < 1) visit(i, off);
    }
}

}  // namespace

void make_chroma(const ColorView& view, ChromaPicture& out) {
  const size_t count = size_t(view.width) * size_t(view.height);
  out.width = view.width;
  out.height = view.height;
  out.y.resize(count), out.cb.resize(count), out.cr.resize(count);
  out.use.assign(count, 1);
  for (size_t i = 0; i < count; i++) {
    const int b = view.bgr[3 * i], g = view.bgr[3 * i + 1], r = view.bgr[3 * i + 2];
    out.y[i] = uint8_t((77 * r + 150 * g + 29 * b + 128) >> 8);
    out.cb[i] = uint8_t(std::clamp((-43 * r - 85 * g + 128 * b + 32896) >> 8, 0, 255));
    out.cr[i] = uint8_t(std::clamp((128 * r - 107 * g - 21 * b + 32896) >> 8, 0, 255));
  }
}

ChromaHistogram make_histogram(const ChromaPicture& picture, vec2 center, float radius) {
  ChromaHistogram out{};
  float sum = 0;
  within(picture, center, radius, [&](size_t i, vec2 off) {
    const float weight = 1 - glm::dot(off, off);
    out[bin_of(picture, i)] += weight;
    sum += weight;
  });
  if (sum > 0)
    for (float& p : out) p /= sum;
  return out;
}

float bhattacharyya(const ChromaHistogram& a, const ChromaHistogram& b) {
  float sum = 0;
  for (size_t u = 0; u < chroma_bins; u++) sum += std::sqrt(a[u] * b[u]);
  return sum;
}

Shifted mean_shift(const ChromaPicture& picture, const ChromaHistogram& model, vec2 center,
                   float radius, const std::vector<float>& emphasis) {
  Shifted out{center, 0, 0};
  while (out.iterations < most) {
    out.iterations++;
    const ChromaHistogram here = make_histogram(picture, out.center, radius);
    vec2 sum{0};
    float weights = 0;
    within(picture, out.center, radius, [&](size_t i, vec2 off) {
      const size_t u = bin_of(picture, i);
      float weight = std::sqrt(model[u] / here[u]);
      if (!emphasis.empty()) weight *= emphasis[i];
      sum += weight * off;
      weights += weight;
    });
    if (!(weights > 0)) break;
    const vec2 shift = radius * sum / weights;
    out.center += shift;
    if (glm::length(shift) < nearest) break;
  }
  out.similarity = bhattacharyya(make_histogram(picture, out.center, radius), model);
  return out;
}

namespace {

constexpr float widest = 3;          // deviations that still are skin
constexpr float least_variance = 6;  // hands differ a little from faces
constexpr float renewal = 0.1f;      // share of the new colour in a frame
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
  // The second and third round leave out pixels that lie apart.
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
