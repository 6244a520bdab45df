// SPDX-License-Identifier: Apache-2.0
// Rays of views find where light on what moves is seen (light/known/skin_light.h).
#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/rng.h"
#include "light/known/skin_light.h"
#include "world/surface.h"

namespace wellspring::light {
namespace {

constexpr float nearest_seen = 1e-3f;  // metres: what is nearer may be anywhere
constexpr int most_panes_seen = 8;     // in a row
constexpr uint32_t nowhere = 0xffffffffu;

struct Rectangle {
  vec2 low{INFINITY}, high{-INFINITY};
};

Rectangle rectangle_of(const Bounds& box, const View& view) {
  const vec2 size(float(view.width), float(view.height));
  Rectangle window;
  for (int k = 0; k < 8; k++) {
    const vec3 corner(k & 1 ? box.high.x : box.low.x, k & 2 ? box.high.y : box.low.y,
                      k & 4 ? box.high.z : box.low.z);
    const Projected at = project_point(view, corner);
    if (!(at.depth > nearest_seen)) return {vec2(0), size};
    window.low = glm::min(window.low, vec2(at.x, at.y));
    window.high = glm::max(window.high, vec2(at.x, at.y));
  }
  return {glm::clamp(window.low, vec2(0), size), glm::clamp(window.high, vec2(0), size)};
}

// Finds what the ray meets behind clear panes.
Hit look(const World& world, Ray ray) {
  Hit hit = world.intersect(ray);
  for (int i = 0; i < most_panes_seen && hit.valid(); i++) {
    if (!(world.material_of(hit.instance).transmission > 0)) break;
    ray.t_min = hit.t * 1.00001f + 1e-5f;
    hit = world.intersect(ray);
  }
  return hit;
}

// One of the triangle's corners, the likelier the nearer, of the side that is seen.
uint32_t place_at(const World& world, const SkinLight& skin, const Hit& hit, vec3 direction,
                  float choice) {
  if (!hit.valid() || hit.instance < skin.first_instance) return nowhere;
  const uvec3 corners = world.mesh_of(hit.instance).triangles[hit.triangle];
  const vec2 at = hit.barycentric;
  const uint32_t vertex = choice < at.x ? corners.y : choice < at.x + at.y ? corners.z : corners.x;
  const bool back = dot(eval_face(world, hit.instance, hit.triangle), direction) > 0;
  return (back ? skin.back
               : skin.front)[skin.first_vertex[hit.instance - skin.first_instance] + vertex];
}

}  // namespace

SkinSight see_skin(const World& world, const SkinLight& skin, const View& view, int rays,
                   uint64_t turn) {
  SkinSight sight;
  const Bounds box = world.moving_bounds();
  if (skin.places.empty() || !(box.low.x <= box.high.x)) return sight;
  const Rectangle window = rectangle_of(box, view);
  const vec2 size = window.high - window.low;
  const float pixels = size.x * size.y;
  if (!(pixels > 0)) return sight;
  const int count = std::clamp(int(std::min(std::ceil(pixels), 1e9f)), 1, std::max(rays, 1));
  std::vector<uint32_t> met(size_t(count), nowhere);
  // The R2 sequence (Roberts 2018), begun anywhere.
  const uint64_t random = mix64(turn);
  const double begin_x = double(random >> 40) * 0x1p-24,
               begin_y = double(random & 0xffffff) * 0x1p-24;
  parallel_ranges(count, 64, [&](int begin, int end) {
    for (int i = begin; i < end; i++) {
      const vec2 at(float(std::fmod(begin_x + i * 0.7548776662466927, 1.0)),
                    float(std::fmod(begin_y + i * 0.5698402909980532, 1.0)));
      const vec2 place = window.low + at * size;
      const Ray ray = view_ray(view, place.x, place.y);
      const float choice = float(mix64(random + uint64_t(i)) >> 40) * 0x1p-24f;
      met[size_t(i)] = place_at(world, skin, look(world, ray), ray.direction, choice);
    }
  });
  for (uint32_t place : met)
    if (place != nowhere) sight.places.push_back(place);
  sight.pixels = pixels * float(sight.places.size()) / float(count);
  return sight;
}

}  // namespace wellspring::light
