// SPDX-License-Identifier: Apache-2.0
#include "cache_visit_judge.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace wellspring::test {
namespace {

void check_sizes(const Image8& a, const Image8& b) {
  if (a.width != b.width || a.height != b.height || a.rgb.size() != b.rgb.size() || a.rgb.empty())
    throw std::invalid_argument("pictures of different sizes, or empty ones");
}

float display_luminance(const Image8& image, int x, int y) {
  x = std::clamp(x, 0, image.width - 1);
  y = std::clamp(y, 0, image.height - 1);
  const uint8_t* p = image.rgb.data() + 3 * (size_t(y) * size_t(image.width) + size_t(x));
  return luminance(vec3(p[0], p[1], p[2]) / 255.0f);
}

float bilinear_luminance(const Image8& image, vec2 at) {
  float x = at.x - 0.5f, y = at.y - 0.5f;
  int left = int(std::floor(x)), top = int(std::floor(y));
  float fx = x - float(left), fy = y - float(top);
  float upper =
      display_luminance(image, left, top) * (1 - fx) + display_luminance(image, left + 1, top) * fx;
  float lower = display_luminance(image, left, top + 1) * (1 - fx) +
                display_luminance(image, left + 1, top + 1) * fx;
  return upper * (1 - fy) + lower * fy;
}

}  // namespace

double display_rmse(const Image8& test, const Image8& reference) {
  return display_rmse(test, reference, reference);
}

double display_rmse(const Image8& test, const Image8& one, const Image8& other) {
  check_sizes(test, one);
  check_sizes(test, other);
  double sum = 0;
  for (size_t i = 0; i < test.rgb.size(); i++) {
    double shown = test.rgb[i];
    sum += (shown - double(one.rgb[i])) * (shown - double(other.rgb[i])) / (255.0 * 255.0);
  }
  return std::sqrt(std::max(sum, 0.0) / double(test.rgb.size()));
}

double wrong_surface_share(const TrueView& truth, std::span<const uint32_t> shown) {
  if (shown.size() != truth.object.size() || shown.empty())
    throw std::invalid_argument("an object for every pixel is needed");
  size_t width = size_t(truth.view.width), wrong = 0;
  for (size_t i = 0; i < shown.size(); i++) {
    size_t corner = i / width * (width + 1) + i % width;
    const uint32_t* c = truth.corner.data() + corner;
    bool right = shown[i] == truth.object[i] || shown[i] == c[0] || shown[i] == c[1] ||
                 shown[i] == c[width + 1] || shown[i] == c[width + 2];
    wrong += !right;
  }
  return double(wrong) / double(shown.size());
}

vec2 find_again(const TrueView& before, vec3 place, bool infinite, uint32_t object) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  const View& view = before.view;
  vec3 point = infinite ? view.position + place : place;
  Projected at = project_point(view, point);
  if (!(at.depth > 0) ||
      !(at.x >= 0 && at.y >= 0 && at.x < float(view.width) && at.y < float(view.height)))
    return vec2(nan);
  size_t pixel = size_t(at.y) * size_t(view.width) + size_t(at.x);
  if (before.object[pixel] != object || bool(before.hit[pixel]) == infinite) return vec2(nan);
  if (infinite) return {at.x, at.y};
  // Half a pixel aside a surface seen at a slope of up to about 84 degrees is this much nearer or
  // farther; more is another part of the object.
  float pixel_size = 2 * view.tan_half_fov / float(view.height) * at.depth;
  float then = dot(before.position[pixel] - view.position, view.forward);
  if (std::abs(then - at.depth) > 5 * pixel_size) return vec2(nan);
  return {at.x, at.y};
}

double motion_compensated_error(const Image8& now, const Image8& before,
                                std::span<const vec2> motion) {
  check_sizes(now, before);
  if (motion.size() * 3 != now.rgb.size())
    throw std::invalid_argument("a motion vector for every pixel is needed");
  double sum = 0;
  size_t count = 0;
  for (int y = 0; y < now.height; y++)
    for (int x = 0; x < now.width; x++) {
      vec2 at = motion[size_t(y) * size_t(now.width) + size_t(x)];
      if (std::isnan(at.x)) continue;
      double d = double(display_luminance(now, x, y)) - double(bilinear_luminance(before, at));
      sum += d * d;
      count++;
    }
  return count > 0 ? std::sqrt(sum / double(count)) : NAN;
}

}  // namespace wellspring::test
