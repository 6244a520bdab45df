// SPDX-License-Identifier: Apache-2.0
// Volumes in the light of a room: they shade it, and are seen, also in mirrors and behind panes.
#include <gtest/gtest.h>

#include <cmath>

#include "light/material/bsdf_types.h"
#include "light/sample/light_tables.h"
#include "light/walk/light_walk.h"
#include "scenes/scenes.h"
#include "unit/light/statistics.h"
#include "unit/light/volume_slab.h"
#include "world/surface.h"

namespace wellspring::test {
namespace {

using namespace scenes;

constexpr int many = 400000;

// Rays from above, beside the volumes, to nearby places on the floor.
Mean floor_light(const char* technique, const World& world, TransportSettings settings = {}) {
  const Lights lights = make_lights(world);
  std::vector<Request> requests(static_cast<size_t>(many));
  Rng random(3);
  for (size_t i = 0; i < requests.size(); i++) {
    requests[i].ray =
        ray_towards({4, 1, 0}, {0.2f * random.uniform() - 0.1f, 0, 0.2f * random.uniform() - 0.1f});
    requests[i].seed = sample_seed(5, 0, 0, uint32_t(i));
  }
  std::vector<Sample> samples(requests.size());
  trace(*find_technique(technique), world, lights, settings, requests, samples);
  Mean mean;
  for (const Sample& sample : samples) mean.add(double(luminance(sample.radiance())));
  return mean;
}

PunctualLight sun() {
  return {.type = PunctualType::directional, .direction = {0, -1, 0}, .intensity = vec3(2)};
}

TEST(VolumesInLight, AFloorGetsTheShareOfTheSunThatASlabLetsThrough) {
  Scene scene = make_plane_with_punctual(sun());
  World world(scene);
  TransportSettings settings;
  settings.max_depth = 2;
  const double open = 0.5 * 2 / pi;
  expect_mean(floor_light("path", world, settings), open, "without a volume");
  for (double thickness : {0.3, 1.5}) {
    world.place_volumes({slab(thickness, {0, 2, 0}, 50)});
    for (const char* technique : {"path", "direct", "gather"})
      expect_mean(floor_light(technique, world, settings), open * std::exp(-thickness), technique,
                  0.005);
  }
}

TEST(VolumesInLight, ALampInsideShinesThroughHalf) {
  PunctualLight lamp;
  lamp.position = {0, 2, 0};
  Scene scene = make_plane_with_punctual(lamp);
  World world(scene);
  TransportSettings settings;
  settings.max_depth = 2;
  const Mean open = floor_light("path", world, settings);
  world.place_volumes({slab(1.2, {0, 2, 0}, 50)});
  const Mean shaded = floor_light("path", world, settings);
  // Straight down it is exp(-0.6); at the border of the places the way is 0.25 % longer.
  EXPECT_NEAR(shaded.mean() / open.mean(), std::exp(-0.6), 0.005);
}

// Light sampling and walks that meet the lamp by chance are shaded alike.
TEST(VolumesInLight, AnAreaLampIsShadedHoweverItIsFound) {
  Scene scene = empty_scene();
  add_floor(scene, 0.5f);
  add_quad(scene, emitter(vec3(10)), {-0.5f, 4, -0.5f}, {1, 0, 0}, {0, 0, 1}, "lamp");
  scene.environment.radiance = vec3(0.2f);
  World world(scene);
  TransportSettings settings;
  settings.max_depth = 2;
  const Mean open = floor_light("path", world, settings);
  // Wide and thin, so that all light of the lamp comes through it nearly straight.
  world.place_volumes({slab(0.7, {0, 1.95f, 0}, 40)});
  Mean expected;
  const Lights lights = make_lights(world);
  Rng random(8);
  for (int i = 0; i < many; i++) {  // by formula: cosines and lengths of ways to places on the lamp
    const dvec3 from(0.2 * random.uniform() - 0.1, 0, 0.2 * random.uniform() - 0.1),
        to(random.uniform() - 0.5, 4, random.uniform() - 0.5);
    const double cosine = 4 / length(to - from), d2 = dot(to - from, to - from);
    expected.add(0.5 / pi * 10 * cosine * cosine / d2 * std::exp(-0.7 / cosine));
  }
  // The sky through the slab, and past it, by cosine-weighted directions.
  Mean sky;
  for (int i = 0; i < many; i++) {
    const double u = random.uniform(), phi = 2 * double(pi) * random.uniform(),
                 cosine = std::sqrt(1 - u), sine = std::sqrt(u);
    const dvec3 way(sine * std::cos(phi), cosine, sine * std::sin(phi)),
        from(0.2 * random.uniform() - 0.1, 0, 0.2 * random.uniform() - 0.1);
    const dvec3 lamp = from + way * (4 / cosine);
    if (std::abs(lamp.x) < 0.5 && std::abs(lamp.z) < 0.5) {
      sky.add(0);
      continue;
    }
    double near = 0, far = 1e9;
    for (int axis = 0; axis < 3; axis++) {
      const double middle = axis == 1 ? 1.95 : 0, half = axis == 1 ? 0.2 : 0.8;
      const double a = (middle - half - from[axis]) / way[axis],
                   b = (middle + half - from[axis]) / way[axis];
      near = std::max(near, std::min(a, b)), far = std::min(far, std::max(a, b));
    }
    sky.add(0.5 * 0.2 * std::exp(-0.7 * std::max(far - near, 0.0) / 0.4));
  }
  const Mean shaded = floor_light("path", world, settings);
  EXPECT_LT(shaded.mean(), 0.75 * open.mean());
  EXPECT_NEAR(shaded.mean() / (expected.mean() + sky.mean()), 1, 0.005);
}

// Mean colour of rays through a square that the volume fills in part.
vec3 seen_color(const char* technique, const World& world, vec3 eye, vec3 target,
                bool sees = true) {
  const Lights lights = make_lights(world);
  std::vector<Request> requests(static_cast<size_t>(many / 2));
  Rng random(13);
  for (size_t i = 0; i < requests.size(); i++) {
    requests[i].ray = ray_towards(
        eye, target + vec3(2.4f * (random.uniform() - 0.5f), 0.7f * (random.uniform() - 0.5f), 0));
    requests[i].seed = sample_seed(6, 0, 0, uint32_t(i));
  }
  std::vector<Sample> samples(requests.size());
  TransportSettings settings;
  settings.sees_volumes = sees;
  trace(*find_technique(technique), world, lights, settings, requests, samples);
  dvec3 sum(0);
  for (const Sample& sample : samples) sum += dvec3(sample.radiance());
  return vec3(sum / double(samples.size()));
}

TEST(VolumesInLight, AMirrorShowsAVolumeAsItIs) {
  Scene scene = empty_scene();
  add_wall(scene, metal(vec3(1), 0), -2, 9, "mirror");
  add_quad(scene, diffuse(vec3(0.5f)), {-9, -9, 8}, {0, 18, 0}, {18, 0, 0}, "behind the eye");
  scene.lights = {{.position = {3, 3, 0}, .intensity = vec3(0.4f)}};
  World world(scene);
  world.place_volumes({slab(1.5, {0, 0, 1}, 40, 0.8f)});
  // The eye and the volume as they are in the mirror: what lies behind is what the mirror shows.
  const vec3 eye(0, 0, -1.5f), mirrored(0, 0, -2.5f), image(0, 0, -5);
  for (const char* technique : {"path", "direct"}) {
    Scene no_mirror = scene;
    no_mirror.instances.erase(no_mirror.instances.begin());
    World straight(no_mirror);
    straight.place_volumes({world.volumes().begin(), world.volumes().end()});
    const vec3 in_mirror = seen_color(technique, world, eye, image),
               direct = seen_color(technique, straight, mirrored, {0, 0, 1});
    for (int c = 0; c < 3; c++)
      EXPECT_NEAR(in_mirror[c] / direct[c], 1, 0.02) << technique << " " << c;
    EXPECT_GT(direct.x, 1.2f * direct.z) << "the volume's colour";
    // Mirrors show volumes although pictures lay those over that the eye sees.
    EXPECT_EQ(seen_color(technique, world, eye, image, false), in_mirror);
  }
}

TEST(VolumesInLight, TheEyeSeesAVolumeIfItIsToldSo) {
  Scene scene = empty_scene();
  add_wall(scene, diffuse(vec3(0.5f)), -2);
  scene.lights = {{.position = {0, 0, 4}, .intensity = vec3(3)}};
  World world(scene), empty(scene);
  PlacedVolume volume = slab(3, {0, 0, 0}, 40, 0.8f);
  world.place_volumes({volume});
  const Lights lights = make_lights(world);
  TransportSettings settings;
  settings.sees_volumes = true;
  int seen = 0;
  for (uint32_t i = 0; i < 2000; i++) {
    Request request;
    request.ray = ray_towards({0, 0, 3}, {0.5f, 0.0001f * float(i), 0.5f});
    request.seed = i;
    const Sample sample = find_technique("path")->trace(world, lights, settings, request);
    if (sample.object != volume.object) continue;
    seen++;
    EXPECT_EQ(sample.albedo, vec3(0));
    EXPECT_GT(sample.rest.x, 0.05f);
    EXPECT_LT(sample.rest.x, 0.81f);
    EXPECT_EQ(sample.flags, sample_hit);
    EXPECT_NEAR(sample.distance, distance(sample.position, request.ray.origin), 1e-4f);
    EXPECT_GT(sample.position.z, -0.81f);
    EXPECT_LT(sample.position.z, 0.81f);
  }
  EXPECT_GT(seen, 1900);
  // Unless it is told so, the eye sees what is behind.
  const Request request{.ray = ray_towards({0, 0, 3}, {0.5f, 0, 0.5f})};
  EXPECT_NE(find_technique("path")->trace(world, lights, {}, request).object, volume.object);
  for (const char* technique : {"path", "gather", "direct", "instant_radiosity"}) {
    const vec3 with = seen_color(technique, world, {0, 0, 3}, {0, 0, 0});
    const vec3 reference = seen_color("path", world, {0, 0, 3}, {0, 0, 0});
    EXPECT_NEAR(with.x / reference.x, 1, 0.05) << technique;
  }
}

TEST(VolumesInLight, AVolumeIsSeenBehindGlass) {
  Scene scene = empty_scene();
  const Material clear = glass(1.5f, 0, 0);
  add_wall(scene, clear, 2, 9, "pane");
  World with_pane(scene);
  Scene nothing = empty_scene();
  World open(nothing);
  for (World* world : {&with_pane, &open}) world->place_volumes({slab(1.5, {0, 0, 0}, 40, 0.8f)});
  const vec3 behind = seen_color("path", with_pane, {0, 0, 6}, {0, 0, 0}),
             bare = seen_color("path", open, {0, 0, 6}, {0, 0, 0});
  const Ray straight{.origin = {0, 0, 6}, .direction = {0, 0, -1}};
  const Surface pane = eval_surface(with_pane, straight, with_pane.intersect(straight));
  const vec3 passes = pane_transmittance(pane, with_pane.material_of(0), straight.direction);
  for (int c = 0; c < 3; c++) EXPECT_NEAR(behind[c] / bare[c], passes[c], 0.01) << c;
}

// An x-ray is no matter in the room: it shades nothing, and light that is spread wide misses it.
TEST(VolumesInLight, AnXRayIsSeenInMirrorsAndLightsNothing) {
  Scene scene = empty_scene();
  add_floor(scene, 0.5f);
  add_wall(scene, metal(vec3(1), 0), -6, 9, "mirror");
  scene.environment.radiance = vec3(0.3f);
  World world(scene);
  const Mean before = floor_light("path", world);
  PlacedVolume volume = slab(0, {0, 2, 0}, 50);
  const Preset preset{"x-ray", VolumeMode::maximum, {{0.0, vec3(8, 2, 1), 1}}};
  volume.look.preset = std::make_shared<const DrawnPreset>(*volume.volume, preset, VolumeLight());
  world.place_volumes({volume});
  const Mean after = floor_light("path", world);
  EXPECT_EQ(after.mean(), before.mean());
  const Lights lights = make_lights(world);
  Request request{.ray = ray_towards({0, 2, -4}, {0, 2, -6})};
  const vec3 seen = find_technique("path")->trace(world, lights, {}, request).radiance();
  EXPECT_NEAR(seen.x, 8, 0.01f);
  EXPECT_NEAR(seen.y, 2, 0.01f);
}

TEST(VolumesInLight, LightOnItsWayFromASourceIsStopped) {
  Scene scene = make_plane_with_punctual(sun());
  World world(scene);
  world.place_volumes({slab(0.9, {0, 2, 0}, 50)});
  const Lights lights = make_lights(world);
  Rng random(21);
  Mean arrived;
  for (int i = 0; i < 40000; i++) {
    LightWalk walk;
    walk.ray.origin = {random.uniform() - 0.5f, 5, random.uniform() - 0.5f};
    walk.ray.direction = {0, -1, 0};
    walk.flux = vec3(1);
    Arrival arrival;
    arrived.add(arrive({world, *lights.tables}, walk, arrival));
  }
  expect_mean(arrived, std::exp(-0.9), "share that arrives");
}

// A sample is the same alone and among others.
TEST(VolumesInLight, SamplesAreReplayed) {
  Scene scene = make_cornell_box();
  add_sphere(scene, metal(vec3(0.9f), 0), 0.06f, "mirror", at({0.1f, 0.25f, -0.1f}));
  World world(scene);
  world.place_volumes(
      {slab(2, {0, 0.2f, -0.1f}, 6, 0.5f), slab(1, {0.05f, 0.22f, -0.1f}, 6, 0.2f)});
  const Lights lights = make_lights(world);
  const View view = cornell_view(scene, 40, 32);
  TransportSettings settings;
  settings.sees_volumes = true;
  for (const char* name : {"path", "direct", "gather"}) {
    const Technique& technique = *find_technique(name);
    std::vector<Request> requests;
    for (int i = 0; i < view.width * view.height; i++)
      requests.push_back(pixel_request(view, 1, i % view.width, i / view.width, 0));
    std::vector<Sample> samples(requests.size());
    trace(technique, world, lights, settings, requests, samples);
    int seen = 0;
    for (size_t i = 0; i < requests.size(); i++) {
      const Sample alone = technique.trace(world, lights, settings, requests[i]);
      EXPECT_EQ(alone.radiance(), samples[i].radiance()) << name << " " << i;
      EXPECT_EQ(alone.distance, samples[i].distance);
      EXPECT_EQ(alone.flags, samples[i].flags);
      seen += alone.object == 3 && alone.albedo == vec3(0);
    }
    EXPECT_GT(seen, 50) << name;
  }
}

// Samples side by side have the light of those that are traced in the way that knows all materials.
TEST(VolumesInLight, BothWaysThroughAWalkAgree) {
  Scene scene = make_cornell_box();
  World world(scene);
  const Lights lights = make_lights(world);
  const View view = cornell_view(scene, 64, 64);
  std::vector<Request> requests;
  for (int k = 0; k < 24; k++)
    for (int i = 0; i < view.width * view.height; i++)
      requests.push_back(pixel_request(view, 1, i % view.width, i / view.width, k));
  // Bright matter in the middle of the box, whose light walks alone find.
  const PlacedVolume lit = slab(3, {0, 0.3f, -0.28f}, 12, 30);
  PlacedVolume glowing = lit;
  glowing.look.preset = std::make_shared<const DrawnPreset>(
      *lit.volume, Preset{"glow", VolumeMode::glow, {{0.0, vec3(1), 0.3}}}, VolumeLight());
  Mean open;
  for (const bool sees : {false, true}) {
    for (const PlacedVolume* placed :
         std::initializer_list<const PlacedVolume*>{nullptr, &lit, &glowing}) {
      world.place_volumes({});
      if (placed) world.place_volumes({*placed});
      Transport transport{world, *lights.tables};
      transport.sees_volumes = sees;
      WalkRules rules;
      rules.max_depth = 4;
      std::vector<Sample> samples(requests.size());
      trace_samples(transport, rules, requests, samples);
      Mean together, alone;
      for (size_t i = 0; i < requests.size(); i++) {
        together.add(double(luminance(samples[i].radiance())));
        alone.add(double(luminance(trace_sample(transport, rules, requests[i]).radiance())));
      }
      expect_same_mean(together, alone, sees ? "seen" : "not seen");
      if (!placed) open = together;
      else EXPECT_GT(together.mean(), 1.3 * open.mean());
    }
  }
}

}  // namespace
}  // namespace wellspring::test
