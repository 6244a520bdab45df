// SPDX-License-Identifier: Apache-2.0
// Computes what splats need of eight numbers at a time: powers, logarithms, spherical harmonics.
#pragma once
#include <cstdint>

#include "base/simd.h"

namespace wellspring::scan {

inline constexpr Lanes lane_numbers{0, 1, 2, 3, 4, 5, 6, 7};

// Returns 2 to the power of x with a relative error below 3e-6; x up to 127, below -126 about 0.
inline Lanes power_of_two(Lanes x) {
  x = lanes_max(x, all_lanes(-126));
  constexpr float round = 12582912;  // 1.5 * 2^23: adding it leaves whole numbers
  const Lanes shifted = x + round;
  const Lanes rest = x - (shifted - round);
  // The relative error is even from -0.5 to 0.5, and none at 0.
  Lanes series = all_lanes(0.0095825997f);
  series = series * rest + 0.0559061017f;
  series = series * rest + 0.2402410104f;
  series = series * rest + 0.6931242347f;
  series = series * rest + 1.0f;
  return lanes_as<Lanes>(lanes_as<LaneMask>(series) + (lanes_as<LaneMask>(shifted) << 23));
}

// Returns the logarithm to base 2 of normal numbers above 0, with an error below 1e-6.
inline Lanes log_of_two(Lanes x) {
  const LaneMask bits = lanes_as<LaneMask>(x);
  const LaneMask exponent = (bits - 0x3f3504f3) >> 23;  // mantissas from sqrt(1/2) to sqrt(2)
  const Lanes mantissa = lanes_as<Lanes>(bits - (exponent << 23));
  const Lanes t = (mantissa - 1) / (mantissa + 1), square = t * t;
  Lanes series = all_lanes(2 / 9.0f);
  series = series * square + 2 / 7.0f;
  series = series * square + 2 / 5.0f;
  series = series * square + 2 / 3.0f;
  series = series * square + 2.0f;
  return series * t * 1.44269504f + __builtin_convertvector(exponent, Lanes);
}

// Decodes sRGB (IEC 61966-2-1), which goes on above 1 and has nothing below 0.
inline Lanes decode_display(Lanes code) {
  code = positive_lanes(code);
  const Lanes base = lanes_max((code + 0.055f) * (1 / 1.055f), all_lanes(0.05f));
  return code <= 0.04045f ? code * (1 / 12.92f) : power_of_two(log_of_two(base) * 2.4f);
}
inline Lanes encode_display(Lanes linear) {
  linear = positive_lanes(linear);
  const Lanes base = lanes_max(linear, all_lanes(0.001f));
  return linear <= 0.0031308f ? linear * 12.92f
                              : power_of_two(log_of_two(base) * (1 / 2.4f)) * 1.055f - 0.055f;
}

inline Lanes code_lanes(const int16_t* codes) {
  using Codes = int16_t __attribute__((vector_size(2 * lane_count)));
  return __builtin_convertvector(load_lanes<Codes>(codes), Lanes);
}

// Computes colours seen along unit directions from the eye (Kerbl et al. 2023; Sloan 2008). `codes`
// are those of ShownSplats, of which the first 24 are the constant colour's.
inline Lanes3 seen_color(const int16_t* codes, int degree, Lanes color_scale, Lanes harmonics_scale,
                         Lanes3 d) {
  const auto coefficient = [&](int k) {
    const int16_t* at = codes + k * 3 * lane_count;
    return Lanes3{code_lanes(at), code_lanes(at + lane_count), code_lanes(at + 2 * lane_count)};
  };
  const Lanes3 constant = coefficient(0) * color_scale;
  if (degree == 0) return constant;
  const Lanes x = d.x, y = d.y, z = d.z;
  Lanes3 sum = coefficient(1) * (y * -0.4886025119f) + coefficient(2) * (z * 0.4886025119f) +
               coefficient(3) * (x * -0.4886025119f);
  if (degree >= 2) {
    const Lanes xx = x * x, yy = y * y, zz = z * z, xy = x * y;
    sum = sum + coefficient(4) * (xy * 1.0925484306f);
    sum = sum + coefficient(5) * (y * z * -1.0925484306f);
    sum = sum + coefficient(6) * ((2.0f * zz - xx - yy) * 0.3153915653f);
    sum = sum + coefficient(7) * (x * z * -1.0925484306f);
    sum = sum + coefficient(8) * ((xx - yy) * 0.5462742153f);
    if (degree >= 3) {
      sum = sum + coefficient(9) * (y * (3.0f * xx - yy) * -0.5900435899f);
      sum = sum + coefficient(10) * (xy * z * 2.8906114426f);
      sum = sum + coefficient(11) * (y * (4.0f * zz - xx - yy) * -0.4570457995f);
      sum = sum + coefficient(12) * (z * (2.0f * zz - 3.0f * (xx + yy)) * 0.3731763326f);
      sum = sum + coefficient(13) * (x * (4.0f * zz - xx - yy) * -0.4570457995f);
      sum = sum + coefficient(14) * (z * (xx - yy) * 1.4453057213f);
      sum = sum + coefficient(15) * (x * (xx - 3.0f * yy) * -0.5900435899f);
    }
  }
  return constant + sum * harmonics_scale;
}

}  // namespace wellspring::scan
