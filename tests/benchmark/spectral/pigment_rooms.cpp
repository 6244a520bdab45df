// SPDX-License-Identifier: Apache-2.0
#include "pigment_rooms.h"

#include <algorithm>

#include "light/kept/finish_bake.h"
#include "light/technique/technique.h"
#include "light/walk/known_light.h"
#include "scenes/lit_world.h"
#include "spectrum/color.h"
#include "spectrum/lamps.h"
#include "spectrum/observer.h"
#include "world/load/scene_spectra.h"

namespace wellspring::test {
namespace {

using namespace scenes;

constexpr float apart = 20;  // metres from a room to the next

// Room i is at x = apart * i. Light comes from below: it falls on a ceiling of the second pigment,
// from there on the upper side of a small patch of the first. The lower side of another patch is
// lit straight.
vec3 room(size_t i) { return {apart * float(i), 0, 0}; }

void add_room(Scene& scene, size_t i, int first, int second) {
  const vec3 at = room(i);
  add_quad(scene, second, at + vec3(-1, 0.1f, -1), {2, 0, 0}, {0, 0, 2}, "ceiling");
  add_quad(scene, first, at + vec3(-0.005f, 0, 0.005f), {0.01f, 0, 0}, {0, 0, -0.01f}, "patch");
  add_quad(scene, first, at + vec3(4, 0.1f, -0.5f), {1, 0, 0}, {0, 0, 1}, "lit patch");
}

int add_pigment(Scene& scene, const Spectrum& reflectance) {
  Material material = diffuse(vec3(1));
  set_reflectance(scene, material, add_spectrum(scene, "pigment", reflectance));
  return add_material(scene, material);
}

// Holds the mean of samples, and the share of them below zero in a channel.
struct Seen {
  dvec3 color{0};
  double negative = 0;
};
Seen look(const LitWorld& lit, const Ray& ray, int max_depth, int count) {
  std::vector<Request> requests(static_cast<size_t>(count));
  for (size_t i = 0; i < requests.size(); i++)
    requests[i] = {.ray = ray, .seed = 1, .index = uint32_t(i)};
  std::vector<Sample> samples(requests.size());
  TransportSettings settings;
  settings.max_depth = max_depth;
  trace(*find_technique("path"), lit.world, lit.lights, settings, requests, samples);
  Seen seen;
  for (const Sample& sample : samples) {
    seen.color += dvec3(sample.radiance()) / double(count);
    seen.negative +=
        std::min({sample.smooth.x, sample.smooth.y, sample.smooth.z}) < 0 ? 1.0 / count : 0;
  }
  return seen;
}

// Makes a room for each pigment and one without, which tells how much light there is.
Scene make_rooms(std::span<const Spectrum> pigments) {
  Scene scene = empty_scene();
  std::vector<int> materials;
  for (const Spectrum& one : pigments) materials.push_back(add_pigment(scene, one));
  const size_t count = pigments.size();
  for (size_t i = 0; i < count; i++) add_room(scene, i, materials[i], materials[(i + 1) % count]);
  const int white = add_material(scene, diffuse(vec3(1)));
  add_room(scene, count, white, white);
  PunctualLight light;
  light.type = PunctualType::directional;
  light.direction = {0, 1, 0};
  light.intensity = vec3(1);
  scene.lights.push_back(light);
  scene.lamps.push_back({"lamp", {0}, {}});
  return scene;
}

Ray straight_ray(size_t i) {
  return {.origin = room(i) + vec3(4.5f, 0, 0), .direction = {0, 1, 0}};
}
Ray reflected_ray(size_t i) {
  return {.origin = room(i) + vec3(0, 0.05f, 0), .direction = {0, -1, 0}};
}

// White has the light's colour: the channel that is largest in it is not cut.
double brightness(const dvec3& white, const vec3& lamp) {
  const int channel = lamp.x > lamp.z ? 0 : 2;
  return white[channel] / double(lamp[channel]);
}

double difference(const LampObserver& observer, const dvec3& rgb, const dvec3& truth) {
  return ciede2000(lab_of(xyz_of_rgb(rgb), observer.white()), lab_of(truth, observer.white()));
}
double difference(const LampObserver& observer, const dvec3& rgb, const Spectrum& truth) {
  return difference(observer, rgb, observer.xyz(truth));
}
// Maps keep no channel below zero, as displays show none.
double kept_difference(const LampObserver& observer, const dvec3& rgb, const Spectrum& truth) {
  return difference(observer, rgb, xyz_of_rgb(glm::max(rgb_of(observer.xyz(truth)), dvec3(0))));
}

}  // namespace

PigmentErrors render_pigments(std::span<const Spectrum> pigments, const std::string& lamp,
                              int samples) {
  const Spectrum power = spectrum::find_lamp(lamp)->power;
  const LampObserver observer(power);
  Scene scene = make_rooms(pigments);
  set_lamp_spectrum(scene, scene.lamps[0], add_spectrum(scene, lamp, power));
  const LitWorld lit(std::move(scene));
  const size_t count = pigments.size();
  auto straight = [&](size_t i, int n) { return look(lit, straight_ray(i), 2, n); };
  auto reflected = [&](size_t i, int n) { return look(lit, reflected_ray(i), 3, n); };
  const vec3 color = lit.scene.lights[0].intensity;
  const double once = brightness(straight(count, 1).color, color),
               twice = brightness(reflected(count, samples).color, color);
  PigmentErrors errors;
  for (size_t i = 0; i < count; i++) {
    const Seen second = reflected(i, samples);
    errors.once.push_back(difference(observer, straight(i, 1).color / once, pigments[i]));
    errors.twice.push_back(difference(observer, second.color / twice,
                                      product(pigments[i], pigments[(i + 1) % count])));
    errors.negative += second.negative / double(count);
  }
  return errors;
}

std::vector<PigmentErrors> turn_dial(std::span<const Spectrum> pigments,
                                     std::span<const char* const> lamps) {
  Scene scene = make_rooms(pigments);
  Lamp& lamp = scene.lamps[0];
  for (const char* name : lamps) {
    const int power = add_spectrum(scene, name, spectrum::find_lamp(name)->power);
    const vec3 color = lamp_color(scene.spectra[size_t(power)].value);
    if (lamp.dial.empty()) set_lamp_spectrum(scene, lamp, power);
    lamp.dial.push_back({power, color / scene.lights[0].intensity});
  }
  const World world(scene);
  const BakeScene lit = make_bake_scene_of_paths(world);
  Bake bake = begin_bake(world, {}, {.gather_nodes = 4000, .direct_nodes = 4000});
  go_on(lit, bake, [&] { return bake.passes >= 8; });
  const auto all = finish_map(bake);
  const size_t count = pigments.size();
  std::vector<PigmentErrors> errors;
  for (size_t k = 0; k < lamps.size(); k++) {
    const LampLevel turned(lamp_full, uint8_t(k + 1));
    const auto map = relit(*all, find_layer_colors(scene, std::span(&turned, 1)));
    auto seen = [&](const Ray& ray) {
      const Hit hit = world.intersect(ray);
      const uint32_t chart = find_chart(*map->places, world, ray, hit);
      const vec3 place = ray.origin + hit.t * ray.direction;
      return dvec3(eval_illumination(*map, map->places->charts[chart], place) *
                   vec3(world.material_of(hit.instance).base_color));
    };
    const LampObserver observer(spectrum::find_lamp(lamps[k])->power);
    const vec3 color = scene.lights[0].intensity * lamp.dial[k].factor;
    const double once = brightness(seen(straight_ray(count)), color),
                 twice = brightness(seen(reflected_ray(count)), color);
    PigmentErrors& own = errors.emplace_back();
    for (size_t i = 0; i < count; i++) {
      own.once.push_back(kept_difference(observer, seen(straight_ray(i)) / once, pigments[i]));
      own.twice.push_back(kept_difference(observer, seen(reflected_ray(i)) / twice,
                                          product(pigments[i], pigments[(i + 1) % count])));
    }
  }
  return errors;
}

}  // namespace wellspring::test
