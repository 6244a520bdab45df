// SPDX-License-Identifier: Apache-2.0
#include "scan/draw/point_colors.h"

#include <algorithm>
#include <array>

#include "image/srgb.h"

namespace wellspring::scan {
namespace {

using Code = std::array<uint8_t, 3>;

constexpr Code grey{160, 160, 160};
constexpr std::array<Code, 18> class_codes = {{grey,
                                               grey,
                                               {166, 124, 82},   // ground
                                               {150, 190, 110},  // low, medium and high plants
                                               {90, 160, 80},
                                               {40, 120, 60},
                                               {205, 92, 72},   // building
                                               {230, 60, 160},  // noise
                                               grey,
                                               {70, 130, 200},  // water
                                               {110, 90, 80},   // rail
                                               {90, 90, 100},   // road
                                               grey,
                                               {240, 200, 60},  // wires
                                               {250, 230, 120},
                                               {120, 120, 180},  // tower
                                               {250, 150, 60},
                                               {190, 180, 170}}};  // bridge

// Steps of the scale of heights, about equally bright.
constexpr std::array<Code, 5> height_codes = {
    {{70, 90, 190}, {60, 160, 190}, {110, 180, 90}, {220, 180, 70}, {200, 80, 60}}};

vec3 decode(const Code& code) {
  return {decode_srgb(code[0]), decode_srgb(code[1]), decode_srgb(code[2])};
}

}  // namespace

vec3 captured_color(uint32_t word) {
  return decode({uint8_t(word), uint8_t(word >> 8), uint8_t(word >> 16)});
}

vec3 intensity_color(uint32_t word) { return vec3(decode_srgb(uint8_t(word >> 24))); }

vec3 height_color(float share) {
  constexpr size_t last = height_codes.size() - 1;
  const float turn = float(last) * (share > 0 ? std::min(share, 1.0f) : 0.0f);
  const size_t low = std::min(size_t(turn), last - 1);
  return glm::mix(decode(height_codes[low]), decode(height_codes[low + 1]), turn - float(low));
}

vec3 class_color(uint8_t code) {
  return decode(code < class_codes.size() ? class_codes[code] : grey);
}

}  // namespace wellspring::scan
