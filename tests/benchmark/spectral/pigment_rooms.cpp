// SPDX-License-Identifier: Apache-2.0
#include "pigment_rooms.h"

#include <algorithm>

#include "light/technique/technique.h"
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

}  // namespace

PigmentErrors render_pigments(std::span<const Spectrum> pigments, const std::string& lamp,
                              int samples) {
  const Spectrum power = spectrum::find_lamp(lamp)->power;
  const LampObserver observer(power);
  Scene scene = empty_scene();
  std::vector<int> materials;
  for (const Spectrum& one : pigments) materials.push_back(add_pigment(scene, one));
  const size_t count = pigments.size();
  for (size_t i = 0; i < count; i++) add_room(scene, i, materials[i], materials[(i + 1) % count]);
  // A room without pigments tells how much light there is.
  const int white = add_material(scene, diffuse(vec3(1)));
  add_room(scene, count, white, white);
  PunctualLight light;
  light.type = PunctualType::directional;
  light.direction = {0, 1, 0};
  light.intensity = vec3(1);
  scene.lights.push_back(light);
  scene.lamps.push_back({"lamp", {0}, {}});
  set_lamp_spectrum(scene, scene.lamps[0], add_spectrum(scene, lamp, power));
  const LitWorld lit(std::move(scene));
  auto straight = [&](size_t i, int n) {
    return look(lit, {.origin = room(i) + vec3(4.5f, 0, 0), .direction = {0, 1, 0}}, 2, n);
  };
  auto reflected = [&](size_t i, int n) {
    return look(lit, {.origin = room(i) + vec3(0, 0.05f, 0), .direction = {0, -1, 0}}, 3, n);
  };
  // White has the light's colour: the channel that is largest in it is not cut.
  const vec3 color = lit.scene.lights[0].intensity;
  const int channel = color.x > color.z ? 0 : 2;
  auto brightness = [&](const dvec3& seen) { return seen[channel] / double(color[channel]); };
  const double once = brightness(straight(count, 1).color),
               twice = brightness(reflected(count, samples).color);
  PigmentErrors errors;
  auto difference = [&](const dvec3& rgb, const Spectrum& truth) {
    return ciede2000(lab_of(xyz_of_rgb(rgb), observer.white()),
                     lab_of(observer.xyz(truth), observer.white()));
  };
  for (size_t i = 0; i < count; i++) {
    const Seen second = reflected(i, samples);
    errors.once.push_back(difference(straight(i, 1).color / once, pigments[i]));
    errors.twice.push_back(
        difference(second.color / twice, product(pigments[i], pigments[(i + 1) % count])));
    errors.negative += second.negative / double(count);
  }
  return errors;
}

}  // namespace wellspring::test
