// SPDX-License-Identifier: Apache-2.0
#include "light/light_order.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace wellspring {
namespace {

// Six ways to face, and what has no such way.
constexpr uint32_t distant = 6, all_around = 7, double_sided = 8, scattering = 16, classes = 32;

uint32_t class_of(const PointLight& light) {
  if (light.kind == PointLightKind::distant) return distant;
  if (light.kind == PointLightKind::punctual) return all_around;
  vec3 size = glm::abs(light.normal);
  int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  uint32_t way = uint32_t(2 * axis) + (light.normal[axis] < 0);
  return way + (light.double_sided ? double_sided : 0) +
         (light.kind == PointLightKind::scattering ? scattering : 0);
}

// Every third bit of the answer is one of x's.
uint64_t spread_bits(uint64_t x) {
  x = (x | x << 32) & 0x1f00000000ffffull;
  x = (x | x << 16) & 0x1f0000ff0000ffull;
  x = (x | x << 8) & 0x100f00f00f00f00full;
  x = (x | x << 4) & 0x10c30c30c30c30c3ull;
  return (x | x << 2) & 0x1249249249249249ull;
}

}  // namespace

std::vector<uint32_t> order_lights(const InstantPass& pass) {
  constexpr int bits = 16;
  struct Keyed {
    uint64_t key;
    uint32_t light;
  };
  std::array<vec3, classes> low, high;
  low.fill(vec3(std::numeric_limits<float>::infinity()));
  high.fill(-low[0]);
  std::vector<Keyed> keyed;
  for (uint32_t i = 0; i < uint32_t(pass.lights.size()); i++) {
    const PointLight& light = pass.lights[i];
    if (light.exact) continue;
    uint32_t c = class_of(light);
    low[c] = glm::min(low[c], light.position), high[c] = glm::max(high[c], light.position);
    keyed.push_back({c, i});
  }
  for (Keyed& k : keyed) {
    size_t c = size_t(k.key);
    vec3 size = high[c] - low[c], place = pass.lights[k.light].position - low[c];
    const float last = float((1 << bits) - 1), scale = last / std::max(max_component(size), 1e-30f);
    uint64_t code = uint64_t(c) << (3 * bits);
    for (int a = 0; a < 3; a++)
      code |= spread_bits(uint64_t(std::min(place[a] * scale, last))) << a;
    k.key = code;
  }
  std::sort(keyed.begin(), keyed.end(), [](const Keyed& a, const Keyed& b) {
    return a.key != b.key ? a.key < b.key : a.light < b.light;
  });
  std::vector<uint32_t> order;
  order.reserve(keyed.size());
  for (const Keyed& k : keyed) order.push_back(k.light);
  return order;
}

}  // namespace wellspring
