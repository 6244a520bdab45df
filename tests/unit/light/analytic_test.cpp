// SPDX-License-Identifier: Apache-2.0
// Scenes whose radiance is known by formula; every technique that claims the scene, judged by a
// z-test.
#include "light/light_tables.h"
#include "light/sample_light.h"
#include "scenes/scenes.h"
#include "statistics.h"

using namespace wellspring;
using namespace wellspring::scenes;
using namespace wellspring::test;

namespace {

constexpr const char* both[] = {"path", "direct"};

// Radiance of one ray into a scene, for both techniques.
void expect_radiance(const Scene& scene, Ray ray, double expected, const char* what,
                     int count = 20000, double longest_bar = 0.02) {
  World world(scene);
  Lights lights = make_lights(world);
  for (const char* technique : both) {
    Mean mean = trace_mean(technique, world, lights, ray, count);
    expect_mean(mean, expected, (std::string(technique) + ", " + what).c_str(), longest_bar);
  }
  EXPECT_EQ(lights.bad_samples->load(), 0u);
}

PunctualLight point_light(vec3 position, float intensity) {
  PunctualLight light;
  light.position = position;
  light.intensity = vec3(intensity);
  return light;
}

}  // namespace

TEST(Analytic, Furnace) {
  for (float albedo : {0.0f, 0.3f, 0.6f, 0.9f}) {
    Scene scene = make_furnace(albedo);
    World world(scene);
    Lights lights = make_lights(world);
    TransportSettings settings;
    settings.max_depth = 1000;
    Mean mean = trace_mean("path", world, lights, ray_towards({0.1f, 0.2f, -0.3f}, {1, 0.3f, 0.2f}),
                           40000, settings);
    expect_mean(mean, 1 / (1 - double(albedo)), "furnace");
    // n edges see the first n terms of the series.
    settings.max_depth = 3;
    mean = trace_mean("path", world, lights, ray_towards({0.1f, 0.2f, -0.3f}, {1, 0.3f, 0.2f}),
                      20000, settings);
    expect_mean(mean, 1 + albedo + albedo * albedo, "three terms of the furnace");
  }
}

TEST(Analytic, RectangularLightByLambert) {
  Scene scene = make_plane_with_rect_light(10);
  for (vec3 p : {vec3(0, 0, 0), vec3(0.8f, 0, 0.3f), vec3(-2, 0, 1.5f)}) {
    double expected = rect_light_irradiance(p, 10) * 0.5 / double(pi);
    expect_radiance(scene, ray_towards(p + vec3(0.1f, 0.5f, 0.8f), p), expected, "rectangle");
  }
}

TEST(Analytic, SphereLight) {
  // A sphere of radius r at distance d straight above: E = pi L (r/d)^2. 64 rings: 0.2 % less area
  // at most.
  Scene scene = empty_scene();
  add_floor(scene, 0.5f);
  add_mesh(scene, sphere_mesh(add_material(scene, emitter(vec3(4))), 0.5f, 64), "sphere",
           at({0, 2, 0}));
  World world(scene);
  Lights lights = make_lights(world);
  for (const char* technique : both) {
    Mean mean = trace_mean(technique, world, lights, ray_towards({1, 1, 0}, {0, 0, 0}), 60000);
    double expected = 0.5 * 4 * 0.25 / 4;
    EXPECT_NEAR(mean.mean(), expected, significance_z * mean.error() + 0.002 * expected);
    EXPECT_LT(mean.error(), 0.01 * expected);
  }
}

TEST(Analytic, PointLightInverseSquare) {
  for (float height : {0.5f, 1.0f, 4.0f}) {
    Scene scene = make_plane_with_punctual(point_light({1, height, 0}, 3));
    double d2 = 1 + double(height) * height, cosine = height / std::sqrt(d2);
    expect_radiance(scene, ray_towards({0, 1, 1}, {0, 0, 0}), 0.5 / double(pi) * 3 * cosine / d2,
                    "point");
  }
}

TEST(Analytic, PointLightRange) {
  PunctualLight light = point_light({0, 1, 0}, 3);
  light.range = 2;
  expect_radiance(make_plane_with_punctual(light), ray_towards({1, 1, 1}, {0, 0, 0}),
                  0.5 / double(pi) * 3 * (1 - 1.0 / 16), "range");
  light.range = 0.9f;
  expect_radiance(make_plane_with_punctual(light), ray_towards({1, 1, 1}, {0, 0, 0}), 0,
                  "out of range");
}

TEST(Analytic, DirectionalLight) {
  PunctualLight light;
  light.type = PunctualType::directional;
  light.direction = normalize(vec3(1, -2, 0.5f));
  light.intensity = vec3(5);
  expect_radiance(make_plane_with_punctual(light), ray_towards({1, 1, 1}, {0, 0, 0}),
                  0.5 / double(pi) * 5 * double(-light.direction.y), "directional");
}

TEST(Analytic, SpotCone) {
  PunctualLight light = point_light({0, 2, 0}, 8);
  light.type = PunctualType::spot;
  light.direction = {0, -1, 0};
  light.inner_cone = 0.3f;
  light.outer_cone = 0.6f;
  for (double angle : {0.0, 0.29, 0.45, 0.55, 0.61}) {
    double x = 2 * std::tan(angle), d2 = 4 + x * x, c = std::cos(angle);
    double t = glm::clamp((c - std::cos(0.6)) / (std::cos(0.3) - std::cos(0.6)), 0.0, 1.0);
    double expected = 0.5 / double(pi) * 8 * t * t * c / d2;
    expect_radiance(make_plane_with_punctual(light),
                    ray_towards({float(x), 1, 1}, {float(x), 0, 0}), expected, "spot");
  }
}

TEST(Analytic, ConstantEnvironmentOverAPlane) {
  Scene scene = empty_scene();
  add_floor(scene, 0.5f);
  scene.environment.radiance = {1, 2, 4};
  expect_radiance(scene, ray_towards({1, 1, 1}, {0, 0, 0}), 0.5 * double(luminance({1, 2, 4})),
                  "sky");
  expect_radiance(scene, ray_towards({0, 1, 0}, {1, 2, 0}), double(luminance({1, 2, 4})),
                  "sky itself");
}

TEST(Analytic, EnvironmentPictureOverAPlane) {
  // Bright in one quarter of the upper hemisphere: E by quadrature of the same picture.
  Scene scene = empty_scene();
  add_floor(scene, 0.5f);
  Image image;
  image.width = 32;
  image.height = 16;
  for (int i = 0; i < 32 * 16; i++)
    image.texels.push_back(vec4(i % 32 < 8 ? vec3(20) : vec3(0.1f), 1));
  scene.images.push_back(image);
  scene.environment = {vec3(1.5f), 0};
  EnvironmentLight sky = make_environment_light(scene);
  double irradiance = 0;
  constexpr int n = 600;
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {  // uniform in projected solid angle
      float r = std::sqrt((float(i) + 0.5f) / n), phi = 2 * pi * (float(j) + 0.5f) / n;
      irradiance += double(
          eval_environment(sky, {r * std::cos(phi), std::sqrt(1 - r * r), r * std::sin(phi)}).x);
    }
  irradiance *= double(pi) / (n * n);
  expect_radiance(scene, ray_towards({1, 1, 1}, {0, 0, 0}), irradiance * 0.5 / double(pi),
                  "sky picture", 40000);
}

TEST(Analytic, MirrorChainShowsTheLampUnchanged) {
  // Two mirrors of reflectance 0.9 at normal incidence would be 0.81; Schlick raises it at 45
  // degrees.
  Scene scene = empty_scene();
  int mirror = add_material(scene, metal(vec3(0.9f), 0)),
      lamp = add_material(scene, emitter(vec3(7)));
  add_quad(scene, mirror, {1, -1, 1}, {2, 2, 0}, {0, 0, -2});  // turns +X into +Y
  add_quad(scene, mirror, {1, 5, 1}, {2, -2, 0}, {0, 0, -2});  // turns +Y into -X
  add_quad(scene, lamp, {-3, 3, 1}, {0, 2, 0}, {0, 0, -2});    // faces +X
  for (auto& m : scene.materials) m.double_sided = true;
  double f = 0.9 + 0.1 * std::pow(1 - std::sqrt(0.5), 5);
  expect_radiance(scene, ray_towards({-2, 0, 0}, {1, 0, 0}), 7 * f * f, "two mirrors", 100);
}

// The light behind a clear pane: shadow rays and scattered rays go through and count it once.
TEST(Analytic, LightBehindAPane) {
  auto fresnel = [](double c) {
    double s2 = (1 - c * c) / 2.25, t = std::sqrt(1 - s2);
    double a = (1.5 * c - t) / (1.5 * c + t), b = (c - 1.5 * t) / (c + 1.5 * t);
    return 0.5 * (a * a + b * b);
  };
  for (int panes : {1, 3}) {
    // The pane lies flat between floor and light; looked at from below it, its mirror image adds
    // nothing as `direct` light, so max_depth 2 is compared.
    PunctualLight point = point_light({0.5f, 2, 0}, 6);
    Scene scene = make_plane_with_punctual(point);
    Material clear = glass(1.5f, 0, 0);
    clear.base_color = vec4(0.8f, 0.8f, 0.8f, 1);
    int pane = add_material(scene, clear);
    for (int i = 0; i < panes; i++)
      add_quad(scene, pane, {-5, 1 + 0.1f * float(i), 5}, {10, 0, 0}, {0, 0, -10});
    double c = 2 / std::sqrt(4.25);
    double expected = 0.5 / double(pi) * 6 * c / 4.25 * std::pow(0.8 * (1 - fresnel(c)), panes);
    World world(scene);
    Lights lights = make_lights(world);
    TransportSettings settings;
    settings.max_depth = 2;
    for (const char* technique : both)
      expect_mean(trace_mean(technique, world, lights, ray_towards({0, 0.5f, 1}, {0, 0, 0}), 2000,
                             settings),
                  expected, "point light behind panes");
  }
  Scene scene = make_plane_with_rect_light(10);
  Material clear = glass(1.5f, 0, 0);
  int pane = add_material(scene, clear);
  add_quad(scene, pane, {-5, 0.7f, 5}, {10, 0, 0}, {0, 0, -10});
  // Quadrature over the lamp with each direction's own Fresnel loss.
  double irradiance = 0;
  constexpr int n = 400;
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      dvec3 q(-0.5 + 1.5 * (i + 0.5) / n, 1, -0.5 + (j + 0.5) / n);
      double d2 = dot(q, q), c = 1 / std::sqrt(d2);
      irradiance += 10 * c * c / d2 * (1 - fresnel(c)) * 1.5 / (n * n);
    }
  World world(scene);
  Lights lights = make_lights(world);
  auto blind = std::make_shared<LightTables>(*lights.tables);
  blind->emitter_choice = {};
  blind->area_share = 0;
  TransportSettings settings;
  settings.max_depth = 2;
  Ray ray = ray_towards({0, 0.5f, 1}, {0, 0, 0});
  for (const char* technique : both) {
    expect_mean(trace_mean(technique, world, lights, ray, 40000, settings),
                irradiance * 0.5 / double(pi), "lamp behind a pane, both ways combined");
    expect_mean(trace_mean(technique, world, {blind, lights.bad_samples}, ray, 60000, settings),
                irradiance * 0.5 / double(pi), "lamp behind a pane, by scattering alone");
  }
}

TEST(Analytic, BeersLawThroughASlab) {
  // Straight through a slab of index 1: nothing but absorption.
  Material m = glass(1, 0, 0.5f);
  m.attenuation_color = {0.5f, 0.25f, 1};
  m.attenuation_distance = 0.25f;
  Scene scene = empty_scene();
  add_mesh(scene, box_mesh(add_material(scene, m), {2, 2, 0.5f}), "slab");
  scene.environment.radiance = vec3(1);
  World world(scene);
  Lights lights = make_lights(world);
  for (const char* technique : both) {
    Request request;
    request.ray = ray_towards({0.1f, 0.1f, 3}, {0.1f, 0.1f, 0});
    request.seed = 5;
    vec3 c = find_technique(technique)->trace(world, lights, {}, request).radiance();
    EXPECT_NEAR(c.x, 0.25f, 1e-4f);
    EXPECT_NEAR(c.y, 0.0625f, 1e-4f);
    EXPECT_NEAR(c.z, 1, 1e-4f);
    request.ray.origin = {0.1f, 0.1f, 0};  // the eye is inside
    c = find_technique(technique)->trace(world, lights, {}, request).radiance();
    EXPECT_NEAR(c.x, 0.5f, 1e-4f);
  }
}

TEST(Analytic, GlassSlabInUniformLightIsInvisible) {
  for (float roughness : {0.0f, 0.5f}) {
    Scene scene = empty_scene();
    add_mesh(scene, box_mesh(add_material(scene, glass(1.5f, roughness, 1)), vec3(2)), "cube");
    scene.environment.radiance = vec3(1);
    World world(scene);
    Lights lights = make_lights(world);
    TransportSettings settings;
    settings.max_depth = 500;
    Mean mean =
        trace_mean("path", world, lights, ray_towards({0.5f, 0.4f, 3}, {0, 0, 0}), 60000, settings);
    EXPECT_NEAR(mean.mean(), 1, 0.01 + 4 * mean.error()) << roughness;
    EXPECT_LT(mean.error(), 0.02) << roughness;
  }
}

TEST(Analytic, UnlitShowsItsBaseColor) {
  Scene scene = empty_scene();
  Material m = diffuse({0.2f, 0.4f, 0.6f});
  m.unlit = true;
  add_quad(scene, add_material(scene, m), {-1, -1, 0}, {2, 0, 0}, {0, 2, 0});
  scene.lights.push_back(point_light({0, 0, 1}, 100));
  expect_radiance(scene, ray_towards({0, 0, 2}, {0, 0, 0}), double(luminance({0.2f, 0.4f, 0.6f})),
                  "unlit", 10);
}

// Three ways to the same light: choosing a light, scattering, and both weighted together.
TEST(Analytic, StrategiesAgree) {
  for (const Material& m :
       {diffuse(vec3(0.5f)), metal(vec3(0.7f), 0.3f), plastic(vec3(0.5f), 0.5f)}) {
    Scene scene = make_plane_with_rect_light(10);
    scene.meshes[0].material = add_material(scene, m);
    World world(scene);
    Lights lights = make_lights(world);
    Ray ray = ray_towards({0.2f, 0.4f, 0.9f}, {0.2f, 0, 0});
    TransportSettings settings;
    settings.max_depth = 2;
    Mean combined = trace_mean("path", world, lights, ray, 60000, settings);
    auto blind = std::make_shared<LightTables>(*lights.tables);
    blind->emitter_choice = {};
    blind->area_share = 0;
    Mean scattering =
        trace_mean("path", world, {blind, lights.bad_samples}, ray, 200000, settings, 3);
    Surface surface = eval_surface(world, ray, world.intersect(ray));
    Bsdf bsdf = make_bsdf(surface, m, ray.direction, dielectric_albedo(m.ior));
    Mean choosing;
    Sampler sampler(17);
    Transport transport{world, *lights.tables};
    for (int i = 0; i < 200000; i++) {
      LightSample light = sample_area_light(transport, surface, sampler);
      BsdfValue value = eval_bsdf(bsdf, light.direction);
      vec3 arrives = light.pdf > 0
                         ? light.radiance * eval_visibility(transport, surface, light) / light.pdf
                         : vec3(0);
      choosing.add(double(luminance((value.diffuse + value.specular) * arrives)));
    }
    expect_same_mean(combined, scattering, "combined and scattering");
    expect_same_mean(combined, choosing, "combined and choosing");
    EXPECT_LE(combined.error() * std::sqrt(combined.count),
              1.2 * std::min(scattering.error() * std::sqrt(scattering.count),
                             choosing.error() * std::sqrt(choosing.count)) +
                  1e-3)
        << "combining is no worse than the better of both";
  }
}
