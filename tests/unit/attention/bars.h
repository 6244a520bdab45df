// SPDX-License-Identifier: Apache-2.0
// Pictures for the model of attention: bars in a grid, one of which differs (Treisman, Gelade
// 1980).
#pragma once
#include <algorithm>

#include "attention/saliency.h"

namespace wellspring::test {

struct Color8 {
  uint8_t r, g, b;
};
inline void paint(Image8& picture, ivec2 low, ivec2 high, Color8 color) {
  for (int y = low.y; y < high.y; y++)
    for (int x = low.x; x < high.x; x++) {
      uint8_t* pixel = picture.rgb.data() + 3 * (size_t(y) * size_t(picture.width) + size_t(x));
      pixel[0] = color.r, pixel[1] = color.g, pixel[2] = color.b;
    }
}
inline Image8 even_picture(int width, int height, Color8 color) {
  Image8 picture{width, height, std::vector<uint8_t>(size_t(3 * width * height))};
  paint(picture, ivec2(0), ivec2(width, height), color);
  return picture;
}

// Upright bars, one in the middle of each cell of a grid of `count` by `count`.
struct Bars {
  Color8 ground{}, bar{}, target{};
  int count = 6;
  ivec2 place{0};  // the target's cell
};
inline vec2 cell_size(const Bars& bars, ivec2 size) { return vec2(size) / float(bars.count); }
inline vec2 bar_middle(const Bars& bars, ivec2 cell, ivec2 size) {
  return (vec2(cell) + 0.5f) * cell_size(bars, size);
}
inline Image8 make_bars(const Bars& bars, int width, int height) {
  Image8 picture = even_picture(width, height, bars.ground);
  vec2 half = vec2(0.12f, 0.3f) * vec2(float(width), float(height)) / float(bars.count);
  for (int y = 0; y < bars.count; y++)
    for (int x = 0; x < bars.count; x++) {
      vec2 middle = bar_middle(bars, {x, y}, {width, height});
      bool is_target = ivec2(x, y) == bars.place;
      paint(picture, ivec2(middle - half), ivec2(middle + half + 1.0f),
            is_target ? bars.target : bars.bar);
    }
  return picture;
}

inline SaliencyMap saliency_of(const Image8& picture) {
  SaliencyWork work;
  SaliencyMap saliency;
  eval_saliency(picture, work, saliency);
  return saliency;
}

// The place of the picture, in pixels, where a map of it is largest.
inline vec2 most_salient_place(const SaliencyMap& saliency) {
  const std::vector<float>& value = saliency.map.value;
  int at = int(std::max_element(value.begin(), value.end()) - value.begin());
  vec2 place(float(at % saliency.map.width), float(at / saliency.map.width));
  return (place - saliency.offset) * float(1 << saliency_scale);
}

}  // namespace wellspring::test
