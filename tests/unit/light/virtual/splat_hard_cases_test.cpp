// SPDX-License-Identifier: Apache-2.0
// What splatting must not be brought down by.
#include "base/rng.h"
#include "unit/light/virtual/splat_stage.h"

using namespace wellspring;

using namespace wellspring::test;
using namespace wellspring::scenes;
using namespace wellspring::test;

namespace {

PunctualLight hard_bulb(vec3 position, float intensity = 5) {
  PunctualLight light;
  light.position = position;
  light.intensity = vec3(intensity);
  return light;
}

// A white room, `size` metres a side about `middle`, lit by `lights`, seen from near one wall.
SplatStage make_hard_room(std::vector<PunctualLight> lights, float size = 2, vec3 middle = vec3(0),
                          int pixels = 64) {
  Scene scene = empty_scene();
  add_mesh(scene, box_mesh(add_material(scene, diffuse(vec3(0.5f))), vec3(size), true), "room",
           at(middle));
  for (PunctualLight& light : lights) light.position = light.position * (size / 2) + middle;
  scene.lights = std::move(lights);
  dvec3 eye = dvec3(middle) + dvec3(0.1, 0.05, 0.45) * double(size);
  View view = make_view_towards(scene, eye, dvec3(middle), {0, 1, 0}, 1.4f, pixels, pixels);
  return {std::move(scene), view};
}

void run(SplatStage& stage, const SplatSettings& settings = {}) {
  stage.draw(settings);
  stage.splat(settings);
}

struct Range {
  double low = 1e300, high = 0, mean = 0;
  bool fine = true;  // finite and not negative
};
Range range_of(const SplatStage& stage) {
  Range range;
  for (vec3 e : stage.picture.irradiance) {
    range.fine &= is_finite(e) && e.x >= 0 && e.y >= 0 && e.z >= 0;
    range.low = std::min(range.low, double(e.x)), range.high = std::max(range.high, double(e.x));
    range.mean += double(e.x) / double(stage.picture.irradiance.size());
  }
  return range;
}

}  // namespace

// In a corner, almost on two walls: what is near is lit by the light itself, its bounce is bounded
// by the discs that virtual lights are.
TEST(SplatHardCases, ALightThatTouchesSurfacesDoesNotSpark) {
  for (float gap : {1e-2f, 1e-4f, 1e-6f, 0.0f}) {
    SplatStage stage = make_hard_room({hard_bulb({-1 + gap, 0, -1 + gap})});
    run(stage);
    Range range = range_of(stage);
    EXPECT_TRUE(range.fine) << gap;
    double flux = 5 * 4 * double(pi) * 0.5, least = 0.02 * double(stage.drawn.map.mean_distance);
    EXPECT_LE(range.high, flux / (double(pi) * least * least)) << gap;
    EXPECT_LE(range.high, 100 * range.mean) << gap;
    if (gap == 0) continue;
    EXPECT_GT(range.mean, 0) << gap;
    SplatSettings unbounded;
    unbounded.bound = 0;
    run(stage, unbounded);
    EXPECT_GT(range_of(stage).high, (gap < 1e-3f ? 5 : 1) * range.high) << gap;
  }
}

// A floor seen along itself has a great range of depth and no discontinuity.
TEST(SplatHardCases, GrazingPlanesAreNotRefined) {
  Scene scene = empty_scene();
  int white = add_material(scene, diffuse(vec3(0.5f)));
  add_quad(scene, white, {-50, 0, 50}, {100, 0, 0}, {0, 0, -100}, "floor");
  add_quad(scene, white, {-50, 3, -50}, {100, 0, 0}, {0, 0, 100}, "ceiling");
  scene.lights.push_back(hard_bulb({0, 1.5f, -4}));
  View view = make_view_towards(scene, {0, 0.2, 0}, {0, 0.2, -10}, {0, 1, 0}, 1.0f, 256, 256);
  SplatStage stage(std::move(scene), view);
  run(stage);
  // Left over: the border of both against the void behind them.
  EXPECT_LT(stage.picture.counters.subsplats[0], 256u * 256 / 40);
  const MinMaxCell& below = stage.picture.pyramid.at(4, 8, 9);
  EXPECT_GT(-below.low_high[4] - below.low_high[0], 0.3f * below.low_high[0]);
  EXPECT_LT(relative_error(stage), 0.2);
}

TEST(SplatHardCases, FoliageCostsHardlyMoreThanPixelByPixel) {
  Scene scene = empty_scene();
  Mesh leaves;
  leaves.material = add_material(scene, diffuse({0.2f, 0.5f, 0.1f}));
  Rng rng(3);
  auto u = [&] { return rng.uniform() - 0.5f; };
  for (uint32_t i = 0; i < 6000; i++) {
    vec3 middle(4 * u(), 4 * u(), 2 * u());
    for (int k = 0; k < 3; k++) {
      leaves.positions.push_back(middle + 0.12f * vec3(u(), u(), u()));
      leaves.normals.push_back({0, 0, 1});
    }
    leaves.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  for (const uvec3& t : leaves.triangles) {
    vec3 face = cross(leaves.positions[t.y] - leaves.positions[t.x],
                      leaves.positions[t.z] - leaves.positions[t.x]);
    for (int k = 0; k < 3; k++) leaves.normals[t[k]] = normalize(face);
  }
  add_mesh(scene, leaves, "leaves");
  scene.lights.push_back(hard_bulb({0, 0, 0}));
  View view = make_view_towards(scene, {0, 0, 3}, {0, 0, 0}, {0, 1, 0}, 0.8f, 128, 128);
  SplatStage stage(std::move(scene), view);
  uint64_t lit = 0;
  for (int i = 0; i < 128 * 128; i++) lit += stage.lit(i % 128, i / 128);
  for (float convergence : {0.0f, 0.01f}) {
    SplatSettings settings;
    settings.convergence = convergence;
    run(stage, settings);
    const SplatCounters& counters = stage.picture.counters;
    EXPECT_GT(double(counters.subsplats[0]), 0.8 * double(counters.all_subsplats()));
    double naive = double(lit) * double(stage.drawn.lights.count);
    double passes = convergence > 0 ? 2 : 1;  // once more, with shadows
    EXPECT_LE(double(counters.evaluations), 1.3 * naive * passes);
    EXPECT_LE(double(counters.shadow_rays + counters.probe_rays),
              1.3 * double(lit) * double(settings.shadow_rays / 4));
  }
}

TEST(SplatHardCases, ALightBehindTheCameraLights) {
  SplatStage stage = make_hard_room({hard_bulb({0.1f, 0.05f, 0.98f})});
  run(stage);
  EXPECT_LT(dot(stage.scene.lights[0].position - stage.view.position, stage.view.forward), 0);
  EXPECT_TRUE(range_of(stage).fine);
  EXPECT_GT(range_of(stage).low, 0.1);
}

TEST(SplatHardCases, BlackAndMissingLightsCostNothing) {
  for (bool black : {true, false}) {
    SplatStage stage = make_hard_room({});
    std::vector<SplatSource> sources;
    if (black) sources.push_back(make_splat_source(hard_bulb({0, 0, 0}, 0), 1));
    draw_virtual_lights(stage.transport(), sources, {}, {}, {}, stage.drawn);
    stage.splat({});
    EXPECT_EQ(stage.drawn.lights.count, 0);
    EXPECT_EQ(stage.drawn.map.rays, 0u);
    EXPECT_EQ(stage.picture.counters.evaluations + stage.picture.counters.shadow_rays, 0u);
    EXPECT_EQ(range_of(stage).high, 0);
    EXPECT_TRUE(range_of(stage).fine);
  }
}

TEST(SplatHardCases, ThousandsOfLightsShareTheTexels) {
  std::vector<PunctualLight> lights;
  Rng rng(5);
  for (int i = 0; i < 5000; i++)
    lights.push_back(hard_bulb(
        {1.8f * rng.uniform() - 0.9f, 1.8f * rng.uniform() - 0.9f, 1.8f * rng.uniform() - 0.9f},
        0.001f * float(1 + i % 7)));
  double flux = 0;
  for (const PunctualLight& light : lights)
    flux += double(light.intensity.x) * 4 * double(pi) * 0.5;
  SplatStage stage = make_hard_room(lights);
  double mean = 0;
  for (uint32_t pass = 0; pass < 8; pass++) {
    stage.draw({}, {1, pass});
    EXPECT_LE(stage.drawn.map.rays, 4096u);
    EXPECT_LE(stage.drawn.lights.count, 300);
    for (size_t i = 0; i < size_t(stage.drawn.lights.count); i++)
      mean += double(stage.drawn.lights.intensity(i).x) * double(pi) / 8;
  }
  EXPECT_NEAR(mean / flux, 1, 0.03);
}

// Glass takes the same share of what a torch sends and of what a wall sends back.
TEST(SplatHardCases, ATorchBehindGlassIsDimmedByIt) {
  double mean[2];
  for (int pane : {0, 1}) {
    Scene scene = empty_scene();
    add_mesh(scene, box_mesh(add_material(scene, diffuse(vec3(0.5f))), vec3(2), true), "room");
    Material clear = glass(1.5f, 0, 0);
    clear.base_color = vec4(0.25f, 0.5f, 1, 1);
    if (pane)
      add_mesh(scene, box_mesh(add_material(scene, clear), vec3(0.2f)), "vitrine",
               at({0, 0, -0.2f}));
    scene.lights.push_back(hard_bulb({0, 0, -0.2f}));
    View view = make_view_towards(scene, {0, 0.6, 0.9}, {0, 0.9, -0.5}, {0, 1, 0}, 0.7f, 48, 48);
    SplatStage stage(std::move(scene), view);
    run(stage);
    Range range = range_of(stage);
    EXPECT_TRUE(range.fine);
    mean[pane] = range.mean;
    vec3 middle = stage.picture.irradiance[24 * 48 + 24];
    if (pane) EXPECT_GT(middle.z, 2.5f * middle.x);
    else EXPECT_NEAR(middle.z, middle.x, 1e-3f * middle.x);
  }
  EXPECT_GT(mean[1], 0.1 * mean[0]);
  EXPECT_LT(mean[1], 0.35 * mean[0]);
}

TEST(SplatHardCases, FarFromTheOriginTheLightIsTheSame) {
  SplatSettings settings;
  SplatStage near = make_hard_room({hard_bulb({0.3f, 0.2f, 0.1f})});
  run(near, settings);
  for (float away : {3e3f, 2e4f}) {
    SplatStage far = make_hard_room({hard_bulb({0.3f, 0.2f, 0.1f})}, 2, vec3(away, -away, away));
    run(far, settings);
    EXPECT_TRUE(range_of(far).fine);
    EXPECT_NEAR(range_of(far).mean / range_of(near).mean, 1, 0.05) << away;
  }
}

TEST(SplatHardCases, NumbersOfAnySizeStayFinite) {
  for (float size : {1e-6f, 1e-3f, 1e5f, 1e9f})
    for (float intensity : {1e-42f, 1e-30f, 1e30f, 3e38f}) {
      SplatStage stage =
          make_hard_room({hard_bulb({0.3f, 0.2f, 0.1f}, intensity)}, size, vec3(0), 24);
      run(stage);
      for (vec3 e : stage.picture.irradiance) {
        ASSERT_FALSE(std::isnan(e.x)) << size << ", " << intensity;
        ASSERT_GE(e.x, 0);
      }
    }
}

TEST(SplatHardCases, TrianglesWithoutAreaDoNoHarm) {
  Scene scene = empty_scene();
  add_mesh(scene, box_mesh(add_material(scene, diffuse(vec3(0.5f))), vec3(2), true), "room");
  Mesh flat;
  flat.material = add_material(scene, emitter(vec3(4)));
  flat.positions = {{0, 0, 0}, {0.2f, 0, 0}, {0.4f, 0, 0}, {0, 0.5f, 0}, {0, 0.5f, 0}};
  flat.normals.assign(5, {0, 0, 1});
  flat.triangles = {{0, 1, 2}, {3, 4, 3}, {0, 1, 1}};
  add_mesh(scene, flat, "flat");
  add_quad(scene, flat.material, {-0.2f, 0.9f, -0.2f}, {0.4f, 0, 0}, {0, 0, 0.4f}, "lamp");
  View view = make_view_towards(scene, {0, 0, 0.9}, {0, 0, 0}, {0, 1, 0}, 1.2f, 32, 32);
  SplatStage stage(std::move(scene), view);
  run(stage);
  EXPECT_TRUE(range_of(stage).fine);
  EXPECT_GT(range_of(stage).mean, 0.01);
}

TEST(SplatHardCases, PixelsWithoutASurfaceStayDark) {
  SplatStage stage = make_hard_room({hard_bulb({0, 0, 0})}, 2, vec3(0), 40);
  const float none[] = {std::numeric_limits<float>::quiet_NaN(), -1, 0,
                        std::numeric_limits<float>::infinity()};
  for (size_t i = 0; i < stage.depth.size(); i += 7) stage.depth[i] = none[i % 4];
  run(stage);
  for (size_t i = 0; i < stage.depth.size(); i++)
    EXPECT_EQ(stage.picture.irradiance[i] == vec3(0), i % 7 == 0) << i;
}
