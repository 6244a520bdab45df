// SPDX-License-Identifier: Apache-2.0
// A frame is a picture in linear light, as a technique or the render cache leaves it and the tone
// map takes it.
#pragma once
#include <cstdint>
#include <cstring>
#include <vector>

#include "base/memory.h"
#include "base/simd.h"
#include "base/vec.h"
#include "image/image.h"

namespace wellspring::frame {

// Holds planes in row-major order, top row first; each is width*height long, or empty if nobody
// needs it.
struct Frame {
  int width = 0, height = 0;
  std::vector<vec3> color;        // linear Rec. 709 radiance
  std::vector<float> depth;       // metres along the viewing axis; infinity: nothing hit
  std::vector<uint32_t> object;   // 0: nothing hit
  std::vector<float> confidence;  // 0 (guessed) to 1 (converged)
};
// Gives all planes that size; their contents mean nothing.
inline void fit_frame(int width, int height, Frame& frame) {
  size_t pixels = size_t(width) * size_t(height);
  frame.width = width;
  frame.height = height;
  frame.color.resize(pixels);
  frame.depth.resize(pixels);
  frame.object.resize(pixels);
  frame.confidence.resize(pixels);
}
inline size_t memory_bytes(const Frame& frame) {
  return bytes_of(frame.color, frame.depth, frame.object, frame.confidence);
}

// Writes lanes as pixels of a frame.

// Writes four pixels' channels one after the other.
inline void interleave(const HalfLanes& r, const HalfLanes& g, const HalfLanes& b, float* to) {
  HalfLanes low = __builtin_shufflevector(r, g, 0, 4, 1, 5),
            high = __builtin_shufflevector(r, g, 2, 6, 3, 7),
            middle = __builtin_shufflevector(low, b, 3, 5, 3, 5);
  store_lanes(to, __builtin_shufflevector(low, b, 0, 1, 4, 2));
  store_lanes(to + 4, __builtin_shufflevector(middle, high, 0, 1, 4, 5));
  store_lanes(to + 8, __builtin_shufflevector(high, b, 6, 2, 3, 7));
}
template <int First>
HalfLanes part(const Lanes& v) {
  return __builtin_shufflevector(v, v, First, First + 1, First + 2, First + 3);
}

}  // namespace wellspring::frame
