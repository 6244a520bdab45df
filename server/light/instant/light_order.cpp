// SPDX-License-Identifier: Apache-2.0
#include "light/instant/light_order.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace wellspring::light {
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

constexpr int bits = 9;  // of a coordinate; five more name the class

// Every third bit of the answer is one of x's.
uint32_t spread_bits(uint32_t x) {
  x = (x | x << 16) & 0x030000ffu;
  x = (x | x << 8) & 0x0300f00fu;
  x = (x | x << 4) & 0x030c30c3u;
  return (x | x << 2) & 0x09249249u;
}

struct Keyed {
  uint32_t key = 0;
  uint32_t light = 0;
};

// Ascending by key; what has the same key stays in order. By three digits, the last one first.
void sort_by_key(std::vector<Keyed>& items) {
  constexpr int digit = 11, digits = 3;
  std::vector<Keyed> sorted(items.size());
  for (int d = 0; d < digits; d++) {
    auto digit_of = [&](const Keyed& k) { return k.key >> (d * digit) & ((1u << digit) - 1); };
    std::vector<uint32_t> next((1u << digit) + 1, 0);
    for (const Keyed& k : items) next[digit_of(k) + 1]++;
    for (size_t i = 1; i < next.size(); i++) next[i] += next[i - 1];
    for (const Keyed& k : items) sorted[next[digit_of(k)]++] = k;
    items.swap(sorted);
  }
}

}  // namespace

std::vector<uint32_t> order_lights(const InstantPass& pass) {
  std::array<vec3, classes> low, high;
  low.fill(vec3(std::numeric_limits<float>::infinity()));
  high.fill(-low[0]);
  std::vector<Keyed> keyed;
  keyed.reserve(pass.lights.size());
  for (uint32_t i = 0; i < uint32_t(pass.lights.size()); i++) {
    const PointLight& light = pass.lights[i];
    if (light.exact) continue;
    uint32_t c = class_of(light);
    low[c] = glm::min(low[c], light.position), high[c] = glm::max(high[c], light.position);
    keyed.push_back({c, i});
  }
  constexpr float last = float((1 << bits) - 1);
  std::array<float, classes> scale;
  for (size_t c = 0; c < classes; c++)
    scale[c] = last / std::max(max_component(high[c] - low[c]), 1e-30f);
  for (Keyed& k : keyed) {
    const uint32_t c = k.key;
    const vec3 place = (pass.lights[k.light].position - low[c]) * scale[c];
    k.key = c << (3 * bits);
    for (int a = 0; a < 3; a++) k.key |= spread_bits(uint32_t(std::min(place[a], last))) << a;
  }
  sort_by_key(keyed);
  std::vector<uint32_t> order;
  order.reserve(keyed.size());
  for (const Keyed& k : keyed) order.push_back(k.light);
  return order;
}

}  // namespace wellspring::light
