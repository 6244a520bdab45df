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
  size_t at = size_t(y) * size_t(light.width) + size_t(x);
  if (light.object[at] != place.object) return;
  uint32_t words[surface_planes];
  read_packed(light, x, y, words);
  uint32_t more = words[plane_more];
  float known = float((more >> 16) & 255u);
  if (known == 0) return;
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

}  // namespace

NearbyLight find_light_nearby(const View& view, const PixelRays& rays, const Frame& light,
                              const SeenPlace& place) {
  Sum sum;
  for (int ring = 0; ring <= rings && sum.points < enough_points; ring++)
    for (int y = std::max(place.y - ring, 0); y <= std::min(place.y + ring, light.height - 1);
         y++) {
      bool whole = y == place.y - ring || y == place.y + ring;
      for (int x = place.x - ring; x <= place.x + ring; x += whole || ring == 0 ? 1 : 2 * ring)
        if (x >= 0 && x < light.width) add_pixel(view, rays, light, place, x, y, sum);
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
