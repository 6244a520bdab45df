// SPDX-License-Identifier: Apache-2.0
// Copies parts of a network's features, as tiles of it read and leave them (denoise/unet.h): planes
// of `block` channels side by side, each rows of pixels.
#pragma once
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "base/vec.h"

namespace wellspring::denoise {

inline int round_up(int value, int step) { return (value + step - 1) / step * step; }

// Features are 32-bit floats, or their upper halves (bfloat16) if the processor multiplies these.
struct Format {
  int block = 8;  // channels side by side in memory
  bool bfloat16 = false;
  size_t bytes() const { return bfloat16 ? 2 : 4; }
};

inline Format best_format() {
  Format format;
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw")) format.block = 16;
  format.bfloat16 = format.block == 16 && __builtin_cpu_supports("avx512bf16");
#endif
  return format;
}

inline float read_element(const std::byte* from, const Format& format) {
  if (!format.bfloat16) {
    float value;
    std::memcpy(&value, from, 4);
    return value;
  }
  uint16_t upper;
  std::memcpy(&upper, from, 2);
  return std::bit_cast<float>(uint32_t(upper) << 16);
}

inline void write_element(float value, const Format& format, std::byte* to) {
  if (!format.bfloat16) {
    std::memcpy(to, &value, 4);
    return;
  }
  uint32_t bits = std::bit_cast<uint32_t>(value);
  auto upper = uint16_t((bits + 0x7fff + ((bits >> 16) & 1)) >> 16);  // to nearest, even
  std::memcpy(to, &upper, 2);
}

// A part of a level, which may reach beyond it.
struct Part {
  int left = 0, top = 0, width = 0, height = 0;
};

// Copies rows of pixels that lie within the level, with zeros around.
template <class CopyPixels>
void copy_part(const Part& part, int width, int height, size_t pixel_bytes, std::byte* to,
               const CopyPixels& copy) {
  int first = std::clamp(-part.left, 0, part.width),
      last = std::clamp(width - part.left, first, part.width);
  size_t row_bytes = size_t(part.width) * pixel_bytes;
  for (int y = 0; y < part.height; y++, to += row_bytes) {
    int row = part.top + y;
    if (row < 0 || row >= height) {
      std::memset(to, 0, row_bytes);
      continue;
    }
    std::memset(to, 0, size_t(first) * pixel_bytes);
    if (last > first) copy(row, part.left + first, last - first, to + size_t(first) * pixel_bytes);
    std::memset(to + size_t(last) * pixel_bytes, 0, size_t(part.width - last) * pixel_bytes);
  }
}

// Clears what a layer leaves beyond the level's border: it is no feature, and the next layer reads
// zeros there.
inline void clear_beyond(const Part& part, int width, int height, int channels,
                         const Format& format, std::byte* data) {
  int first = std::clamp(-part.left, 0, part.width),
      last = std::clamp(width - part.left, first, part.width);
  int top = std::clamp(-part.top, 0, part.height),
      bottom = std::clamp(height - part.top, top, part.height);
  if (first == 0 && last == part.width && top == 0 && bottom == part.height) return;
  size_t pixel = size_t(format.block) * format.bytes(), row = size_t(part.width) * pixel;
  for (int block = 0; block < channels / format.block; block++)
    for (int y = 0; y < part.height; y++, data += row) {
      if (y < top || y >= bottom) {
        std::memset(data, 0, row);
        continue;
      }
      std::memset(data, 0, size_t(first) * pixel);
      std::memset(data + size_t(last) * pixel, 0, size_t(part.width - last) * pixel);
    }
}

// Returns a tile's side of about `wanted` pixels, even, so that whole tiles cover the extent.
inline int tile_extent(int extent, int wanted) {
  int count = std::max(1, (extent + wanted / 2) / wanted);
  return round_up((extent + count - 1) / count, 2);
}

// Encodes radiance as the published networks see it: by the perceptually uniform curve of Open
// Image Denoise (a fit of PU encoding, Aydin, Mantiuk, Seidel 2008, for luminances of 1e-6 to
// 65504), 0 to 1.

namespace transfer {
inline constexpr float a = 1412.83765f, b = 1.64593172f, c = 0.431384981f, d = -0.00294139609f,
                       e = 0.192653254f, f = 0.00626026094f, g = 0.998620152f;
inline constexpr float y0 = 1.5794576e-6f, y1 = 0.0322087631f;  // values at which the pieces meet
inline constexpr float x0 = 0.00223151711f, x1 = 0.370974749f;  // the same, encoded
inline constexpr float most = 65504;  // the largest half, which is encoded as 1

inline float piece(float y) {
  if (y <= y0) return a * y;
  if (y <= y1) return b * std::pow(y, c) + d;
  return e * std::log(y + f) + g;
}
inline const float largest = piece(most);
}  // namespace transfer

// Encodes a value; NaN and negative ones count as 0, larger ones than `most` as that.
inline float encode_radiance(float y) {
  return transfer::piece(y > 0 ? std::min(y, transfer::most) : 0.0f) / transfer::largest;
}
inline float decode_radiance(float x) {
  using namespace transfer;
  x = (x > 0 ? std::min(x, 1.0f) : 0.0f) * largest;
  if (x <= x0) return x / a;
  if (x <= x1) return std::pow((x - d) / b, 1 / c);
  return std::exp((x - g) / e) - f;
}

}  // namespace wellspring::denoise
