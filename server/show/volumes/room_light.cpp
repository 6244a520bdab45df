// SPDX-License-Identifier: Apache-2.0
#include "show/volumes/room_light.h"

#include <cmath>
#include <vector>

#include "base/rng.h"
#include "light/sample/sample_light.h"

namespace wellspring::show {
namespace {

constexpr int ways = 512;
constexpr float golden_turn = 2.399963f;

// Holds light that arrives from a direction: irradiance over pi of a surface that faces it.
struct Arriving {
  vec3 direction, light;
};

// Adds the light of lamps without size, which no ray meets.
void add_punctual(const World& world, const Lights& lights, vec3 place,
                  std::vector<Arriving>& arriving) {
  const LightTables& tables = *lights.tables;
  const Transport transport{world, tables};
  SurfacePlace from;
  from.position = place;
  for (size_t i = 0; i < tables.punctual.size(); i++) {
    LightSample light = eval_punctual(tables.punctual[i], tables.cones[i], from);
    if (light.pdf <= 0) continue;
    from.geometric_normal = light.direction;
    arriving.push_back(
        {light.direction, light.radiance * eval_visibility(transport, from, light) / pi});
  }
}

// Adds all other light, along directions spread evenly over the sphere (a spiral, Saff and
// Kuijlaars 1997).
void add_radiance(const World& world, const Lights& lights, const Technique& technique, vec3 place,
                  std::vector<Arriving>& arriving) {
  std::vector<Request> requests(ways);
  for (int i = 0; i < ways; i++) {
    Request& request = requests[size_t(i)];
    const float y = 1 - (2 * float(i) + 1) / float(ways), r = std::sqrt(1 - y * y);
    const float turn = golden_turn * float(i);
    request.ray.origin = place;
    request.ray.direction = {r * std::cos(turn), y, r * std::sin(turn)};
    request.seed = mix64(uint64_t(i));
  }
  std::vector<Sample> samples(ways);
  trace(technique, world, lights, {}, requests, samples);
  // The solid angle of a direction, over pi.
  constexpr float share = 4 / float(ways);
  for (size_t i = 0; i < samples.size(); i++)
    arriving.push_back({requests[i].ray.direction, samples[i].radiance() * share});
}

}  // namespace

VolumeLight room_light(const World& world, const Lights& lights, const Technique& technique,
                       const PlacedVolume& placed) {
  std::vector<Arriving> arriving;
  add_punctual(world, lights, placed.position, arriving);
  add_radiance(world, lights, technique, placed.position, arriving);
  vec3 all(0), pushed(0);
  for (const Arriving& one : arriving) {
    all += one.light;
    pushed += one.direction * luminance(one.light);
  }
  const float length = glm::length(pushed);
  VolumeLight found;
  found.lamp = vec3(0);
  vec3 direction(0, 1, 0);
  if (length > 1e-12f) {
    direction = pushed / length;
    for (const Arriving& one : arriving) found.lamp += one.light * dot(one.direction, direction);
    found.lamp = max(found.lamp, vec3(0));
  }
  // Light from one side alone has four times its share of the mean radiance.
  found.around = max(0.25f * (all - found.lamp), vec3(0));
  found.to_lamp = ToVolume(placed).way(direction);
  return found;
}

}  // namespace wellspring::show
