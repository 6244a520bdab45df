// SPDX-License-Identifier: Apache-2.0
#include "show/lawns/lawn_light.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/parallel.h"
#include "base/rng.h"
#include "light/sample/sample_light.h"
#include "light/walk/known_light.h"

namespace wellspring::show {
namespace {

constexpr float node_side = 0.15f;                  // metres
constexpr int most_nodes = 64, most_traced = 24;    // a side, with maps and without
constexpr int samples_a_node = 16;                  // without maps
constexpr float above = 0.04f, most_below = 0.05f;  // metres from the ground, of rays to it

// Returns the root that is nearest to a place in its tile; false: nothing grows there.
bool find_root(const Lawn& lawn, vec2 place, vec3& root) {
  const ivec2 at = clamp(ivec2((place - lawn.low) / lawn.tile_side), ivec2(0), lawn.tiles - 1);
  const LawnTile& tile = lawn.tile[size_t(at.y * lawn.tiles.x + at.x)];
  float least = INFINITY;
  for (size_t i = size_t(tile.begin); i < size_t(tile.begin + tile.count); i++) {
    const vec2 off = vec2(lawn.x[i], lawn.z[i]) - place;
    if (!(dot(off, off) < least)) continue;
    least = dot(off, off), root = {lawn.x[i], lawn.y[i], lawn.z[i]};
  }
  return least < INFINITY;
}

Ray ray_to_ground(vec3 root) {
  Ray ray;
  ray.origin = root + vec3(0, above, 0);
  ray.direction = {0, -1, 0};
  ray.t_max = above + most_below;
  return ray;
}

// Returns the maps' light on the ground.
vec3 known_at(const Transport& transport, vec3 root) {
  const Ray ray = ray_to_ground(root);
  const Hit hit = transport.world.intersect(ray);
  if (!hit.valid()) return vec3(0);
  return find_known_light(transport, ray, hit, root).light;
}

// Adds light that arrives from one direction to a node: the brightest is its lamp, all others are
// around. Maps have a light already if it is `kept`.
struct LampSum {
  LawnLight::Node node;
  vec3 kept_lamp{0};  // on level ground, as far as maps have the lamp
  void add(const LightSample& light, vec3 radiance, bool kept) {
    const vec3 facing = radiance / pi;
    const float down = std::max(light.direction.y, 0.0f);
    if (!(luminance(facing) > luminance(node.lamp))) {
      if (!kept) node.around += down * facing;
      return;
    }
    // The one before is around from now on, as maps have it anyway if it is kept.
    if (kept_lamp == vec3(0)) node.around += std::max(node.to_lamp.y, 0.0f) * node.lamp;
    node.lamp = facing, node.to_lamp = light.direction, node.lamp_distance = light.distance;
    kept_lamp = kept ? down * facing : vec3(0);
  }
};

LampSum find_lamp(const Transport& transport, std::span<const PunctualLight> more, vec3 root,
                  bool maps) {
  LampSum sum;
  SurfacePlace from;
  from.position = root + vec3(0, above, 0);
  auto add = [&](const PunctualLight& one, const SpotCone& cone, bool kept) {
    const LightSample light = eval_punctual(one, cone, from);
    if (!(light.pdf > 0) || !(light.direction.y > 0)) return;
    sum.add(light, light.radiance * eval_visibility(transport, from, light), kept);
  };
  const LightTables& tables = transport.tables;
  for (size_t i = 0; i < tables.punctual.size(); i++)
    add(tables.punctual[i], tables.cones[i], maps);
  for (const PunctualLight& one : more) add(one, make_spot_cone(one), false);
  return sum;
}

// Returns light that no lamp sends, at each root that is known.
std::vector<vec3> trace_around(const World& world, const Lights& lights, const Technique& technique,
                               std::span<const vec3> roots) {
  std::vector<Request> requests(roots.size() * samples_a_node);
  for (size_t i = 0; i < requests.size(); i++) {
    requests[i].ray = ray_to_ground(roots[i / samples_a_node]);
    requests[i].seed = mix64(i);
  }
  std::vector<Sample> samples(requests.size());
  trace(technique, world, lights, {}, requests, samples);
  std::vector<vec3> around(roots.size(), vec3(0));
  for (size_t i = 0; i < samples.size(); i++)
    around[i / samples_a_node] +=
        max(samples[i].smooth * samples[i].known - vec3(samples[i].raised), vec3(0)) *
        (1.0f / samples_a_node);
  return around;
}

}  // namespace

std::shared_ptr<const LawnLight> make_lawn_light(const World& world, const Lights& lights,
                                                 const Technique& technique, const Lawn& lawn,
                                                 std::span<const PunctualLight> more) {
  auto light = std::make_shared<LawnLight>();
  if (lawn.blades == 0) return light;
  const auto& maps = lights.maps ? lights.maps : lights.known;
  light->size = clamp(ivec2(glm::ceil((lawn.high - lawn.low) / node_side)), ivec2(1),
                      ivec2(maps ? most_nodes : most_traced));
  const int count = light->size.x * light->size.y;
  light->node.resize(size_t(count));
  std::vector<vec3> roots(light->node.size(), vec3(0));
  const Transport transport{world, *lights.tables, nullptr, nullptr, maps.get()};
  parallel_ranges(count, 16, [&](int begin, int end) {
    for (int i = begin; i < end; i++) {
      LawnLight::Node& node = light->node[size_t(i)];
      const vec2 share = (vec2(i % light->size.x, i / light->size.x) + 0.5f) / vec2(light->size);
      vec3& root = roots[size_t(i)];
      if (!find_root(lawn, lawn.low + share * (lawn.high - lawn.low), root)) continue;
      const LampSum sum = find_lamp(transport, more, root, maps != nullptr);
      node = sum.node;
      if (maps) node.around += max(known_at(transport, root) - sum.kept_lamp, vec3(0));
      node.known = true;
    }
  });
  if (maps) return light;
  const std::vector<vec3> around = trace_around(world, lights, technique, roots);
  for (size_t i = 0; i < around.size(); i++)
    if (light->node[i].known) light->node[i].around += around[i];
  return light;
}

}  // namespace wellspring::show
