// SPDX-License-Identifier: Apache-2.0
#include "frame/tonemap.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/parallel.h"

namespace wellspring {
namespace {

// The shoulder of the Khronos PBR Neutral tone mapper (KhronosGroup/ToneMapping, PBR_Neutral):
// colours up to 0.8 are shown as they are, brighter ones keep their hue while their peak approaches
// 1 and then fade to white. Its toe, which takes away a studio's 4 % reflection, is left out: it
// would crush the shadows of a room that is lit by its windows.
constexpr float shoulder_start = 0.8f;
constexpr float shoulder_height = 1 - shoulder_start;
constexpr float desaturation = 0.15f;
constexpr float brightest = 1e8f;  // stands for infinity, so that no inf/inf arises

inline float larger(float a, float b) { return a > b ? a : b; }
inline float usable(float x) {
  x = x > 0 ? x : 0.0f;  // false for NaN
  return x < brightest ? x : brightest;
}

struct Shoulder {
  float scale, offset;  // channel = radiance * scale + offset
};

// Branch-free, so that a loop over pixels becomes vector code.
// `above`: the colour's largest channel, at least shoulder_start.
inline Shoulder shoulder(float above) {
  float squeezed =
      1 - shoulder_height * shoulder_height / (above + (shoulder_height - shoulder_start));
  float keep = 1 / (desaturation * (above - squeezed) + 1);
  return {squeezed / above * keep, squeezed * (1 - keep)};
}

// The sRGB transfer function without pow: 1.055 x^(1/2.4) - 0.055 as a polynomial in sqrt(x),
// fitted by Remez exchange on [0.0031308, 1]; it stays within 0.04 of a 255th of the exact curve.
inline float encode_fast(float x) {
  float s = std::sqrt(x);
  float curve =
      -0.0422319496f +
      s * (1.57527086f +
           s * (-1.89947641f +
                s * (3.89844127f + s * (-5.00316832f + s * (3.4186871f - s * 0.947671543f)))));
  float line = 12.92f * x;
  float low = x < 0.0031308f ? 1.0f : 0.0f;  // a choice by arithmetic: no branch, so vector code
  return curve + low * (line - curve);
}

inline float encode_exact(float x) {
  return x < 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1 / 2.4f) - 0.055f;
}

// Pixels at once: their planes stay in the first-level cache. Each step is a loop of its own over
// one or three planes, which is what compilers turn into vector code.
constexpr int block = 64;

void tonemap_block(const vec3* color, int count, float exposure, uint8_t* rgb) {
  float red[block], green[block], blue[block];
  for (int i = 0; i < count; i++) {
    red[i] = color[i].x;
    green[i] = color[i].y;
    blue[i] = color[i].z;
  }
  std::fill(red + count, red + block, 0.0f);
  std::fill(green + count, green + block, 0.0f);
  std::fill(blue + count, blue + block, 0.0f);
  for (float* plane : {red, green, blue})
    for (int i = 0; i < block; i++) plane[i] = usable(plane[i] * exposure);
  float peak[block], scale[block], offset[block];
  for (int i = 0; i < block; i++)
    peak[i] = larger(larger(red[i], green[i]), larger(blue[i], shoulder_start));
  for (int i = 0; i < block; i++) {
    Shoulder s = shoulder(peak[i]);
    scale[i] = s.scale;
    offset[i] = s.offset;
  }
  for (float* plane : {red, green, blue})
    for (int i = 0; i < block; i++)
      plane[i] = encode_fast(plane[i] * scale[i] + offset[i]) * 255 + 0.5f;
  for (int i = 0; i < count; i++) {
    rgb[3 * i] = uint8_t(red[i]);
    rgb[3 * i + 1] = uint8_t(green[i]);
    rgb[3 * i + 2] = uint8_t(blue[i]);
  }
}

}  // namespace

void tonemap(const Frame& frame, const Tonemap& settings, Image8& out) {
  size_t pixels = size_t(frame.width) * size_t(frame.height);
  if (frame.color.size() != pixels)
    throw std::invalid_argument("tonemap: frame has no colour plane");
  out.width = frame.width;
  out.height = frame.height;
  out.rgb.resize(pixels * 3);
  parallel_ranges(frame.height, 16, [&](int begin, int end) {
    size_t last = size_t(end) * size_t(frame.width);
    for (size_t i = size_t(begin) * size_t(frame.width); i < last; i += block)
      tonemap_block(&frame.color[i], int(std::min<size_t>(block, last - i)), settings.exposure,
                    &out.rgb[i * 3]);
  });
}

vec3 tonemap_color(vec3 radiance, const Tonemap& settings) {
  vec3 c(usable(radiance.x * settings.exposure), usable(radiance.y * settings.exposure),
         usable(radiance.z * settings.exposure));
  Shoulder s = shoulder(larger(max_component(c), shoulder_start));
  return {encode_exact(c.x * s.scale + s.offset), encode_exact(c.y * s.scale + s.offset),
          encode_exact(c.z * s.scale + s.offset)};
}

}  // namespace wellspring
