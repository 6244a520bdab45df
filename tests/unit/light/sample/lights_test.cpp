// SPDX-License-Identifier: Apache-2.0
#include "light/sample/lights.h"

#include "light/sample/sample_light.h"
#include "scenes/scenes.h"
#include "unit/light/statistics.h"

namespace wellspring::test {
namespace {

using namespace scenes;

Surface place_at(vec3 position, vec3 normal = {0, 1, 0}) {
  Surface s;
  s.position = position;
  s.normal = s.geometric_normal = normal;
  return s;
}

// A picture of the sky: dim, with a bright patch and some colour.
void add_sky(Scene& scene, int width, int height) {
  Image image{.width = width, .height = height};
  for (int y = 0; y < height; y++)
    for (int x = 0; x < width; x++) {
      bool sun = x > width / 2 && x < width * 3 / 4 && y > height / 8 && y < height / 3;
      image.texels.push_back(sun ? vec4(40, 30, 20, 1)
                                 : vec4(0.5f, 0.6f, float(y) / float(height), 1));
    }
  scene.images.push_back(std::move(image));
  scene.environment = {vec3(1), int(scene.images.size()) - 1};
}

TEST(AliasTable, PicksInProportion) {
  std::vector<float> weights = {1, 0, 5, 0.25f, 3, 0, 10, std::nanf(""), -4};
  AliasTable table = make_alias_table(weights);
  EXPECT_NEAR(table.total, 19.25, 1e-6);
  std::vector<double> counts(weights.size()), expected;
  Rng rng(1);
  constexpr int count = 100000;
  Mean left;
  for (int i = 0; i < count; i++) {
    AliasPick pick = sample_alias(table, rng.uniform());
    counts[pick.index]++;
    left.add(double(pick.u));
    ASSERT_GE(pick.u, 0);
    ASSERT_LE(pick.u, 1);
  }
  for (size_t i = 0; i < weights.size(); i++) {
    double w = weights[i] > 0 ? double(weights[i]) : 0;
    expected.push_back(w / 19.25 * count);
    EXPECT_NEAR(table.cells[i].probability, w / 19.25, 1e-6);
    if (w == 0) {
      EXPECT_EQ(counts[i], 0) << i;
    }
  }
  expect_chi_squared(counts, expected, "alias table");
  expect_mean(left, 0.5, "what is left of the number");
  EXPECT_TRUE(make_alias_table(std::vector<float>{0, -1}).cells.empty());
  EXPECT_TRUE(make_alias_table(std::vector<float>{}).cells.empty());
}

TEST(Lights, EmittersArePickedByPowerAndPlaceAndTheirDensitiesAgree) {
  Scene scene = empty_scene();
  add_floor(scene, 0.5f);
  int dim = add_material(scene, emitter(vec3(1))), bright = add_material(scene, emitter(vec3(9)));
  add_quad(scene, dim, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}, "dim");
  int strong = add_quad(scene, bright, {3, 1, 0}, {1, 0, 0}, {0, 0, 1}, "bright");
  add_quad(scene, bright, {5, 1, 0}, {1, 0, 0}, {1, 0, 0}, "flat");  // no area
  World world(scene);
  Lights lights = make_lights(world);
  Surface from = place_at({1, 0.1f, 0.4f});
  Sampler sampler(3);
  int picked = 0, total = 20000;
  for (int i = 0; i < total; i++) {
    LightSample light = sample_area_light({world, *lights.tables}, from, sampler);
    ASSERT_GT(light.pdf, 0);
    Ray ray{.origin = from.position, .direction = light.direction};
    Hit hit = world.intersect(ray);
    ASSERT_TRUE(hit.valid());
    Surface met = eval_surface(world, ray, hit);
    picked += hit.instance == uint32_t(strong);
    float pdf = sample_emitter_pdf(*lights.tables, from.position, from.geometric_normal,
                                   ray.direction, met);
    ASSERT_NEAR(pdf, light.pdf, 2e-3f * light.pdf);
    ASSERT_EQ(met.emission, light.radiance);
  }
  // The bright quad's triangles are picked as often as their probabilities say, less often than
  // their power alone would have it (0.9), because the dim quad is nearer.
  const LightTree& tree = lights.tables->emitter_choice;
  double expected = 0, all = 0;
  for (uint32_t i = 0; i < lights.tables->emitters.size(); i++) {
    float p = pick_light_probability(tree, from.position, from.geometric_normal, i);
    all += double(p);
    if (lights.tables->emitters[i].instance == uint32_t(strong)) expected += double(p);
  }
  EXPECT_NEAR(all, 1, 1e-5);
  EXPECT_NEAR(picked / double(total), expected, 4 * std::sqrt(0.25 / total));
  EXPECT_LT(expected, 0.8);
  EXPECT_GT(expected, 0.3);
}

TEST(Lights, SingleSidedEmittersShineToTheirFrontOnly) {
  for (bool double_sided : {false, true}) {
    Scene scene = empty_scene();
    Material m = emitter(vec3(1));
    m.double_sided = double_sided;
    add_quad(scene, m, {0, 1, 0}, {1, 0, 0}, {0, 0, 1});  // faces down
    World world(scene);
    Lights lights = make_lights(world);
    Sampler sampler(3);
    EXPECT_GT(sample_area_light({world, *lights.tables}, place_at({0.5f, 0, 0.5f}), sampler).pdf,
              0);
    EXPECT_EQ(
        sample_area_light({world, *lights.tables}, place_at({0.5f, 2, 0.5f}), sampler).pdf > 0,
        double_sided);
  }
}

TEST(Lights, SkyIsSampledByItsBrightness) {
  Scene scene = empty_scene();
  add_floor(scene, 0.5f);
  add_sky(scene, 64, 32);
  World world(scene);
  Lights lights = make_lights(world);
  const EnvironmentLight& sky = lights.tables->environment;
  constexpr int rows = 8, columns = 16, count = 50000;
  std::vector<double> counts(rows * columns), expected(rows * columns);
  Sampler sampler(5);
  Mean radiance;
  for (int i = 0; i < count; i++) {
    EnvironmentSample s = sample_environment(sky, sampler);
    ASSERT_NEAR(length(s.direction), 1, 1e-5f);
    ASSERT_NEAR(s.pdf, sample_environment_pdf(sky, s.direction), 1e-3f * s.pdf);
    radiance.add(double(luminance(eval_environment(sky, s.direction)) / s.pdf));
    float phi = std::atan2(s.direction.z, s.direction.x) + pi;
    counts[size_t(std::min(int((s.direction.y + 1) / 2 * rows), rows - 1) * columns +
                  std::min(int(phi / (2 * pi) * columns), columns - 1))]++;
  }
  double exact = 0;
  constexpr int fine = 64;
  for (int row = 0; row < rows; row++)
    for (int column = 0; column < columns; column++)
      for (int i = 0; i < fine * fine; i++) {
        float y = -1 + 2 * (float(row) + (float(i / fine) + 0.5f) / fine) / rows;
        float phi = 2 * pi * (float(column) + (float(i % fine) + 0.5f) / fine) / columns - pi;
        float r = std::sqrt(1 - y * y);
        vec3 d(r * std::cos(phi), y, r * std::sin(phi));
        double solid = 4 * double(pi) / (rows * columns * fine * fine);
        expected[size_t(row * columns + column)] +=
            double(sample_environment_pdf(sky, d)) * solid * count;
        exact += double(luminance(eval_environment(sky, d))) * solid;
      }
  expect_chi_squared(counts, expected, "sky");
  EXPECT_NEAR(radiance.mean(), exact, 4 * radiance.error() + 2e-3 * exact);
  EXPECT_LT(radiance.error() * std::sqrt(double(count)) / radiance.mean(), 0.5)
      << "importance is followed";
}

TEST(Lights, SkyPictureIsTheRightWayRound) {
  Scene scene = empty_scene();
  Image image{.width = 4, .height = 2};
  image.texels.assign(8, vec4(0));
  image.texels[2] = vec4(1, 0, 0, 1);  // upper half, the column right of the middle
  scene.images.push_back(image);
  scene.environment = {vec3(2), 0};
  EnvironmentLight sky = make_environment_light(scene);
  // Column 2 of 4 spans 0 to 90 degrees to the right of -Z; the upper row is centred 45 degrees up.
  vec3 centre = normalize(vec3(1, std::sqrt(2.0f), -1));
  EXPECT_NEAR(eval_environment(sky, centre).x, 2, 1e-4f);
  EXPECT_NEAR(eval_environment(sky, normalize(vec3(-1, std::sqrt(2.0f), -1))).x, 0, 1e-4f);
  EXPECT_NEAR(eval_environment(sky, normalize(vec3(1, -std::sqrt(2.0f), -1))).x, 0, 1e-4f);
}

TEST(Lights, ManyPunctualLightsAreSampledWithoutBias) {
  for (int count : {3, 16, 17, 104}) {
    Scene scene = empty_scene();
    add_floor(scene, 0.5f);
    Rng rng(9);
    double exact = 0;
    Surface from = place_at({0, 0, 0});
    for (int i = 0; i < count; i++) {
      PunctualLight light{
          .position = {rng.uniform() * 6 - 3, 1 + rng.uniform(), rng.uniform() * 6 - 3},
          .intensity = vec3(rng.uniform() * 5)};
      scene.lights.push_back(light);
      float d2 = dot(light.position, light.position);
      exact += double(light.intensity.x * light.position.y / (d2 * std::sqrt(d2)));
    }
    World world(scene);
    Lights lights = make_lights(world);
    Sampler sampler(2);
    Mean irradiance;
    for (int i = 0; i < 40000; i++) {
      LightSample light =
          sample_punctual_light({world, *lights.tables}, from, from.normal, false, sampler);
      irradiance.add(light.pdf > 0 ? double(light.radiance.x * light.direction.y) : 0);
    }
    expect_mean(irradiance, exact, (std::to_string(count) + " lights").c_str());
  }
}

TEST(Lights, WhatCannotShineIsLeftOut) {
  Scene scene = empty_scene();
  add_floor(scene, 0.5f);
  PunctualLight dark, broken;
  dark.intensity = vec3(0);
  broken.position.x = std::nanf("");
  scene.lights = {dark, broken};
  World world(scene);
  Lights lights = make_lights(world);
  EXPECT_TRUE(lights.tables->punctual.empty());
  Sampler sampler(1);
  EXPECT_EQ(sample_area_light({world, *lights.tables}, place_at({0, 0, 0}), sampler).pdf, 0);
}

// Emission by a picture: whatever the estimate of each triangle's power, the light that arrives is
// right.
TEST(Lights, TexturedEmittersAreUnbiased) {
  Scene scene = make_plane_with_rect_light(1);
  Image image{.width = 16, .height = 16};
  for (int i = 0; i < 256; i++)
    image.texels.push_back(i % 16 < 4 ? vec4(8, 8, 8, 1) : vec4(0, 0, 0, 1));
  scene.materials.back().emission_texture.texture = add_texture(scene, image);
  World world(scene);
  Lights lights = make_lights(world);
  Ray ray = ray_towards({0.4f, 0.6f, 0}, {0.3f, 0, 0.1f});
  TransportSettings direct{.max_depth = 2};
  Mean with_choice = trace_mean("path", world, lights, ray, 40000, direct);
  // Without any choice of emitters every bit of light is found by scattering.
  auto blind = std::make_shared<LightTables>(*lights.tables);
  blind->emitter_choice = {};
  blind->area_share = 0;
  Mean by_scattering =
      trace_mean("path", world, {blind, lights.bad_samples}, ray, 400000, direct, 99);
  expect_same_mean(with_choice, by_scattering, "textured emitter");
  EXPECT_GT(with_choice.mean(), 0.05);
}

}  // namespace
}  // namespace wellspring::test
