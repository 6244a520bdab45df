// SPDX-License-Identifier: Apache-2.0
// The light of lights that move, for a picture: that of the technique for direct light, pixel by
// pixel, and in half of the resolution never across edges.
#include "light/virtual/dynamic_image.h"

#include <gtest/gtest.h>

#include <cmath>

#include "light/technique/technique.h"
#include "scenes/dynamic_picture.h"
#include "scenes/scenes.h"

using namespace wellspring;

using namespace wellspring::test;
using namespace wellspring::scenes;

namespace {

PunctualLight lamp(vec3 position, vec3 intensity = vec3(3, 2, 1)) {
  PunctualLight light;
  light.position = position;
  light.intensity = intensity;
  return light;
}

// A floor with a ball on it and, where asked for, a tinted pane beside the lamp.
Scene make_floor_and_ball(bool pane = false) {
  Scene scene = empty_scene();
  add_floor(scene, 0.5f);
  add_mesh(scene, sphere_mesh(add_material(scene, diffuse(vec3(0.7f, 0.5f, 0.3f))), 0.5f, 64),
           "ball", at({0, 0.5f, 0}));
  if (!pane) return scene;
  Material tinted = glass(1.5f, 0, 0);
  tinted.base_color = vec4(0.9f, 0.5f, 0.2f, 1);
  add_quad(scene, add_material(scene, tinted), {0.7f, 0, 2}, {0, 0, -4}, {0, 3, 0}, "pane");
  return scene;
}

View view_of(const Scene& scene, int width, int height) {
  return make_view_towards(scene, {-2.5, 1.6, 2.5}, {0, 0.4, 0}, {0, 1, 0}, 0.8f, width, height);
}

// Returns the light of compute_dynamic_light() times reflectance, as a picture would show it.
std::vector<vec3> draw_dynamic(const Scene& scene, const View& view,
                               std::vector<DynamicLight> from) {
  World world(scene);
  Lights lights = make_lights(world);
  VisibilityPass visibility(world, lights);
  DynamicImage image;
  SplatSettings direct_alone;
  direct_alone.virtual_lights = 0;
  compute_dynamic_light(world, lights, visibility, view, from, direct_alone, image);
  return draw_dynamic_light(visibility, image, view);
}

// The same light, as the technique for direct light knows it in a scene that it stands in.
std::vector<vec3> trace_direct_light(Scene scene, const View& view,
                                     const std::vector<DynamicLight>& from) {
  for (const DynamicLight& one : from) scene.lights.push_back(one.light);
  World world(scene);
  Lights lights = make_lights(world);
  const Technique& direct = *find_technique("direct");
  std::vector<vec3> picture;
  for (int y = 0; y < view.height; y++)
    for (int x = 0; x < view.width; x++) {
      Request request;
      request.ray = view_ray(view, float(x) + 0.5f, float(y) + 0.5f);
      vec3 sum(0);
      const int samples = from.size() > 1 ? 64 : 1;
      for (int i = 0; i < samples; i++) {
        request.seed = 7, request.index = uint32_t(i);
        sum += direct.trace(world, lights, {}, request).radiance();
      }
      picture.push_back(sum / float(samples));
    }
  return picture;
}

// Pixels that differ by more than a share of what they should be.
int count_wrong(const std::vector<vec3>& a, const std::vector<vec3>& b, float share) {
  int wrong = 0;
  for (size_t i = 0; i < a.size(); i++)
    wrong += !(max_component(abs(a[i] - b[i])) <= share * max_component(b[i]) + 1e-3f);
  return wrong;
}

TEST(DynamicImage, IsTheDirectLightOfALampWithItsShadows) {
  Scene scene = make_floor_and_ball();
  View view = view_of(scene, 96, 64);
  DynamicLight one{lamp({1, 2, 0.5f})};
  EXPECT_LT(
      count_wrong(draw_dynamic(scene, view, {one}), trace_direct_light(scene, view, {one}), 0.02f),
      96 * 64 / 100);
}

TEST(DynamicImage, KnowsConesRangesAndTheSun) {
  Scene scene = make_floor_and_ball();
  View view = view_of(scene, 96, 64);
  DynamicLight spot{lamp({1, 2, 0.5f})}, sun, near{lamp({1, 2, 0.5f})};
  spot.light.type = PunctualType::spot;
  spot.light.direction = normalize(vec3(-1, -2, -0.5f));
  spot.light.inner_cone = 0.1f, spot.light.outer_cone = 0.4f;
  sun.light.type = PunctualType::directional;
  sun.light.direction = normalize(vec3(-1, -1, -0.3f));
  near.light.range = 2.2f;
  for (const DynamicLight& one : {spot, sun, near}) {
    auto picture = draw_dynamic(scene, view, {one});
    EXPECT_LT(count_wrong(picture, trace_direct_light(scene, view, {one}), 0.02f), 96 * 64 / 100);
    int lit = 0;
    for (vec3 color : picture) lit += max_component(color) > 0;
    EXPECT_GT(lit, 96 * 64 / 50);
  }
}

TEST(DynamicImage, AddsUpManyLights) {
  Scene scene = make_floor_and_ball();
  View view = view_of(scene, 48, 32);
  std::vector<DynamicLight> lights;
  std::vector<vec3> sum(48 * 32, vec3(0));
  for (int i = 0; i < 40; i++) {
    lights.push_back({lamp({std::sin(float(i)) * 2, 1.5f, std::cos(float(i)) * 2}, vec3(0.2f))});
    auto one = draw_dynamic(scene, view, {lights.back()});
    for (size_t p = 0; p < sum.size(); p++) sum[p] += one[p];
  }
  EXPECT_EQ(count_wrong(draw_dynamic(scene, view, lights), sum, 1e-3f), 0);
}

TEST(DynamicImage, PanesTintWhatPassesThem) {
  Scene scene = make_floor_and_ball(true);
  View view = view_of(scene, 96, 64);
  DynamicLight one{lamp({2, 1.5f, 0})};
  auto picture = draw_dynamic(scene, view, {one}), truth = trace_direct_light(scene, view, {one});
  // The pane itself is in the picture, too, which `direct` follows light through.
  EXPECT_LT(count_wrong(picture, truth, 0.05f), 96 * 64 / 20);
  auto without = draw_dynamic(make_floor_and_ball(false), view, {one});
  EXPECT_GT(count_wrong(picture, without, 0.2f), 96 * 64 / 10);
}

TEST(DynamicImage, NothingAroundAFlameCastsAShadow) {
  Scene scene = make_floor_and_ball();
  add_mesh(scene, sphere_mesh(add_material(scene, diffuse(vec3(0.5f))), 0.08f, 16), "flame",
           at({1, 2, 0.5f}));
  View view = view_of(scene, 96, 64);
  DynamicLight one{lamp({1, 2, 0.5f})};
  auto lit = [&] {
    int lit = 0;
    for (vec3 color : draw_dynamic(scene, view, {one})) lit += max_component(color) > 0;
    return lit;
  };
  EXPECT_LT(lit(), 96 * 64 / 50);
  one.radius = 0.1f;
  EXPECT_GT(lit(), 96 * 64 / 3);
}

// Highlights are those that rays find, on metal, on varnish, and where metal and cloth are one
// surface by their texture; in half of the resolution, too.
TEST(DynamicImage, MetalAndVarnishHaveHighlights) {
  DynamicLight one{lamp({1, 2, 0.5f}, vec3(6, 5, 4))};
  for (const Material& material :
       {metal(vec3(0.9f, 0.7f, 0.3f), 0.35f), plastic(vec3(0.3f, 0.1f, 0.1f), 0.3f)})
    for (ivec2 size : {ivec2(96, 64), ivec2(801, 603)}) {
      Scene scene = empty_scene();
      add_floor(scene, 0.5f);
      add_mesh(scene, sphere_mesh(add_material(scene, material), 0.5f, 64), "ball",
               at({0, 0.5f, 0}));
      const View view = view_of(scene, size.x, size.y);
      const auto picture = draw_dynamic(scene, view, {one}),
                 truth = trace_direct_light(scene, view, {one});
      EXPECT_LT(count_wrong(picture, truth, 0.1f), size.x * size.y / 50);
      // The matte ball's picture has none of it.
      const auto peak = [](const std::vector<vec3>& of) {
        float peak = 0;
        for (vec3 color : of) peak = std::max(peak, max_component(color));
        return peak;
      };
      EXPECT_NEAR(peak(picture) / peak(truth), 1, 0.12);
      EXPECT_GT(peak(picture), 1.5f * peak(draw_dynamic(make_floor_and_ball(), view, {one})));
    }
}

// A scene without anything that glosses keeps no room for highlights.
TEST(DynamicImage, HighlightsCostNothingWhereThereAreNone) {
  Scene scene = make_floor_and_ball();
  World world(scene);
  Lights lights = make_lights(world);
  VisibilityPass visibility(world, lights);
  EXPECT_FALSE(visibility.any_gloss());
  DynamicImage image;
  const DynamicLights from{{lamp({1, 2, 0.5f})}};
  compute_dynamic_light(world, lights, visibility, view_of(scene, 96, 64), from, {}, image);
  EXPECT_TRUE(image.surfaces.gloss.empty());
  EXPECT_TRUE(image.light.gloss_red.empty());
}

// A light that touches a surface is bounded; one at a place or of a strength that is none is not
// seen.
TEST(DynamicImage, HardLightsStayFinite) {
  Scene scene = make_floor_and_ball();
  // Mirrors and polish to the eye: highlights are bounded, too.
  add_mesh(scene, sphere_mesh(add_material(scene, metal(vec3(1), 0)), 0.3f, 64), "mirror",
           at({0.8f, 0.3f, 0.8f}));
  add_mesh(scene, sphere_mesh(add_material(scene, plastic(vec3(0.5f), 1e-40f)), 0.3f, 64), "polish",
           at({-0.8f, 0.3f, 0.8f}));
  View view = view_of(scene, 64, 48);
  const float brightest_lobe = 0.25f / (least_alpha * least_alpha);
  const float most = 3 * brightest_lobe / (least_distance * least_distance);
  for (vec3 place : {vec3(0.3f, 0, 1), vec3(0, 1, 0), vec3(0, 0.5f, 0), vec3(view.position),
                     vec3(1e7f, 1e7f, 0), vec3(1e-40f), vec3(NAN, 0, 0), vec3(INFINITY, 0, 0)})
    for (float strength : {1.0f, 0.0f, 1e-42f}) {
      auto picture = draw_dynamic(scene, view, {{lamp(place, strength * vec3(3, 2, 1))}});
      for (vec3 color : picture) {
        ASSERT_TRUE(is_finite(color)) << place.x;
        ASSERT_GE(std::min({color.x, color.y, color.z}), 0);
        ASSERT_LE(max_component(color), most);
      }
    }
}

// A world far from zero, and a view that grazes its floor.
TEST(DynamicImage, GrazingFloorsAreNotTheirOwnShadow) {
  Scene scene = empty_scene();
  add_floor(scene, 0.5f);
  scene.origin = dvec3(1e6, -4e5, 3e6);
  View view = make_view_towards(scene, scene.origin + dvec3(0, 0.02, 10),
                                scene.origin + dvec3(0, 0, -10), {0, 1, 0}, 0.6f, 96, 64);
  DynamicLight one{lamp({0, 3, -4}, vec3(300))};
  EXPECT_EQ(
      count_wrong(draw_dynamic(scene, view, {one}), trace_direct_light(scene, view, {one}), 0.02f),
      0);
}

// In half of the resolution light is that of the same surface.
TEST(DynamicImage, LargePicturesKeepLightWithinItsSurface) {
  Scene scene = make_floor_and_ball();
  const int width = 801, height = 603;
  View view = view_of(scene, width, height);
  ASSERT_LT(dynamic_light_view(view).width, width);
  DynamicLight one{lamp({1, 2, 0.5f})};
  auto picture = draw_dynamic(scene, view, {one}), truth = trace_direct_light(scene, view, {one});
  // Shadows' edges are a pixel or two of the light wide, and nothing else differs.
  EXPECT_LT(count_wrong(picture, truth, 0.05f), width * height / 100);
  EXPECT_LT(count_wrong(picture, truth, 0.25f), width * height / 150);
}

// The same by what was found once of a picture at rest, but for reflectances of eight bits.
TEST(BackdropSurfaces, ReflectWhatPicturesShow) {
  Scene scene = make_floor_and_ball();
  World world(scene);
  Lights lights = make_lights(world);
  VisibilityPass visibility(world, lights);
  const DynamicLights from{{lamp({1, 2, 0.5f})}};
  for (ivec2 size : {ivec2(96, 64), ivec2(801, 603)}) {
    View view = view_of(scene, size.x, size.y);
    BackdropSurfaces backdrop;
    find_backdrop_surfaces(visibility, view, backdrop);
    EXPECT_EQ(backdrop.shares.empty(), size.x < 100);
    SplatSettings direct_alone;
    direct_alone.virtual_lights = 0;
    DynamicBounce bounce;
    LightPlanes light;
    light_surfaces(world, lights, from, backdrop.surfaces, direct_alone, bounce, light);
    std::vector<vec3> picture;
    for (int y = 0; y < size.y; y++)
      for (int x = 0; x < size.x; x += 32) {
        RunKnown reflected;
        const int count = std::min(32, size.x - x);
        reflect_light(backdrop, light, x, y, count, reflected);
        for (int i = 0; i < count; i++)
          picture.push_back({reflected.red[i], reflected.green[i], reflected.blue[i]});
      }
    EXPECT_LT(count_wrong(picture, draw_dynamic(scene, view, from), 0.02f), size.x * size.y / 200);
  }
}

}  // namespace
