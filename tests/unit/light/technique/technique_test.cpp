// SPDX-License-Identifier: Apache-2.0
#include "light/technique/technique.h"

#include <cstring>
#include <oneapi/tbb/global_control.h>

#include "scenes/lit_world.h"
#include "unit/light/statistics.h"
#include "world/surface.h"

namespace wellspring::test {
namespace {

using namespace scenes;

// A hall in small: floor with a gloss, a mirror ball, a glass ball, a pane, a lamp and a spot.
Scene make_mixed_scene() {
  Scene scene = make_cornell_box();
  scene.meshes[0].material = add_material(scene, plastic({0.6f, 0.5f, 0.4f}, 0.1f));
  add_sphere(scene, metal({0.9f, 0.8f, 0.6f}, 0), 0.06f, "mirror ball", at({0.09f, 0.23f, -0.17f}));
  add_sphere(scene, glass(1.5f, 0, 1), 0.06f, "glass ball", at({0.15f, 0.06f, -0.02f}));
  add_quad(scene, glass(1.5f, 0, 0), {-0.28f, 0, -0.1f}, {0.2f, 0, 0}, {0, 0.4f, 0}, "pane");
  PunctualLight spot;
  spot.type = PunctualType::spot;
  spot.position = {0.2f, 0.5f, -0.1f};
  spot.direction = normalize(vec3(-1, -2, -0.5f));
  spot.intensity = vec3(0.4f);
  scene.lights.push_back(spot);
  return scene;
}

Sample trace_one(const char* technique, const World& world, const Lights& lights, Ray ray,
                 uint64_t seed = 1, TransportSettings settings = {}) {
  Request request{.ray = ray, .seed = seed};
  return find_technique(technique)->trace(world, lights, settings, request);
}

bool same_bits(const std::vector<vec3>& a, const std::vector<vec3>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(vec3)) == 0;
}

TEST(Technique, ListIsExplicit) {
  ASSERT_GE(techniques().size(), 2u);
  for (const Technique& t : techniques()) {
    EXPECT_EQ(find_technique(t.name), &t);
    EXPECT_GT(std::strlen(t.summary), 10u);
  }
  EXPECT_EQ(find_technique("pat"), nullptr);
  EXPECT_EQ(find_technique(""), nullptr);
}

TEST(Technique, SameBitsWhateverTheThreadCount) {
  auto [scene, world, lights] = LitWorld(make_mixed_scene());
  View view = cornell_view(scene, 33, 25);
  StillSettings settings{.spp = 3};
  for (const Technique& technique : techniques()) {
    Frame four = render_still(technique, world, lights, view, settings);
    oneapi::tbb::global_control one_thread(oneapi::tbb::global_control::max_allowed_parallelism, 1);
    Frame one = render_still(technique, world, lights, view, settings);
    EXPECT_TRUE(same_bits(one.color, four.color)) << technique.name;
    EXPECT_EQ(one.object, four.object);
    settings.seed++;
    EXPECT_FALSE(
        same_bits(one.color, render_still(technique, world, lights, view, settings).color));
  }
}

TEST(Technique, AnySampleCanBeReplayedBitForBit) {
  auto [scene, world, lights] = LitWorld(make_mixed_scene());
  View view = cornell_view(scene, 16, 12);
  StillSettings settings{.spp = 5, .seed = 77};
  for (const Technique& technique : techniques()) {
    if (technique.finish_pass) continue;  // pixels are not their own samples' mean
    Frame frame = render_still(technique, world, lights, view, settings);
    for (int y = 0; y < 12; y++)
      for (int x = 0; x < 16; x++) {
        dvec3 sum(0);
        for (int i = 0; i < 5; i++)
          sum += dvec3(replay_sample(technique, world, lights, view, settings, x, y, i).radiance());
        ASSERT_EQ(vec3(sum / 5.0), frame.color[size_t(y * 16 + x)])
            << technique.name << " " << x << "," << y;
      }
  }
}

TEST(Technique, ManyRequestsAtOnceAreTheSameAsOneByOne) {
  auto [scene, world, lights] = LitWorld(make_mixed_scene());
  View view = cornell_view(scene, 40, 40);
  std::vector<Request> requests;
  for (int i = 0; i < 1000; i++) requests.push_back(pixel_request(view, 3, i % 40, i / 40, 0));
  std::vector<Sample> samples(requests.size());
  const Technique& path = *find_technique("path");
  trace(path, world, lights, {}, requests, samples);
  for (size_t i = 0; i < requests.size(); i++) {
    Sample alone = path.trace(world, lights, {}, requests[i]);
    ASSERT_EQ(alone.radiance(), samples[i].radiance());
    ASSERT_EQ(alone.position, samples[i].position);
    ASSERT_EQ(alone.flags, samples[i].flags);
  }
  EXPECT_THROW(trace(path, world, lights, {}, requests, std::span(samples).first(3)),
               std::invalid_argument);
}

TEST(Technique, DiffuseSurfacesAreSplitIntoAlbedoAndSmoothLight) {
  Scene scene = make_plane_with_rect_light(10);
  scene.materials[1].base_color = {0.8f, 0.4f, 0.2f, 1};
  PunctualLight point{.position = {0, 3, 0}, .intensity = vec3(9)};
  World only_lamp(scene);
  Lights lamp = make_lights(only_lamp);
  Ray ray = ray_towards({0.1f, 0.5f, 0.8f}, {0, 0, 0});
  Mean smooth;
  for (uint64_t i = 0; i < 20000; i++) {
    Sample s = trace_one("path", only_lamp, lamp, ray, i);
    ASSERT_EQ(s.albedo, vec3(0.8f, 0.4f, 0.2f));
    ASSERT_EQ(s.rest, vec3(0));
    smooth.add(double(s.smooth.x));
  }
  expect_mean(smooth, rect_light_irradiance({0, 0, 0}, 10) / double(pi),
              "smooth light of the lamp");
  Scene with_point = make_plane_with_punctual(point);
  with_point.materials[1].base_color = {0.8f, 0.4f, 0.2f, 1};
  World world(with_point);
  Lights lights = make_lights(world);
  Sample s = trace_one("path", world, lights, ray);
  EXPECT_EQ(s.smooth, vec3(0));  // sharp shadows are not smooth
  EXPECT_NEAR(s.rest.x, 0.8f / pi, 1e-4f);
  EXPECT_NEAR(s.rest.z, 0.2f / pi, 1e-4f);
}

TEST(Technique, FirstSurfaceIsDescribed) {
  auto [scene, world, lights] = LitWorld(make_mixed_scene());
  Sample s =
      trace_one("path", world, lights, ray_towards({0, 0.275f, 0.8f}, {0.05f, 0.5f, -0.56f}));
  EXPECT_EQ(s.flags, sample_hit | sample_sure);
  EXPECT_EQ(scene.objects[s.object], "back wall");
  EXPECT_NEAR(s.position.z, -0.56f, 1e-5f);
  EXPECT_NEAR(s.normal.z, 1, 1e-5f);
  EXPECT_NEAR(s.distance, length(s.position - vec3(0, 0.275f, 0.8f)), 1e-4f);
  EXPECT_LT(length(eval_position(world, s.instance, s.triangle, s.barycentric) - s.position),
            1e-4f);
  // Mirror and solid glass: the first surface, everything in `rest`.
  for (auto [target, name] : {std::pair(vec3(0.09f, 0.23f, -0.17f), "mirror ball"),
                              std::pair(vec3(0.15f, 0.06f, -0.02f), "glass ball")}) {
    s = trace_one("path", world, lights, ray_towards({0.1f, 0.275f, 0.8f}, target));
    EXPECT_EQ(s.flags, sample_hit | sample_specular) << name;
    EXPECT_EQ(scene.objects[s.object], name);
    EXPECT_EQ(s.albedo, vec3(0));
    EXPECT_EQ(s.smooth, vec3(0));
    EXPECT_NEAR(length(s.position - target), 0.06f, 1e-3f);
  }
  // A thin pane bends nothing: what is behind it is described, tinted by the pane.
  s = trace_one("path", world, lights, ray_towards({-0.2f, 0.275f, 0.8f}, {-0.2f, 0.275f, 0}));
  EXPECT_EQ(scene.objects[s.object], "back wall");
  EXPECT_LT(s.albedo.x, 0.73f);
  EXPECT_GT(s.albedo.x, 0.65f);
  // Nothing there.
  s = trace_one("path", world, lights, ray_towards({0, 0.275f, 0.8f}, {0, 0.275f, 2}));
  EXPECT_EQ(s.flags, sample_sure);
  EXPECT_EQ(s.position, vec3(0, 0, 1));
  EXPECT_EQ(s.radiance(), vec3(0));
}

// A pane's look-through and its mirror image together are what a path tracer without that care
// would find.
TEST(Technique, APaneShowsWhatIsBehindAndItsMirrorImage) {
  Scene scene = empty_scene();
  add_wall(scene, glass(1.5f, 0, 0), 0, 5, "quad");
  add_wall(scene, emitter(vec3(3)), -4, 9, "behind");
  add_quad(scene, emitter(vec3(50)), {-9, 9, 4}, {18, 0, 0}, {0, -18, 0}, "in front");
  World world(scene);
  Lights lights = make_lights(world);
  Ray ray = ray_towards({0, 0, 2}, {0, 0, 0});
  for (const char* technique : {"path", "direct"})
    for (uint64_t seed = 0; seed < 20; seed++)
      EXPECT_NEAR(trace_one(technique, world, lights, ray, seed).radiance().x,
                  0.96f * 3 + 0.04f * 50, 1e-3f);
}

// If a sample is sure, every other sample of the same ray is the same, shadow or not; if one of two
// lamps is drawn, or a gloss, it is not sure.
TEST(Technique, SureSamplesRepeatThemselves) {
  Scene one_lamp = make_mixed_scene();
  Scene two_lamps = one_lamp;
  two_lamps.lights.push_back(one_lamp.lights[0]);
  two_lamps.lights[1].position.x = -0.2f;
  two_lamps.lights[1].direction.x *= -1;
  std::vector<PixelSample> places;
  for (int y = 0; y < 24; y++)
    for (int x = 0; x < 32; x++) places.push_back({x, y, 0});
  for (const Scene* scene : {&one_lamp, &two_lamps}) {
    World world(*scene);
    Lights lights = make_lights(world);
    View view = make_view(*scene, {0, 0.275, 0.8}, 0, 0, 0.7f, 32, 24);
    int sure = 0, varied = 0;
    for (const PixelSample& place : places) {
      Ray ray = view_ray(view, float(place.x) + 0.5f, float(place.y) + 0.5f);
      Sample first = trace_one("gather", world, lights, ray);
      bool same = true;
      for (uint64_t seed = 2; seed < 10; seed++) {
        Sample other = trace_one("gather", world, lights, ray, seed);
        same &= length(other.rest - first.rest) <= 0.01f * length(first.rest);
      }
      bool told = first.flags & sample_sure;
      EXPECT_TRUE(same || !told) << place.x << " " << place.y;
      EXPECT_FALSE(told && (first.flags & sample_specular));
      sure += told;
      varied += !same;
    }
    EXPECT_GT(varied, 40);  // the balls, the floor's gloss, the pane, and shadows of one of two
    EXPECT_GT(sure, scene == &one_lamp ? 300 : 60);
  }
}

TEST(Technique, MovingMeshesCarryTheirPlace) {
  Scene scene = make_cornell_box();
  scene.objects.push_back("storyteller");
  Mesh moving = sphere_mesh(1, 0.05f);
  for (vec3& p : moving.positions) p += vec3(0, 0.4f, -0.1f);
  World world(scene, {moving}, {uint32_t(scene.objects.size() - 1)});
  Lights lights = make_lights(world);
  Sample s = trace_one("path", world, lights, ray_towards({0, 0.4f, 0.8f}, {0, 0.4f, -0.1f}));
  EXPECT_EQ(s.flags, sample_hit | sample_moving | sample_sure);
  EXPECT_EQ(scene.objects[s.object], "storyteller");
  EXPECT_EQ(s.instance, uint32_t(scene.instances.size()));
  EXPECT_LT(length(eval_position(world, s.instance, s.triangle, s.barycentric) - s.position),
            1e-4f);
}

TEST(Technique, DirectKnowsNoLightBetweenRoughSurfaces) {
  auto [scene, world, lights] = LitWorld(make_cornell_box());
  Ray ceiling =
      ray_towards({0, 0.275f, 0.8f}, {0.2f, 0.55f, -0.3f});  // the lamp faces away from it
  EXPECT_EQ(trace_mean("direct", world, lights, ceiling, 500).mean(), 0);
  EXPECT_GT(trace_mean("path", world, lights, ceiling, 500).mean(), 0.05);
}

TEST(Technique, MaxDepthCountsEdges) {
  auto [scene, world, lights] = LitWorld(make_cornell_box());
  TransportSettings settings;
  Ray floor = ray_towards({0, 0.275f, 0.8f}, {0, 0, -0.1f}),
      lamp = ray_towards({0, 0.275f, 0.8f}, {0, 0.549f, -0.27f});
  settings.max_depth = 0;
  EXPECT_EQ(trace_mean("path", world, lights, lamp, 10, settings).mean(), 0);
  settings.max_depth = 1;
  EXPECT_EQ(trace_mean("path", world, lights, floor, 100, settings).mean(), 0);
  EXPECT_NEAR(trace_mean("path", world, lights, lamp, 10, settings).mean(),
              double(luminance({17, 12, 4})), 1e-3);
  settings.max_depth = 2;
  Mean two = trace_mean("path", world, lights, floor, 20000, settings);
  expect_same_mean(two, trace_mean("direct", world, lights, floor, 20000, {}, 5),
                   "two edges are direct light");
  settings.max_depth = 3;
  EXPECT_GT(trace_mean("path", world, lights, floor, 5000, settings).mean(), two.mean() * 1.05);
}

TEST(Technique, ClampBoundsASampleAndKeepsItsHue) {
  Scene scene = make_cornell_box();
  for (bool polished : {false, true}) {    // light by chance in `smooth`, and in `rest`
    Material& white = scene.materials[1];  // the floor's
    white.metallic = polished ? 1.0f : 0.0f;
    white.roughness = polished ? 0.3f : 1.0f;
    World world(scene);
    Lights lights = make_lights(world);
    Ray ray = ray_towards({0, 0.275f, 0.8f}, {-0.15f, 0, -0.1f});
    for (const char* technique : {"path", "gather"}) {
      TransportSettings bound{.clamp = 0.01f};
      int bounded_samples = 0;
      for (uint64_t seed = 1; seed <= 32; seed++) {
        vec3 whole = trace_one(technique, world, lights, ray, seed, {}).radiance();
        vec3 bounded = trace_one(technique, world, lights, ray, seed, bound).radiance();
        EXPECT_NEAR(max_component(bounded), std::min(max_component(whole), 0.01f), 1e-6f);
        EXPECT_NEAR(bounded.y * whole.x, whole.y * bounded.x, 1e-4f * whole.y * bounded.x);
        bounded_samples += max_component(whole) > 0.01f;
      }
      EXPECT_GT(bounded_samples, 16);
      // A lamp that is looked at is no matter of chance.
      vec3 lamp = trace_one(technique, world, lights,
                            ray_towards({0, 0.275f, 0.8f}, {0, 0.549f, -0.27f}), 1, bound)
                      .radiance();
      EXPECT_NEAR(lamp.x, 17, 1e-4f);
      EXPECT_NEAR(lamp.z, 4, 1e-4f);
    }
  }
}

TEST(Technique, BadSamplesAreBlackAndCounted) {
  Scene scene = empty_scene();
  Material m = emitter({std::numeric_limits<float>::infinity(), 1, 1});
  add_wall(scene, m, 0, 1, "quad");
  scene.environment.radiance = {1, -1, 1};
  World world(scene);
  Lights lights = make_lights(world);
  Frame frame =
      render_still(*find_technique("path"), world, lights,
                   make_view_towards(scene, {0, 0, 2}, {0, 0, 0}, {0, 1, 0}, 1.5f, 20, 20), {});
  for (vec3 c : frame.color) ASSERT_EQ(c, vec3(0));
  EXPECT_EQ(lights.bad_samples->load(), 20u * 20 * 16);
}

TEST(Technique, PicturePlanesAndSizes) {
  auto [scene, world, lights] = LitWorld(make_cornell_box());
  StillSettings settings{.spp = 1};
  Frame frame =
      render_still(*find_technique("direct"), world, lights, cornell_view(scene, 1, 1), settings);
  EXPECT_EQ(frame.color.size(), 1u);
  frame =
      render_still(*find_technique("direct"), world, lights, cornell_view(scene, 64, 64), settings);
  size_t centre = 32 * 64 + 60;
  EXPECT_EQ(scene.objects[frame.object[0]], "");
  EXPECT_TRUE(std::isinf(frame.depth[0]));
  EXPECT_GT(frame.object[centre], 0u);
  EXPECT_NEAR(frame.depth[32 * 64 + 32], 0.8f + 0.38f, 0.2f);
  settings.spp = 0;
  EXPECT_THROW(
      render_still(*find_technique("direct"), world, lights, cornell_view(scene, 4, 4), settings),
      std::invalid_argument);
}

}  // namespace
}  // namespace wellspring::test
