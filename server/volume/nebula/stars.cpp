// SPDX-License-Identifier: Apache-2.0
#include "volume/nebula/stars.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "image/srgb.h"

namespace wellspring::volume {

namespace {

constexpr int levels = 1024;  // a median has so many, spaced as square roots of light

constexpr float most_light = 1e30f;  // so that sums of pixels are numbers, too

float finite_light(float light) {
  return light > 0 && light <= std::numeric_limits<float>::max() ? std::min(light, most_light) : 0;
}

float brightness(vec3 color) { return (color.x + color.y + color.z) / 3; }

float decode_srgb_code(double code) {
  return float(code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4));
}

// Returns the median of each channel over the outermost pixels.
vec3 edge_median(const image::LinearImage& picture) {
  const int wide = std::max(1, std::min(picture.width, picture.height) / 32);
  std::array<std::vector<float>, 3> found;
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      if (x >= wide && y >= wide && x < picture.width - wide && y < picture.height - wide) continue;
      const vec3 color = picture.color[size_t(y) * size_t(picture.width) + size_t(x)];
      for (int c = 0; c < 3; ++c) found[size_t(c)].push_back(color[c]);
    }
  vec3 median{0};
  for (int c = 0; c < 3; ++c) {
    std::vector<float>& values = found[size_t(c)];
    if (values.empty()) continue;
    const auto middle = values.begin() + ptrdiff_t((values.size() - 1) / 2);
    std::nth_element(values.begin(), middle, values.end());
    median[c] = *middle;
  }
  return median;
}

// Holds a window's levels while it slides (Huang 1979).
struct SlidingMedian {
  std::array<int, levels> count{};
  int below = 0, all = 0, median = 0;  // pixels in levels below the median; pixels in all

  void change(int level, int by) {
    count[size_t(level)] += by, all += by;
    if (level < median) below += by;
  }
  int find() {
    const int half = all / 2;
    while (median > 0 && below > half) below -= count[size_t(--median)];
    while (median + 1 < levels && below + count[size_t(median)] <= half)
      below += count[size_t(median++)];
    return median;
  }
};

std::vector<float> window_median(const std::vector<float>& light, int width, int height, int radius,
                                 float brightest) {
  std::vector<uint16_t> level(light.size());
  const float scale = float(levels - 1) / std::sqrt(brightest);
  for (size_t i = 0; i < light.size(); ++i)
    level[i] = uint16_t(std::min(float(levels - 1), std::sqrt(light[i]) * scale + 0.5f));
  std::vector<float> median(light.size());
  parallel_for(height, [&](int y) {
    SlidingMedian window;
    const int top = std::max(0, y - radius), bottom = std::min(height - 1, y + radius);
    const auto column = [&](int x, int by) {
      if (x < 0 || x >= width) return;
      for (int row = top; row <= bottom; ++row)
        window.change(level[size_t(row) * size_t(width) + size_t(x)], by);
    };
    for (int x = 0; x < radius; ++x) column(x, 1);
    for (int x = 0; x < width; ++x) {
      column(x + radius, 1), column(x - radius - 1, -1);
      const float root = float(window.find()) / scale;
      median[size_t(y) * size_t(width) + size_t(x)] = root * root;
    }
  });
  return median;
}

// Holds the pixels that belong together, and the shape of the light in them.
struct Blob {
  std::vector<int> pixels;
  bool high = false;
  double light = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
};

void add_to_blob(Blob& blob, int pixel, int width, double light) {
  const double x = pixel % width, y = pixel / width;
  blob.pixels.push_back(pixel);
  blob.light += light, blob.x += light * x, blob.y += light * y;
  blob.xx += light * x * x, blob.xy += light * x * y, blob.yy += light * y * y;
}

bool is_star(const Blob& blob, int radius, double roundest) {
  if (!blob.high || blob.light <= 0) return false;
  const double x = blob.x / blob.light, y = blob.y / blob.light;
  // A pixel's own size keeps a star of one pixel round.
  const double xx = blob.xx / blob.light - x * x + 1. / 12, xy = blob.xy / blob.light - x * y,
               yy = blob.yy / blob.light - y * y + 1. / 12;
  const double middle = (xx + yy) / 2, apart = std::hypot((xx - yy) / 2, xy);
  const double most = middle + apart, least = std::max(middle - apart, 1e-9);
  return std::sqrt(xx + yy) <= 0.35 * radius + 0.3 && std::sqrt(most / least) <= roundest;
}

template <class Act>
void each_neighbour(int pixel, int width, int height, const Act& act) {
  const int x = pixel % width, y = pixel / width;
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx)
      if ((dx != 0 || dy != 0) && x + dx >= 0 && x + dx < width && y + dy >= 0 && y + dy < height)
        act(pixel + dy * width + dx);
}

// Solves Laplace's equation in the mask by successive over-relaxation (Young 1950); beyond the
// picture's edge lies its mirror image.
void fill_by_diffusion(image::LinearImage& picture, const std::vector<int>& pixels) {
  constexpr float over = 1.7f;
  constexpr int most_rounds = 400;
  const int width = picture.width, height = picture.height;
  float scale = 0;
  for (const int pixel : pixels) scale = std::max(scale, brightness(picture.color[size_t(pixel)]));
  for (int round = 0; round < most_rounds; ++round) {
    float most = 0;
    for (const int pixel : pixels) {
      const int x = pixel % width, y = pixel / width;
      vec3 sum{0};
      int count = 0;
      const auto take = [&](bool inside, int from) {
        if (inside) sum += picture.color[size_t(from)], ++count;
      };
      take(x > 0, pixel - 1), take(x + 1 < width, pixel + 1);
      take(y > 0, pixel - width), take(y + 1 < height, pixel + width);
      if (count == 0) continue;
      vec3& color = picture.color[size_t(pixel)];
      const vec3 step = sum / float(count) - color;
      color += over * step;
      most = std::max(most, brightness(glm::abs(step)));
    }
    if (most <= 1e-6f * scale) break;
  }
  for (const int pixel : pixels)
    picture.color[size_t(pixel)] = glm::max(picture.color[size_t(pixel)], vec3(0));
}

void fill_stars(image::LinearImage& picture, const StarSettings& settings, StarReport& report) {
  const int width = picture.width, height = picture.height;
  const size_t count = picture.color.size();
  std::vector<float> light(count);
  for (size_t i = 0; i < count; ++i) light[i] = brightness(picture.color[i]);
  const float brightest = *std::max_element(light.begin(), light.end());
  if (!(brightest > 0)) return;
  const int radius =
      settings.radius > 0 ? settings.radius : std::max(3, std::max(width, height) / 64);
  const std::vector<float> median = window_median(light, width, height, radius, brightest);
  const float least = float(settings.least) * brightest, contrast = float(settings.contrast);
  const auto height_over = [&](int pixel) { return light[size_t(pixel)] - median[size_t(pixel)]; };
  const auto low = [&](int pixel) {
    return height_over(pixel) > 0.25f * (least + contrast * median[size_t(pixel)]);
  };
  std::vector<uint8_t> seen(count);
  std::vector<int> masked;
  for (int start = 0; start < int(count); ++start) {
    if (seen[size_t(start)] || !low(start)) continue;
    Blob blob;
    std::vector<int> open{start};
    seen[size_t(start)] = 1;
    while (!open.empty()) {
      const int pixel = open.back();
      open.pop_back();
      add_to_blob(blob, pixel, width, height_over(pixel));
      blob.high = blob.high || height_over(pixel) > least + contrast * median[size_t(pixel)];
      each_neighbour(pixel, width, height, [&](int next) {
        if (seen[size_t(next)] || !low(next)) return;
        seen[size_t(next)] = 1;
        open.push_back(next);
      });
    }
    if (!is_star(blob, radius, settings.roundest)) continue;
    ++report.stars;
    masked.insert(masked.end(), blob.pixels.begin(), blob.pixels.end());
  }
  // The glow around a star goes, too.
  for (int round = 0; round < 2; ++round) {
    for (const int pixel : masked) report.mask[size_t(pixel)] = 1;
    std::vector<int> grown = masked;
    for (const int pixel : masked)
      each_neighbour(pixel, width, height, [&](int next) {
        if (report.mask[size_t(next)]) return;
        report.mask[size_t(next)] = 1;
        grown.push_back(next);
      });
    masked = std::move(grown);
  }
  std::sort(masked.begin(), masked.end());
  report.pixels = int(masked.size());
  for (const int pixel : masked)
    picture.color[size_t(pixel)] *=
        std::min(1.0f, median[size_t(pixel)] / std::max(light[size_t(pixel)], 1e-30f));
  fill_by_diffusion(picture, masked);
}

}  // namespace

image::LinearImage linearise(const image::ImageCodes& codes) {
  image::LinearImage picture{codes.width, codes.height, {}};
  const size_t pixels = size_t(codes.width) * size_t(codes.height);
  picture.color.resize(pixels);
  const bool wide = !codes.codes16.empty();
  std::vector<float> table;
  if (wide)
    for (int i = 0; i < 65536; ++i) table.push_back(decode_srgb_code(i / 65535.0));
  for (size_t i = 0; i < pixels; ++i)
    for (int c = 0; c < 3; ++c) {
      const size_t at = 4 * i + size_t(c);
      picture.color[i][c] =
          wide ? table[codes.codes16[at]] * float(codes.codes16[4 * i + 3]) / 65535
               : image::decode_srgb(codes.codes8[at]) * float(codes.codes8[4 * i + 3]) / 255;
    }
  return picture;
}

image::LinearImage shrink(const image::LinearImage& picture, int factor) {
  if (factor <= 1) return picture;
  image::LinearImage small;
  small.width = (picture.width + factor - 1) / factor;
  small.height = (picture.height + factor - 1) / factor;
  small.color.resize(size_t(small.width) * size_t(small.height));
  parallel_for(small.height, [&](int y) {
    const int bottom = std::min(picture.height, (y + 1) * factor);
    for (int x = 0; x < small.width; ++x) {
      const int right = std::min(picture.width, (x + 1) * factor);
      vec3 sum{0};
      for (int row = y * factor; row < bottom; ++row)
        for (int column = x * factor; column < right; ++column)
          sum += picture.color[size_t(row) * size_t(picture.width) + size_t(column)];
      small.color[size_t(y) * size_t(small.width) + size_t(x)] =
          sum / float((bottom - y * factor) * (right - x * factor));
    }
  });
  return small;
}

StarReport clean_sky(image::LinearImage& picture, bool remove_stars, const StarSettings& settings) {
  StarReport report;
  report.mask.resize(picture.color.size());
  for (vec3& color : picture.color)
    color = {finite_light(color.x), finite_light(color.y), finite_light(color.z)};
  report.sky = edge_median(picture);
  for (vec3& color : picture.color) color = glm::max(color - report.sky, vec3(0));
  if (remove_stars && !picture.color.empty()) fill_stars(picture, settings, report);
  return report;
}

}  // namespace wellspring::volume
