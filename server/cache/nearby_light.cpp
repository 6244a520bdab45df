// SPDX-License-Identifier: Apache-2.0
#include "cache/nearby_light.h"

#include <bit>

#include "cache/packing.h"
#include "cache/pixel_light.h"

namespace wellspring {
namespace {

constexpr int rings = 5;
constexpr float enough_points = 6;      // found by a ring: no other is needed
constexpr float same_direction = 0.7f;  // cosine

struct Sum {
  float points = 0, samples = 0, squares = 0, deviation = 0;
  vec3 smooth{0}, rest{0};
};

// How much the surface that words tell of at (x, y) is the place's; 0: another one.
float alike(const View& view, const PixelRays& rays, const SeenPlace& place, int x, int y,
            const uint32_t* words) {
  vec3 normal = unpack_octahedron(uint16_t(words[plane_more] & 0xffffu));
  float facing = dot(normal, place.normal), length2 = dot(place.normal, place.normal);
  if (!(facing > 0) ||
      facing * facing < same_direction * same_direction * dot(normal, normal) * length2)
    return 0;
  float depth = std::bit_cast<float>(words[plane_depth]);
  vec2 ray(rays.x(float(x) + 0.5f), rays.y(float(y) + 0.5f));
  vec3 offset = (place.depth * place.ray.x - depth * ray.x) * view.right +
                (place.depth * place.ray.y - depth * ray.y) * view.up +
                (place.depth - depth) * view.forward;
  float off = dot(offset, place.normal) / (plane_tolerance * place.depth);
  off *= off / length2;
  return off <= 1 ? 1 / (1 + off) : 0;
}

void add_pixel(const View& view, const PixelRays& rays, const Frame& light, const SeenPlace& place,
               int x, int y, Sum& sum) {
  uint32_t words[surface_planes];
  read_packed(light, x, y, words);
  uint32_t more = words[plane_more];
  float known = float((more >> 16) & 255u);
  float dx = float(x - place.x), dy = float(y - place.y);
  float weight = 1 / (0.5f + dx * dx + dy * dy);
  vec3 theirs = unpack_albedo(words[plane_albedo]);
  // What a mirror shows has neither its place nor its normal.
  if (place.albedo != vec3(0)) weight *= alike(view, rays, place, x, y, words);
  if (weight == 0) return;
  float share = weight * known;
  sum.points++;
  sum.samples += share;
  sum.squares += share * weight;
  sum.deviation += share * unpack_deviation(uint8_t(more >> 24));
  sum.smooth += share * unpack_rgb9e5(words[plane_smooth]);
  sum.rest += share * unpack_rgb9e5(words[plane_rest]) * rest_ratio(place.albedo, theirs);
}

// Bit k: at column x + k of row y, within the picture, samples are known of the object.
constexpr int window = 2 * rings + 1;
static_assert(window <= 2 * lanes);
unsigned find_known(const Frame& light, uint32_t object, int x, int y) {
  if (y < 0 || y >= light.height) return 0;
  size_t row = size_t(y) * size_t(light.width);
  unsigned known = 0;
  if (x >= 0 && row + size_t(x + 2 * lanes) <= light.object.size()) {
    for (int half = 0; half < 2; half++) {
      size_t at = row + size_t(x + half * lanes);
      u8 more = load<u8>(&light.confidence[at]);
      known |= negative_lanes((load<u8>(&light.object[at]) == object) & ((more & 0xff0000u) != 0u))
               << half * lanes;
    }
    return known & ((1u << std::min(window, light.width - x)) - 1);
  }
  for (int k = std::max(-x, 0); k < std::min(window, light.width - x); k++) {
    size_t at = row + size_t(x + k);
    uint32_t more = std::bit_cast<uint32_t>(light.confidence[at]);
    known |= unsigned(light.object[at] == object && (more & 0xff0000u) != 0) << k;
  }
  return known;
}

}  // namespace

NearbyLight find_light_nearby(const View& view, const PixelRays& rays, const Frame& light,
                              const SeenPlace& place) {
  Sum sum;
  unsigned known[window];
  for (int ring = 0; ring <= rings && sum.points < enough_points; ring++)
    for (int dy = -ring; dy <= ring; dy++) {
      unsigned& row = known[rings + dy];
      bool whole = dy == -ring || dy == ring;
      if (whole) row = find_known(light, place.object, place.x - rings, place.y + dy);
      unsigned first = 1u << (rings - ring), last = 1u << (rings + ring),
               here = row & (whole ? 2 * last - first : first | last);
      for (; here != 0; here &= here - 1)
        add_pixel(view, rays, light, place, place.x - rings + std::countr_zero(here), place.y + dy,
                  sum);
    }
  NearbyLight found;
  if (sum.samples <= 0) return found;
  found.smooth = sum.smooth / sum.samples;
  found.rest = sum.rest / sum.samples;
  found.deviation = sum.deviation / sum.samples;
  found.samples = sum.samples * sum.samples / sum.squares;
  return found;
}

}  // namespace wellspring
