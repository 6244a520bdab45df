// SPDX-License-Identifier: Apache-2.0
// Samples of surfaces whose diffuse light an illumination map knows.
#include "light/walk/known_light.h"

#include <gtest/gtest.h>

#include <cmath>

#include "light/technique/technique.h"
#include "unit/light/kept/bake_cases.h"

namespace wellspring::test {
namespace {

using namespace scenes;

constexpr int width = 40, height = 32;

vec3 painted(vec3 place) { return {0.4f + place.x, 0.2f + 0.5f * place.y, 0.1f - 0.15f * place.z}; }
vec3 nearly_dark(vec3 place) { return place.x > 0.1f ? vec3(1) : vec3(1e-6f); }

// The Cornell box with a coated ball, a mirror, a pane before it all, and a bulb.
struct LitRoom {
  Scene scene;
  World world;
  Lights lights;
  std::vector<Request> requests;
  explicit LitRoom(bool pane = false, std::vector<Mesh> moving = {})
      : scene(make_scene(pane)), world(scene, std::move(moving)), lights(make_lights(world)) {
    world.commit();
    View view = cornell_view(scene, width, height);
    for (int i = 0; i < width * height; i++)
      requests.push_back(pixel_request(view, 3, i % width, i / width, i % 3));
  }
  static Scene make_scene(bool pane) {
    Scene scene = make_cornell_box();
    add_sphere(scene, plastic({0.3f, 0.5f, 0.7f}, 0.4f), 0.09f, "coated",
               at({0.12f, 0.35f, -0.1f}));
    add_sphere(scene, metal(vec3(0.9f), 0.02f), 0.07f, "mirror", at({-0.15f, 0.07f, -0.08f}));
    if (pane)
      add_quad(scene, glass(1.5f, 0, 0), {-0.3f, 0, 0.1f}, {0.6f, 0, 0}, {0, 0.3f, 0}, "pane");
    scene.lights.push_back(test::point_light({0.05f, 0.45f, -0.1f}, {0.3f, 0.25f, 0.2f}));
    return scene;
  }
  std::vector<Sample> trace(const char* technique, bool maps,
                            const test::PaintedLight& light = painted) {
    lights.maps = maps ? test::paint_map(world, 0.03f, {light}) : nullptr;
    std::vector<Sample> samples(requests.size());
    wellspring::light::trace(*find_technique(technique), world, lights, {}, requests, samples);
    return samples;
  }
  // Returns the map's light where a sample lies.
  vec3 known(const Sample& sample, const Request& request) const {
    const IlluminationCharts& places = *lights.maps->places;
    vec3 face = eval_face(world, sample.instance, sample.triangle);
    uint32_t chart =
        places.find(sample.instance, sample.triangle, dot(face, request.ray.direction) < 0);
    if (chart == no_chart) return vec3(-1);
    return eval_illumination(*lights.maps, places.charts[chart], sample.position);
  }
  const Material& material(const Sample& sample) const {
    return world.material_of(sample.instance);
  }
};

void expect_near(vec3 a, vec3 b, float share, float floor, const char* what, size_t i) {
  for (int c = 0; c < 3; c++)
    ASSERT_NEAR(a[c], b[c], share * std::max(a[c], b[c]) + floor) << what << ", sample " << i;
}

// Whatever the map says, and be it wrong: traced samples tell the light they find.
TEST(KnownLight, TracedSamplesAreAsBrightAsWithoutMaps) {
  for (bool pane : {false, true})
    for (const test::PaintedLight& light : {test::PaintedLight(painted), {nearly_dark}}) {
      LitRoom room(pane);
      std::vector<Sample> without = room.trace("path", false),
                          with = room.trace("path", true, light);
      int mapped = 0;
      for (size_t i = 0; i < with.size(); i++) {
        // The tolerance is for light that is added and taken away again in floats.
        expect_near(with[i].radiance(), without[i].radiance(), 2e-5f, 1e-6f, "radiance", i);
        EXPECT_EQ(with[i].albedo, without[i].albedo);
        EXPECT_EQ(without[i].flags & sample_mapped, 0);
        mapped += bool(with[i].flags & sample_mapped);
      }
      EXPECT_GT(mapped, width * height / 3);
      EXPECT_EQ(room.lights.bad_samples->load(), 0u);
    }
}

TEST(KnownLight, GatheredSamplesOfLambertianSurfacesAreWhatTheMapSays) {
  LitRoom room;
  std::vector<Sample> samples = room.trace("gather", true);
  int lambertian = 0;
  for (size_t i = 0; i < samples.size(); i++) {
    const Sample& s = samples[i];
    if (!(s.flags & sample_hit) || !is_lambertian(room.material(s))) continue;
    vec3 known = room.known(s, room.requests[i]);
    ASSERT_GE(known.x, 0);
    expect_near(s.radiance(), s.albedo * known, 1e-5f, 1e-6f, "radiance", i);
    EXPECT_TRUE(s.flags & sample_mapped);
    EXPECT_TRUE(s.flags & sample_sure);
    EXPECT_EQ(s.smooth, vec3(1));
    EXPECT_EQ(s.rest, vec3(0));
    lambertian++;
  }
  EXPECT_GT(lambertian, width * height / 3);
}

TEST(KnownLight, GatheredSamplesOfCoatedSurfacesHaveTheMapsLightBeneathTheCoat) {
  LitRoom room;
  std::vector<Sample> samples = room.trace("gather", true);
  int coated = 0, plain = 0;
  for (size_t i = 0; i < samples.size(); i++) {
    const Sample& s = samples[i];
    if (!(s.flags & sample_hit) || room.scene.objects[s.object] != "coated") continue;
    vec3 known = room.known(s, room.requests[i]), told = s.smooth * s.known - vec3(s.raised);
    EXPECT_TRUE(s.flags & sample_mapped);
    EXPECT_FALSE(s.flags & sample_sure) << "its gloss is chance";
    // A sample has the map's light that the coat leaves, and gloss that reflects what a random
    // direction meets.
    bool glossy = false;
    for (int c = 0; c < 3; c++) {
      EXPECT_GE(told[c], 0.2f * known[c] - 1e-4f);
      glossy = glossy || told[c] > 1.05f * known[c] + 1e-4f;
    }
    coated++, plain += !glossy;
  }
  EXPECT_GT(coated, 20);
  EXPECT_GT(plain, coated / 3);
}

// A baked map beneath a coat, read again, is as bright as traced light, from above and at a slant.
TEST(KnownLight, BakedCoatedSurfacesAreAsBrightAsTracedOnes) {
  Scene scene = empty_scene();
  Material coated = plastic(vec3(0.6f), 0.4f);
  coated.clearcoat = 1, coated.clearcoat_roughness = 0.1f;
  test::add_fan(scene, add_material(scene, coated), {-1, 0, 1}, {2, 0, 0}, {0, 0, -2});
  scene.lights.push_back(test::point_light({0.2f, 1, 0.1f}, vec3(3)));
  scene.environment.radiance = vec3(0.5f);
  test::Baked baked(scene, {.gather_nodes = 300, .direct_nodes = 600});
  Lights lights = make_lights(baked.world), mapped = lights;
  mapped.maps = baked.map(64);
  for (vec3 eye : {vec3(0, 2, 0.01f), vec3(0, 1, 2), vec3(0, 0.3f, 2)}) {
    View view = make_view_towards(scene, dvec3(eye), {0, 0, 0}, {0, 1, 0}, 0.3f, 24, 24);
    vec3 traced(0), read(0);
    for (int i = 0; i < 24 * 24 * 64; i++) {
      Request request = pixel_request(view, 5, i % 24, i / 24 % 24, i / 576);
      const Technique &path = *find_technique("path"), &gather = *find_technique("gather");
      traced += path.trace(baked.world, lights, {}, request).radiance();
      read += gather.trace(baked.world, mapped, {}, request).radiance();
    }
    EXPECT_NEAR(read.y / traced.y, 1, 0.03) << eye.y;
  }
}

TEST(KnownLight, SurfacesWithoutAChartAreAsBefore) {
  LitRoom room;
  for (const char* technique : {"path", "gather"}) {
    std::vector<Sample> without = room.trace(technique, false), with = room.trace(technique, true);
    int mirrors = 0;
    for (size_t i = 0; i < with.size(); i++) {
      const Sample &a = with[i], &b = without[i];
      if (a.flags & sample_hit && room.scene.objects[a.object] != "mirror") continue;
      mirrors += bool(a.flags & sample_hit);
      EXPECT_EQ(a.flags, b.flags);
      EXPECT_EQ(a.known, vec3(1));
      EXPECT_EQ(a.smooth, b.smooth);
      EXPECT_EQ(a.rest, b.rest);
    }
    EXPECT_GT(mirrors, 10);
  }
}

TEST(KnownLight, PanesBeforeASurfaceTintAndMirrorOnly) {
  LitRoom room(true);
  std::vector<Sample> samples = room.trace("gather", true);
  int behind = 0;
  for (size_t i = 0; i < samples.size(); i++) {
    const Sample& s = samples[i];
    if (!(s.flags & sample_hit) || !is_lambertian(room.material(s))) continue;
    const Ray& ray = room.requests[i].ray;
    float to_pane = (0.1f - ray.origin.z) / ray.direction.z;
    vec3 crossed = ray.origin + to_pane * ray.direction;
    if (crossed.y > 0.29f || crossed.y < 0.01f || std::abs(crossed.x) > 0.29f) continue;
    vec3 known = room.known(s, room.requests[i]);
    EXPECT_TRUE(s.flags & sample_mapped);
    expect_near(s.smooth * s.known - vec3(s.raised), known, 1e-4f, 1e-5f, "light", i);
    EXPECT_LT(max_component(s.albedo), 0.97f * max_component(vec3(room.material(s).base_color)));
    behind++;
  }
  EXPECT_GT(behind, 100);
}

// The ball hangs beside the right wall: the bulb's light passes it on its way there.
TEST(KnownLight, NearWhatMovesLightIsTraced) {
  Mesh ball = sphere_mesh(1, 0.05f, 16);
  for (vec3& p : ball.positions) p += vec3(0.15f, 0.2f, -0.3f);
  LitRoom room(false, {ball});
  std::vector<Sample> samples = room.trace("gather", true);
  const Transport transport{room.world, *room.lights.tables, nullptr, nullptr,
                            room.lights.maps.get()};
  int traced = 0, read = 0;
  for (size_t i = 0; i < samples.size(); i++) {
    const Sample& s = samples[i];
    if (!(s.flags & sample_hit)) continue;
    if (s.flags & sample_moving) {
      EXPECT_FALSE(s.flags & sample_mapped);
      continue;
    }
    if (!is_lambertian(room.material(s))) continue;
    bool shaded = may_be_shaded(transport, s.position);
    bool near = length(s.position - vec3(0.15f, 0.2f, -0.3f)) < 0.1f;
    EXPECT_TRUE(shaded || !near);
    EXPECT_TRUE(s.flags & sample_mapped);
    EXPECT_EQ(s.smooth == vec3(1), !shaded) << i;
    (shaded ? traced : read)++;
  }
  EXPECT_GT(traced, 30);
  EXPECT_GT(read, 100);
  // Nothing near, nothing behind.
  EXPECT_FALSE(may_be_shaded(transport, {-0.28f, 0.3f, -0.05f}));
  room.world.show(0, false);
  room.world.commit();
  EXPECT_FALSE(may_be_shaded(transport, {0.15f, 0.2f, -0.3f}));
}

// A scene without light has a map without light.
TEST(KnownLight, WhereAllIsDarkNothingIsBad) {
  Scene scene = make_cornell_box();
  for (Material& m : scene.materials) m.emission = vec3(0);
  World world(scene);
  Lights lights = make_lights(world);
  lights.maps = test::paint_map(world, 0.05f, {[](vec3) { return vec3(0); }});
  std::vector<Request> requests;
  for (int i = 0; i < 256; i++)
    requests.push_back(pixel_request(cornell_view(scene, 16, 16), 1, i % 16, i / 16, 0));
  std::vector<Sample> samples(requests.size());
  for (const char* technique : {"path", "gather"}) {
    trace(*find_technique(technique), world, lights, {}, requests, samples);
    for (const Sample& sample : samples) {
      EXPECT_EQ(sample.radiance(), vec3(0));
      EXPECT_TRUE(is_finite(sample.smooth));
    }
  }
  EXPECT_EQ(lights.bad_samples->load(), 0u);
}

}  // namespace
}  // namespace wellspring::test
