// SPDX-License-Identifier: Apache-2.0
// Where a texture coordinate falls between texels (glTF 2.0 section 3.8.4).
#pragma once
#include <cmath>
#include <cstdint>

#include "base/vec.h"

namespace wellspring::world {

enum class Wrap : uint8_t { repeat, mirror, clamp };

// The two texels on one axis and the weight of the second.
struct Taps {
  int first, second;
  float weight;
};

// Where `coordinate` (texture space, any finite value) falls on an axis of `size` texels, in [0,
// size].
inline float wrapped(float coordinate, int size, Wrap wrap) {
  switch (wrap) {
    case Wrap::repeat: coordinate -= std::floor(coordinate); break;
    case Wrap::mirror:
      coordinate -= 2 * std::floor(0.5f * coordinate);
      if (coordinate > 1) coordinate = 2 - coordinate;
      break;
    case Wrap::clamp: coordinate = glm::clamp(coordinate, 0.0f, 1.0f); break;
  }
  return coordinate * float(size);
}

inline Taps linear_taps(float coordinate, int size, Wrap wrap) {
  float x = wrapped(coordinate, size, wrap) - 0.5f;
  float low = std::floor(x);
  int first = int(low), second = first + 1;
  if (wrap == Wrap::repeat) {
    if (first < 0) first += size;
    if (second >= size) second -= size;
  }
  // Mirrored and clamped pictures meet their own edge texel there.
  return {glm::clamp(first, 0, size - 1), glm::clamp(second, 0, size - 1), x - low};
}

}  // namespace wellspring::world
