// SPDX-License-Identifier: Apache-2.0
// Holds what every pixel of a picture of points sees.
#pragma once
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "base/vec.h"

namespace wellspring::scan {

// Planes, row after row from the top left, each padded by `padding` items.
struct PointBuffer {
  static constexpr int padding = 16;
  static constexpr uint32_t no_node = 0xffffffffu;
  static constexpr uint32_t no_normal = 0x80008000u;

  int width = 0, height = 0;
  std::vector<float> depth;     // metres along the axis, positive; infinity: nothing there
  std::vector<uint32_t> color;  // as in NodePoints; 0 where nothing is
  // Octahedral (Meyer et al. 2010): signed halves u, v times 32767, u in the lower one, towards the
  // eye; no_normal: nothing there, or points without normals.
  std::vector<uint32_t> normal;
  std::vector<uint8_t> classification;  // 0 if the scan has none
  std::vector<uint32_t> node;           // number in the span that was drawn, or no_node

  // Keeps nothing of the last picture.
  void resize(int new_width, int new_height) {
    width = new_width, height = new_height;
    const size_t size = size_t(width) * size_t(height) + padding;
    depth.resize(size, std::numeric_limits<float>::infinity());
    color.resize(size);
    normal.resize(size, no_normal);
    classification.resize(size);
    node.resize(size, no_node);
  }
};

// Returns the unit normal of a word of PointBuffer::normal that is not no_normal.
inline vec3 point_normal(uint32_t word) {
  const float u = float(int16_t(word & 0xffff)) / 32767, v = float(int16_t(word >> 16)) / 32767;
  vec3 n(u, v, 1 - std::abs(u) - std::abs(v));
  if (n.z < 0) n = {std::copysign(1 - std::abs(v), u), std::copysign(1 - std::abs(u), v), n.z};
  return normalize(n);
}

}  // namespace wellspring::scan
