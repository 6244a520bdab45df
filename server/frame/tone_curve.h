// SPDX-License-Identifier: Apache-2.0
// The curve of frame/tonemap.h for eight pixels at a time: for those who make a picture for the eye
// and need no picture of radiance in between.
#pragma once
#include <cstdint>
#include <cstring>

#include "base/lanes3.h"

namespace wellspring {

// The shoulder of the Khronos PBR Neutral tone mapper (KhronosGroup/ToneMapping, PBR_Neutral):
// colours up to 0.8 are shown as they are, brighter ones keep their hue while their peak approaches
// 1 and then fade to white. Its toe, which takes away a studio's 4 % reflection, is left out: it
// would crush the shadows of a room that is lit by its windows.
inline constexpr float shoulder_start = 0.8f;
inline constexpr float shoulder_height = 1 - shoulder_start;
inline constexpr float shoulder_desaturation = 0.15f;
inline constexpr float brightest_shown = 1e8f;  // stands for infinity, so that no inf/inf arises

// The sRGB transfer function without pow: 1.055 x^(1/2.4) - 0.055 as a polynomial in sqrt(x),
// fitted by Remez exchange on [0.0031308, 1]; it stays within 0.04 of a 255th of the exact curve.
inline Lanes encode_srgb(Lanes x) {
  Lanes s = lanes_sqrt(x);
  Lanes curve =
      -0.0422319496f +
      s * (1.57527086f +
           s * (-1.89947641f +
                s * (3.89844127f + s * (-5.00316832f + s * (3.4186871f - s * 0.947671543f)))));
  return x < 0.0031308f ? 12.92f * x : curve;
}

// Radiance times exposure to red | green << 8 | blue << 16 of the eye's picture.
inline LaneMask eval_tone_curve(Lanes3 c) {
  auto usable = [](Lanes x) {
    x = x > 0 ? x : all_lanes(0);  // false for NaN
    return lanes_min(x, all_lanes(brightest_shown));
  };
  c = {usable(c.x), usable(c.y), usable(c.z)};
  Lanes peak = max_component(c);
  if (negative_lanes(LaneMask(peak > shoulder_start))) {
    Lanes above = lanes_max(peak, all_lanes(shoulder_start));
    Lanes squeezed =
        1 - shoulder_height * shoulder_height / (above + (shoulder_height - shoulder_start));
    Lanes keep = 1 / (shoulder_desaturation * (above - squeezed) + 1);
    Lanes scale = squeezed / above * keep, offset = squeezed * (1 - keep);
    c = {c.x * scale + offset, c.y * scale + offset, c.z * scale + offset};
  }
  auto code = [](Lanes x) {
    return __builtin_convertvector(encode_srgb(x) * 255 + 0.5f, LaneMask);
  };
  return code(c.x) | code(c.y) << 8 | code(c.z) << 16;
}

// Eight pixels as 24 bytes.
inline void store_pixels(uint8_t* to, LaneMask codes) {
  using Bytes = uint8_t __attribute__((vector_size(4 * lane_count)));
  Bytes b;
  std::memcpy(&b, &codes, sizeof b);
  b = __builtin_shufflevector(b, b, 0, 1, 2, 4, 5, 6, 8, 9, 10, 12, 13, 14, 16, 17, 18, 20, 21, 22,
                              24, 25, 26, 28, 29, 30, 3, 7, 11, 15, 19, 23, 27, 31);
  std::memcpy(to, &b, 3 * lane_count);
}

}  // namespace wellspring
