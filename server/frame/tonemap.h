// SPDX-License-Identifier: Apache-2.0
// Maps linear radiance to 8-bit sRGB for the eye. It is called once a frame per visitor; it never
// blocks and never fails: NaN and negative values become black, infinity white.
#pragma once
#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>

#include "base/simd.h"
#include "frame/frame.h"

namespace wellspring::frame {

// Computes the curve of frame/tonemap.h for eight pixels at a time, for code that makes a picture
// for the eye and needs no picture of radiance in between; and its inverse, for code that mixes
// light of such a picture.

// The shoulder of the Khronos PBR Neutral tone mapper (KhronosGroup/ToneMapping, PBR_Neutral):
// colours up to 0.8 are shown as they are, brighter ones keep their hue while their peak approaches
// 1 and then fade to white. Its toe, which takes away a portrait scene's 4 % reflection, is left
// out: it would crush the shadows of a room that is lit by its windows.
inline constexpr float shoulder_start = 0.8f;
inline constexpr float shoulder_height = 1 - shoulder_start;
inline constexpr float shoulder_desaturation = 0.15f;
inline constexpr float brightest_shown = 1e8f;  // stands for infinity, so that no inf/inf arises

// Computes the sRGB transfer function without pow: 1.055 x^(1/2.4) - 0.055 as a polynomial in
// sqrt(x), fitted by Remez exchange on [0.0031308, 1]; it stays within 0.04 of a 255th of the exact
// curve.
inline Lanes encode_srgb(Lanes x) {
  Lanes s = lanes_sqrt(x);
  Lanes curve =
      -0.0422319496f +
      s * (1.57527086f +
           s * (-1.89947641f +
                s * (3.89844127f + s * (-5.00316832f + s * (3.4186871f - s * 0.947671543f)))));
  return x < 0.0031308f ? 12.92f * x : curve;
}

// Finds scale and offset: a channel is shown as channel * scale + offset if the largest one is
// `above`, at least shoulder_start.
template <class Number>
void eval_shoulder(Number above, Number& scale, Number& offset) {
  Number squeezed =
      1 - shoulder_height * shoulder_height / (above + (shoulder_height - shoulder_start));
  Number keep = 1 / (shoulder_desaturation * (above - squeezed) + 1);
  scale = squeezed / above * keep, offset = squeezed * (1 - keep);
}

// A peak code holds the radiance times exposure of a colour's largest channel in a byte, 32 steps
// an octave (the first bits of the float): the codes of bright colours hold it badly, and those of
// light beyond white not at all. 0: less than least_peak; 255: that of 255 or more.
inline constexpr float least_peak = 0.5f;
inline constexpr int peak_shift = 18;
inline LaneMask eval_peak_codes(Lanes peak) {
  const Lanes least = all_lanes(least_peak);
  const LaneMask code =
      (lanes_as<LaneMask>(lanes_max(peak, least)) - lanes_as<LaneMask>(least)) >> peak_shift;
  return code < 255 ? code : LaneMask{} + 255;
}
// Returns the least peak that has this code.
inline float peak_of(int code) {
  return std::bit_cast<float>(std::bit_cast<int32_t>(least_peak) + (code << peak_shift));
}

// Returns the largest channel that is shown as `squeezed`, from shoulder_start to below 1.
inline float invert_shoulder(float squeezed) {
  return shoulder_start - shoulder_height +
         shoulder_height * shoulder_height / std::max(1 - squeezed, 1e-6f);
}
inline constexpr float most_told = 1.1f;
// Returns radiance times exposure from `shown`, the linear values of a pixel's codes, and its
// peak's code.
inline vec3 invert_tone_curve(vec3 shown, uint8_t peak_code) {
  float squeezed = std::max(shown.x, std::max(shown.y, shown.z));
  if (squeezed <= shoulder_start) return shown;
  // As long as there are many colour codes, they hold the peak better than its own code does.
  float low = peak_of(peak_code), high = peak_of(peak_code + 1), above = 0.5f * (low + high);
  if (above < most_told)
    above = std::clamp(invert_shoulder(squeezed), std::max(low, shoulder_start),
                       std::max(high, shoulder_start));
  float keep = 1 / (shoulder_desaturation * (above - squeezed) + 1);
  vec3 light = (shown - squeezed * (1 - keep)) * (above / (squeezed * keep));
  return {std::clamp(light.x, 0.0f, above), std::clamp(light.y, 0.0f, above),
          std::clamp(light.z, 0.0f, above)};
}

// Maps radiance times exposure to red | green << 8 | blue << 16 of the eye's picture.
inline LaneMask eval_tone_curve(Lanes3 c) {
  auto usable = [](Lanes x) {
    return lanes_min(positive_lanes(x), all_lanes(brightest_shown));  // NaN is not positive
  };
  c = {usable(c.x), usable(c.y), usable(c.z)};
  Lanes peak = max_component(c);
  if (negative_lanes(LaneMask(peak > shoulder_start))) {
    Lanes above = lanes_max(peak, all_lanes(shoulder_start)), scale, offset;
    eval_shoulder(above, scale, offset);
    c = {c.x * scale + offset, c.y * scale + offset, c.z * scale + offset};
  }
  auto code = [](Lanes x) {
    return __builtin_convertvector(encode_srgb(x) * 255 + 0.5f, LaneMask);
  };
  return code(c.x) | code(c.y) << 8 | code(c.z) << 16;
}

// Stores eight pixels as 24 bytes.
inline void store_pixels(uint8_t* to, LaneMask codes) {
  using Bytes = uint8_t __attribute__((vector_size(4 * lane_count)));
  Bytes b = lanes_as<Bytes>(codes);
  b = __builtin_shufflevector(b, b, 0, 1, 2, 4, 5, 6, 8, 9, 10, 12, 13, 14, 16, 17, 18, 20, 21, 22,
                              24, 25, 26, 28, 29, 30, 3, 7, 11, 15, 19, 23, 27, 31);
  std::memcpy(to, &b, 3 * lane_count);
}

struct Tonemap {
  float exposure = 1;  // multiplies radiance before the curve
};

// Overwrites `out` (resized to the frame). The result is deterministic; dithering is not applied.
void tonemap(const Frame& frame, const Tonemap& settings, Image8& out);

}  // namespace wellspring::frame
