// SPDX-License-Identifier: Apache-2.0
#include "world/texture.h"

#include <array>
#include <cmath>

namespace wellspring::world {
namespace {

// IEC 61966-2-1: 8-bit code to linear.
std::array<float, 256> make_srgb_table() {
  std::array<float, 256> table{};
  for (int i = 0; i < 256; i++) {
    double s = i / 255.0;
    table[i] = float(s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4));
  }
  return table;
}

std::array<float, 256> make_linear_table() {
  std::array<float, 256> table{};
  for (int i = 0; i < 256; i++) table[i] = float(i) / 255.0f;
  return table;
}

const std::array<float, 256> srgb_table = make_srgb_table();
const std::array<float, 256> linear_table = make_linear_table();

int nearest_tap(float coordinate, int size, Wrap wrap) {
  return glm::clamp(int(wrapped(coordinate, size, wrap)), 0, size - 1);
}

vec4 fetch8(const Image& image, const float* rgb, int x, int y) {
  const uint8_t* p = &image.texels8[(size_t(y) * size_t(image.width) + size_t(x)) * 4];
  return {rgb[p[0]], rgb[p[1]], rgb[p[2]], linear_table[p[3]]};
}

vec4 fetch_float(const Image& image, int x, int y) {
  vec4 t = image.texels[size_t(y) * size_t(image.width) + size_t(x)];
  for (int i = 0; i < 4; i++)
    if (!std::isfinite(t[i])) t[i] = 0;
  return t;
}

template <class Fetch>
vec4 bilinear(const Taps& x, const Taps& y, const Fetch& fetch) {
  vec4 top = fetch(x.first, y.first) * (1 - x.weight) + fetch(x.second, y.first) * x.weight;
  vec4 bottom = fetch(x.first, y.second) * (1 - x.weight) + fetch(x.second, y.second) * x.weight;
  return top * (1 - y.weight) + bottom * y.weight;
}

}  // namespace

vec4 eval_texture(const Image& image, const Texture& texture, vec2 uv) {
  if (image.width <= 0 || image.height <= 0) return vec4(1);
  if (!std::isfinite(uv.x) || !std::isfinite(uv.y)) uv = vec2(0);
  const float* rgb = image.srgb ? srgb_table.data() : linear_table.data();
  bool bytes = !image.texels8.empty();
  if (texture.nearest) {
    int x = nearest_tap(uv.x, image.width, texture.wrap_u);
    int y = nearest_tap(uv.y, image.height, texture.wrap_v);
    return bytes ? fetch8(image, rgb, x, y) : fetch_float(image, x, y);
  }
  Taps x = linear_taps(uv.x, image.width, texture.wrap_u);
  Taps y = linear_taps(uv.y, image.height, texture.wrap_v);
  return bytes ? bilinear(x, y, [&](int i, int j) { return fetch8(image, rgb, i, j); })
               : bilinear(x, y, [&](int i, int j) { return fetch_float(image, i, j); });
}

float decode_srgb(uint8_t code) { return srgb_table[code]; }

}  // namespace wellspring::world
