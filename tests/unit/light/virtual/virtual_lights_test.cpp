// SPDX-License-Identifier: Apache-2.0
// Reflective shadow maps and virtual lights carry what the sources emit.
#include "unit/light/virtual/splat_stage.h"

using namespace wellspring;

using namespace wellspring::test;
using namespace wellspring::scenes;
using namespace wellspring::test;

namespace {

constexpr float albedo = 0.5f;

// A closed room of that albedo, 2 m a side about the origin.
Scene make_room() {
  Scene scene = empty_scene();
  add_mesh(scene, box_mesh(add_material(scene, diffuse(vec3(albedo))), vec3(2), true), "room");
  return scene;
}
View inside(const Scene& scene) {
  return make_view_towards(scene, {0, 0, 0.9}, {0, 0, 0}, {0, 1, 0}, 1.2f, 16, 16);
}

double reflected_by_texels(const ReflectiveShadowMap& map) {
  double sum = 0;
  for (const ReflectiveTexel& texel : map.texels) sum += double(texel.flux.x);
  return sum;
}
// Returns the lights' intensity times pi; they have one colour.
double reflected_by_lights(const VirtualLights& lights) {
  double sum = 0;
  for (size_t i = 0; i < size_t(lights.count); i++)
    sum += double(lights.intensity(i).x) * double(pi);
  return sum;
}

// All that the room's source emits, `flux` watts, is reflected once.
void expect_flux(Scene scene, double flux, const char* what, double slack = 0.01) {
  View view = inside(scene);
  SplatStage stage(std::move(scene), view);
  SplatSettings settings;
  stage.draw(settings);
  EXPECT_NEAR(reflected_by_texels(stage.drawn.map) / (flux * double(albedo)), 1, slack) << what;
  EXPECT_GT(stage.drawn.lights.count, 100) << what;
  double mean = 0;
  constexpr int passes = 16;
  for (uint32_t pass = 0; pass < passes; pass++) {
    stage.draw(settings, {7, pass});
    mean += reflected_by_lights(stage.drawn.lights) / passes;
  }
  EXPECT_NEAR(mean / (flux * double(albedo)), 1, 0.03) << what;
}

PunctualLight bulb(PunctualType type) {
  PunctualLight light;
  light.type = type;
  light.position = {0.2f, 0.3f, -0.1f};
  light.direction = normalize(vec3(0.3f, -1, 0.2f));
  light.intensity = vec3(5);
  return light;
}

}  // namespace

TEST(VirtualLights, APointLightIsReflectedWhole) {
  Scene scene = make_room();
  scene.lights.push_back(bulb(PunctualType::point));
  expect_flux(std::move(scene), 5 * 4 * double(pi), "point");
}

TEST(VirtualLights, ASpotIsReflectedWhole) {
  Scene scene = make_room();
  PunctualLight spot = bulb(PunctualType::spot);
  spot.inner_cone = 0.3f, spot.outer_cone = 0.9f;
  scene.lights.push_back(spot);
  // The fall-off's integral over the cap: t^2 from the outer cosine to the inner one.
  double inner = std::cos(0.3), outer = std::cos(0.9);
  expect_flux(std::move(scene), 5 * 2 * double(pi) * ((1 - inner) + (inner - outer) / 3), "spot");
}

TEST(VirtualLights, ALampIsReflectedWhole) {
  Scene scene = make_room();
  add_quad(scene, add_material(scene, emitter(vec3(3))), {-0.3f, 0.9f, -0.2f}, {0.6f, 0, 0},
           {0, 0, 0.4f}, "lamp");
  expect_flux(std::move(scene), 3 * double(pi) * 0.24, "lamp");
}

// A floor in the sun: what arrives is its area times the cosine, whatever the window.
TEST(VirtualLights, TheSunsWindowHoldsTheScene) {
  Scene scene = empty_scene();
  add_quad(scene, add_material(scene, diffuse(vec3(albedo))), {-3, 0, 2}, {6, 0, 0}, {0, 0, -4},
           "floor");
  scene.lights.push_back(bulb(PunctualType::directional));
  double cosine = -double(scene.lights[0].direction.y);
  View view = make_view_towards(scene, {0, 3, 0.1}, {0, 0, 0}, {0, 1, 0}, 1.2f, 16, 16);
  SplatStage stage(std::move(scene), view);
  stage.draw({});
  EXPECT_NEAR(reflected_by_texels(stage.drawn.map) / (24 * 5 * cosine * double(albedo)), 1, 0.02);
  for (const ReflectiveTexel& texel : stage.drawn.map.texels)
    EXPECT_NEAR(texel.flux.x > 0 ? texel.normal.y : 1, 1, 1e-5);
}

// Sky of radiance 2 all around: pi times that arrives on each side of a floor.
TEST(VirtualLights, TheSkyIsReflectedWhole) {
  Scene scene = empty_scene();
  add_quad(scene, add_material(scene, diffuse(vec3(albedo))), {-3, 0, 2}, {6, 0, 0}, {0, 0, -4},
           "floor");
  scene.environment.radiance = vec3(2);
  View view = make_view_towards(scene, {0, 3, 0.1}, {0, 0, 0}, {0, 1, 0}, 1.2f, 16, 16);
  SplatStage stage(std::move(scene), view);
  SplatSettings settings;
  settings.texels = 1 << 16;
  stage.draw(settings);
  EXPECT_NEAR(reflected_by_texels(stage.drawn.map) / (2 * 24 * 2 * double(pi) * double(albedo)), 1,
              0.02);
}

// A texel stands for a part of the room's walls, and all together for all of them, about.
TEST(VirtualLights, TexelsStandForTheSurfaceTheyHit) {
  Scene scene = make_room();
  scene.lights.push_back(bulb(PunctualType::point));
  View view = inside(scene);
  SplatStage stage(std::move(scene), view);
  stage.draw({});
  double area = 0;
  for (const ReflectiveTexel& texel : stage.drawn.map.texels) area += double(texel.area);
  EXPECT_NEAR(area, 24, 1);
}

// A light that moves a little moves its virtual lights a little.
TEST(VirtualLights, ALightThatMovesKeepsItsRays) {
  Scene scene = make_room();
  View view = inside(scene);
  SplatStage stage(std::move(scene), view);
  PunctualLight light = bulb(PunctualType::point);
  std::vector<vec3> before;
  for (int step = 0; step < 2; step++) {
    light.position.x += 1e-3f;
    SplatSource source = make_splat_source(light, 5);
    SplatSettings settings;
    draw_virtual_lights(stage.transport(), std::span(&source, 1), settings, {}, {}, stage.drawn);
    const VirtualLights& lights = stage.drawn.lights;
    ASSERT_GT(lights.count, 200);
    for (size_t i = 0; i < size_t(lights.count); i++) {
      vec3 place = lights.position(i);
      if (step == 0) before.push_back(place);
      else EXPECT_LT(length(place - before[i]), 0.01f) << i;
    }
  }
}
