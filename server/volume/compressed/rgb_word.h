// SPDX-License-Identifier: Apache-2.0
// A colour of a codevector in 11-11-10 bits. Red and green count quarters of a display code, blue
// counts halves, each from -256 to less than 256: enough for residuals of either sign. The word is
// red * 2^21 + green * 2^10 + blue modulo 2^32, so words of several levels can be added as they
// are: carries of negative colours undo one another, and the sum's fields are the fields' sums, if
// these lie in a range as wide as the field. Tables of level 0 carry a bias that makes this range
// -128 to 383: whoever makes codes sees to it that sums lie in it (see `compress`).
#pragma once
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

#include "base/layers.h"

namespace wellspring::volume {

inline constexpr int rgb_below = 128;  // the least sum is minus this
inline constexpr glm::vec3 rgb_step{0.25f, 0.25f, 0.5f};
// Fields count from -rgb_below, and half a display code more, so that they only need to be cut.
inline constexpr uint32_t rgb_bias =
    ((rgb_below * 4u + 2u) << 21) + ((rgb_below * 4u + 2u) << 10) + (rgb_below * 2u + 1u);

inline uint32_t to_rgb_word(glm::vec3 color) {
  const auto count = [](float x, float step, int most) {
    const float steps = std::round(x / step);
    return uint32_t(int(std::fmin(std::fmax(steps, float(-most - 1)), float(most))));
  };
  return (count(color.x, rgb_step.x, 1023) << 21) + (count(color.y, rgb_step.y, 1023) << 10) +
         count(color.z, rgb_step.z, 511);
}

// Returns the colour of a word without bias.
inline glm::vec3 from_rgb_word(uint32_t word) {
  const int blue = int32_t(word << 22) >> 22;
  word -= uint32_t(blue);
  const int green = int32_t(word << 11) >> 21;
  word -= uint32_t(green) << 10;
  const int red = int32_t(word) >> 21;
  return glm::vec3(red, green, blue) * rgb_step;
}

// Returns the colour of a sum with one bias.
inline glm::vec3 from_biased_rgb(uint32_t word) {
  const glm::vec3 fields(int(word >> 21), int(word >> 10 & 2047), int(word & 1023));
  return (fields - glm::vec3(2, 2, 1)) * rgb_step - float(rgb_below);
}

}  // namespace wellspring::volume
