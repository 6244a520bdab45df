// SPDX-License-Identifier: Apache-2.0
#include "world/texture.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "base/load_error.h"
#include "image/image.h"

namespace wellspring::world {
namespace {

std::array<float, 256> make_linear_table() {
  std::array<float, 256> table{};
  for (int i = 0; i < 256; i++) table[i] = float(i) / 255.0f;
  return table;
}

float decode_srgb16(uint16_t code) {
  float s = float(code) / 65535.0f;
  return s <= 0.04045f ? s / 12.92f : std::pow((s + 0.055f) / 1.055f, 2.4f);
}

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

std::string decode_image(std::span<const uint8_t> bytes, bool srgb, Image& image,
                         int64_t& texels_left) {
  ImageCodes read;
  try {
    read = decode_codes(bytes, texels_left, image.name);
  } catch (const LoadError& error) {
    return error.what_;
  }
  image.width = read.width, image.height = read.height;
  image.texels8 = std::move(read.codes8);
  image.texels.resize(read.codes16.size() / 4);
  for (size_t i = 0; i < read.codes16.size(); i++) {
    const uint16_t code = read.codes16[i];
    image.texels[i / 4][int(i % 4)] =
        srgb && i % 4 < 3 ? decode_srgb16(code) : float(code) / 65535.0f;
  }
  texels_left -= int64_t(image.width) * image.height;
  image.srgb = srgb && image.texels.empty();
  return "";
}

namespace {

uint32_t pack_roots(vec3 c) {
  auto level = [](float v) { return uint32_t(std::sqrt(glm::clamp(v, 0.0f, 1.0f)) * 255 + 0.5f); };
  return level(c.x) | level(c.y) << 8 | level(c.z) << 16;
}
inline vec3 unpack_roots(uint32_t p) {
  vec3 root = vec3(float(p & 255), float(p >> 8 & 255), float(p >> 16 & 255)) * (1.0f / 255);
  return root * root;
}

// Holds the texels of the larger picture below one of the smaller, and how much of each.
struct Span {
  int first = 0, count = 0;
  float weight[4] = {};
};
std::vector<Span> halve(int from, int to) {
  std::vector<Span> spans{size_t(to)};
  for (int i = 0; i < to; i++) {
    double low = double(i) * from / to, high = double(i + 1) * from / to;
    Span& s = spans[size_t(i)];
    s.first = int(low);
    for (int k = s.first; k < std::min(int(std::ceil(high)), from) && s.count < 4; k++)
      s.weight[s.count++] =
          float((std::min(high, k + 1.0) - std::max(low, double(k))) / (high - low));
  }
  return spans;
}

template <class Fetch>
TexturePyramid::Level half_of(int width, int height, const Fetch& fetch) {
  TexturePyramid::Level level{std::max(width / 2, 1), std::max(height / 2, 1), {}};
  level.texels.resize(size_t(level.width) * size_t(level.height));
  std::vector<Span> columns = halve(width, level.width), rows = halve(height, level.height);
  for (int y = 0; y < level.height; y++)
    for (int x = 0; x < level.width; x++) {
      const Span &column = columns[size_t(x)], &row = rows[size_t(y)];
      vec3 sum(0);
      for (int j = 0; j < row.count; j++)
        for (int i = 0; i < column.count; i++)
          sum += row.weight[j] * column.weight[i] * fetch(column.first + i, row.first + j);
      level.texels[size_t(y) * size_t(level.width) + size_t(x)] = pack_roots(sum);
    }
  return level;
}

}  // namespace

TexturePyramid make_pyramid(const Image& image) {
  TexturePyramid pyramid;
  if (image.texels8.empty() || image.width <= 0 || image.height <= 0) return pyramid;
  int width = image.width, height = image.height;
  auto texel = [&](int x, int y) {
    const uint8_t* p = &image.texels8[(size_t(y) * size_t(width) + size_t(x)) * 4];
    auto linear = [&](uint8_t code) { return image.srgb ? decode_srgb(code) : float(code) / 255; };
    return vec3(linear(p[0]), linear(p[1]), linear(p[2]));
  };
  if (width > 1 || height > 1) pyramid.levels.push_back(half_of(width, height, texel));
  while (!pyramid.levels.empty() &&
         (pyramid.levels.back().width > 1 || pyramid.levels.back().height > 1)) {
    const TexturePyramid::Level& last = pyramid.levels.back();
    pyramid.levels.push_back(half_of(last.width, last.height, [&](int x, int y) {
      return unpack_roots(last.texels[size_t(y) * size_t(last.width) + size_t(x)]);
    }));
  }
  return pyramid;
}

namespace {

LaneMask gather(const void* from, LaneMask index) {
#ifdef __AVX2__
  return LaneMask(_mm256_i32gather_epi32(static_cast<const int*>(from), __m256i(index), 4));
#else
  LaneMask words;
  for (int i = 0; i < lane_count; i++)
    std::memcpy(reinterpret_cast<int*>(&words) + i, static_cast<const char*>(from) + 4 * index[i],
                4);
  return words;
#endif
}
Lanes to_lanes(LaneMask a) { return __builtin_convertvector(a, Lanes); }
Lanes floor_lanes(Lanes a) {
#ifdef __AVX__
  return Lanes(_mm256_floor_ps(__m256(a)));
#else
  for (int i = 0; i < lane_count; i++) a[i] = std::floor(a[i]);
  return a;
#endif
}

struct LaneTaps {
  LaneMask low, high;
  Lanes weight;
};
LaneTaps taps(Lanes coordinate, int size, Wrap wrap) {
  if (wrap == Wrap::repeat) {
    coordinate -= floor_lanes(coordinate);
  } else if (wrap == Wrap::mirror) {
    coordinate -= 2 * floor_lanes(0.5f * coordinate);
    coordinate = coordinate > 1 ? 2 - coordinate : coordinate;
  }
  // NaN counts as 0.
  coordinate = coordinate >= 0 ? lanes_min(coordinate, all_lanes(1)) : all_lanes(0);
  Lanes x = coordinate * float(size) - 0.5f, low = floor_lanes(x);
  LaneMask first = __builtin_convertvector(low, LaneMask), second = first + 1;
  bool around = wrap == Wrap::repeat;
  LaneMask none{}, last = none + (size - 1);
  first = first < 0 ? (around ? last : none) : first;
  second = second > last ? (around ? none : last) : second;
  return {first, second, x - low};
}

template <class Decode>
void bilinear(const void* texels, int width, const LaneTaps& x, const LaneTaps& y,
              const Decode& decode, Lanes (&rgb)[3]) {
  LaneMask top = y.low * width, bottom = y.high * width;
  LaneMask a = gather(texels, top + x.low), b = gather(texels, top + x.high),
           c = gather(texels, bottom + x.low), d = gather(texels, bottom + x.high);
  for (int k = 0; k < 3; k++) {
    auto channel = [&](LaneMask word) { return decode((word >> (8 * k)) & 255); };
    Lanes above = channel(a), below = channel(c);
    above += (channel(b) - above) * x.weight;
    below += (channel(d) - below) * x.weight;
    rgb[k] = above + (below - above) * y.weight;
  }
}

struct Codes {
  float linear[256];
};
Codes make_codes(bool srgb) {
  Codes codes;
  for (int i = 0; i < 256; i++) codes.linear[i] = srgb ? decode_srgb(uint8_t(i)) : float(i) / 255;
  return codes;
}

}  // namespace

bool eval_pyramid(const Image& image, const TexturePyramid& pyramid, const Texture& texture,
                  Lanes u, Lanes v, float texels, Lanes (&rgb)[3]) {
  if (image.texels8.empty() || texture.nearest || image.width <= 0 || image.height <= 0)
    return false;
  int level = pyramid_level(texels);
  if (level <= 0 || pyramid.levels.empty()) {
    static const Codes srgb = make_codes(true), linear = make_codes(false);
    const float* codes = image.srgb ? srgb.linear : linear.linear;
    bilinear(
        image.texels8.data(), image.width, taps(u, image.width, texture.wrap_u),
        taps(v, image.height, texture.wrap_v),
        [&](LaneMask code) { return Lanes(gather(codes, code)); }, rgb);
    return true;
  }
  const TexturePyramid::Level& l =
      pyramid.levels[std::min(size_t(level), pyramid.levels.size()) - 1];
  bilinear(
      l.texels.data(), l.width, taps(u, l.width, texture.wrap_u), taps(v, l.height, texture.wrap_v),
      [](LaneMask code) { return to_lanes(code) * (1.0f / 255); }, rgb);
  for (Lanes& channel : rgb) channel *= channel;
  return true;
}

vec3 eval_pyramid(const Image& image, const TexturePyramid& pyramid, const Texture& texture,
                  vec2 uv, float texels) {
  int level = pyramid_level(texels);
  if (level <= 0 || pyramid.levels.empty() || texture.nearest)
    return vec3(eval_texture(image, texture, uv));
  if (!std::isfinite(uv.x) || !std::isfinite(uv.y)) uv = vec2(0);
  const TexturePyramid::Level& l =
      pyramid.levels[std::min(size_t(level), pyramid.levels.size()) - 1];
  Taps x = linear_taps(uv.x, l.width, texture.wrap_u);
  Taps y = linear_taps(uv.y, l.height, texture.wrap_v);
  const uint32_t *top = &l.texels[size_t(y.first) * size_t(l.width)],
                 *bottom = &l.texels[size_t(y.second) * size_t(l.width)];
  vec3 above = unpack_roots(top[x.first]) * (1 - x.weight) + unpack_roots(top[x.second]) * x.weight;
  vec3 below =
      unpack_roots(bottom[x.first]) * (1 - x.weight) + unpack_roots(bottom[x.second]) * x.weight;
  return above * (1 - y.weight) + below * y.weight;
}

}  // namespace wellspring::world
