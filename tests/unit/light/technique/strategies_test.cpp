// SPDX-License-Identifier: Apache-2.0
// Several ways to the same light agree, and what should not be seen is not.
#include "light/sample/light_tables.h"
#include "light/sample/sample_light.h"
#include "scenes/scenes.h"
#include "unit/light/statistics.h"
#include "world/surface.h"

namespace wellspring::test {
namespace {

using namespace scenes;

TEST(Strategies, GlassSlabInUniformLightIsInvisible) {
  for (float roughness : {0.0f, 0.5f}) {
    Scene scene = empty_scene();
    add_box(scene, glass(1.5f, roughness, 1), vec3(2), "cube");
    scene.environment.radiance = vec3(1);
    World world(scene);
    Lights lights = make_lights(world);
    Mean mean = trace_mean("path", world, lights, ray_towards({0.5f, 0.4f, 3}, {0, 0, 0}), 60000,
                           {.max_depth = 500});
    EXPECT_NEAR(mean.mean(), 1, 0.01 + 4 * mean.error()) << roughness;
    EXPECT_LT(mean.error(), 0.02) << roughness;
  }
}

TEST(Strategies, UnlitShowsItsBaseColor) {
  Scene scene = empty_scene();
  Material m = diffuse({0.2f, 0.4f, 0.6f});
  m.unlit = true;
  add_wall(scene, m, 0, 1, "quad");
  scene.lights.push_back({.position = {0, 0, 1}, .intensity = vec3(100)});
  World world(scene);
  Lights lights = make_lights(world);
  for (const Technique& technique : techniques()) {
    Request request{.ray = ray_towards({0, 0, 2}, {0, 0, 0})};
    vec3 c = technique.trace(world, lights, {}, request).radiance();
    EXPECT_LT(length(c - vec3(0.2f, 0.4f, 0.6f)), 1e-6f) << technique.name;
  }
}

// Three ways to the same light: choosing a light, scattering, and both weighted together.
TEST(Strategies, StrategiesAgree) {
  for (const Material& m :
       {diffuse(vec3(0.5f)), metal(vec3(0.7f), 0.3f), plastic(vec3(0.5f), 0.5f)}) {
    Scene scene = make_plane_with_rect_light(10);
    scene.meshes[0].material = add_material(scene, m);
    World world(scene);
    Lights lights = make_lights(world);
    Ray ray = ray_towards({0.2f, 0.4f, 0.9f}, {0.2f, 0, 0});
    TransportSettings settings{.max_depth = 2};
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

}  // namespace
}  // namespace wellspring::test
