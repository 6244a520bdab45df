// SPDX-License-Identifier: Apache-2.0
// A drawn picture sees what rays see: surfaces, reflectances and what emits, through panes too.
#include "light/visible/visibility.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/rng.h"
#include "scenes/lit_world.h"

namespace wellspring::test {
namespace {

using namespace scenes;

Image checks(int size, bool srgb) {
  Image image{.width = size, .height = size, .srgb = srgb};
  for (int y = 0; y < size; y++)
    for (int x = 0; x < size; x++) {
      bool white = (x / 4 + y / 4) % 2;
      for (uint8_t c : {white ? 230 : 40, white ? 200 : 90, 120, 255}) image.texels8.push_back(c);
    }
  return image;
}

struct Drawn {
  std::vector<PrimaryHit> seen;
  std::vector<vec3> reflectance, normal;
  std::vector<uint8_t> told;
  std::vector<uint32_t> object;
  std::vector<float> depth;
};

Drawn draw(const VisibilityPass& visibility, const View& view) {
  size_t pixels = size_t(view.width) * size_t(view.height);
  Drawn d{std::vector<PrimaryHit>(pixels), std::vector<vec3>(pixels),
          std::vector<vec3>(pixels),       std::vector<uint8_t>(pixels),
          std::vector<uint32_t>(pixels),   std::vector<float>(pixels)};
  visibility.see(view, vec2(0.5f), [&](const VisibleRun& run) {
    size_t first = size_t(run.y) * size_t(view.width) + size_t(run.x);
    RunSurface r;
    uint64_t alone = run.describe(~uint64_t(0), r);
    for (int i = 0; i < run.count; i++) {
      d.seen[first + size_t(i)] = run.see(i);
      bool told = !(alone >> i & 1);
      d.told[first + size_t(i)] = told;
      d.reflectance[first + size_t(i)] =
          told ? vec3(r.red[i], r.green[i], r.blue[i]) : run.see(i).albedo;
      d.normal[first + size_t(i)] = told ? vec3(r.nx[i], r.ny[i], r.nz[i]) : run.see(i).normal;
      d.object[first + size_t(i)] = run.object[i];
      d.depth[first + size_t(i)] = run.depth[i];
    }
  });
  return d;
}

std::vector<PrimaryHit> trace_picture(const World& world, const Lights& lights, const View& view) {
  std::vector<Ray> rays;
  for (int y = 0; y < view.height; y++)
    for (int x = 0; x < view.width; x++)
      rays.push_back(view_ray(view, float(x) + 0.5f, float(y) + 0.5f));
  std::vector<PrimaryHit> seen(rays.size());
  see(world, lights, rays, seen);
  return seen;
}

// A shelf of everything: Lambertian, gloss, soft and sharp metal, textures near and repeated,
// colours of corners, a lamp, an unlit sign, a pane before half of it, coloured glass, sky beside
// it.
Scene make_shelf() {
  Scene scene = empty_scene();
  scene.environment.radiance = vec3(0.2f, 0.4f, 0.9f);
  std::vector<Material> materials(10);
  for (Material& m : materials) m = plastic(vec3(0.6f, 0.3f, 0.2f), 0.5f);
  materials[1].base_color_texture.texture = add_texture(scene, checks(16, true));
  materials[2] = metal(vec3(0.9f, 0.7f, 0.2f), 0.6f);
  materials[3] = metal(vec3(0.9f, 0.7f, 0.2f), 0.1f);
  materials[4] = materials[1];
  materials[4].base_color_texture.uv_transform[0].x = 0.5f;
  materials[5].metallic = 0.5f;
  materials[5].metallic_roughness_texture.texture = add_texture(scene, checks(16, false));
  materials[6] = emitter(vec3(3, 2, 1));
  materials[7].unlit = true;
  materials[8].base_color = vec4(1);
  materials[9] = glass(1.5f, 0, 0);
  materials[9].base_color_texture.texture = materials[1].base_color_texture.texture;
  for (int i = 0; i < 10; i++) {
    int material = add_material(scene, materials[size_t(i)]);
    int made =
        add_quad(scene, material,
                 {-2 + 0.8f * float(i % 5), -0.8f + 0.8f * float(i / 5), -3 - 0.1f * float(i)},
                 {0.75f, 0, 0.2f}, {0, 0.75f, 0});
    if (i == 8)
      scene.meshes[size_t(scene.instances[size_t(made)].mesh)].colors = {
          vec4(1, 0, 0, 1), vec4(0, 1, 0, 1), vec4(0, 0, 1, 1), vec4(1)};
  }
  Material window = glass(1.5f, 0, 0);
  window.emission = vec3(0.5f, 1, 2);
  add_quad(scene, window, {1.2f, -0.8f, -2.2f}, {0.5f, 0, 0}, {0, 0.9f, 0});
  add_quad(scene, glass(1.5f, 0, 0), {-2, -0.5f, -2}, {2, 0, 0.1f}, {0, 0.6f, 0});
  add_sphere(scene, diffuse(vec3(0.3f, 0.8f, 0.5f)), 0.3f, "ball", at({0.4f, 0.1f, -2}));
  return scene;
}

TEST(SeePicture, SeesWhatRaysSee) {
  auto [scene, world, lights] = LitWorld(make_shelf());
  VisibilityPass visibility(world, lights);
  for (vec2 middle : {vec2(0), vec2(-0.1f, -0.08f)}) {
    View view = make_view(scene, {0, 0.1, 0}, 0, 0, 0.7f, 241, 160);
    view.middle = middle;
    ASSERT_TRUE(visibility.rasterises(view));
    Drawn drawn = draw(visibility, view);
    std::vector<PrimaryHit> traced = trace_picture(world, lights, view);
    int told = 0, edges = 0, emitting = 0, tinted = 0, dark = 0, sky = 0;
    for (size_t i = 0; i < traced.size(); i++) {
      const PrimaryHit &a = drawn.seen[i], &b = traced[i];
      if (a.object != b.object) {  // an edge runs within a hair of the pixel's centre
        edges++;
        continue;
      }
      EXPECT_EQ(a.scatters, b.scatters) << i;
      if (std::isinf(b.distance)) {
        EXPECT_TRUE(std::isinf(a.distance));
        sky++;
      } else {
        EXPECT_NEAR(a.distance, b.distance, 1e-4f * b.distance) << i;
        EXPECT_GT(dot(a.normal, b.normal), 0.999f) << i;
      }
      // A pane's tint is that of another place of it, at most a tile away.
      EXPECT_LT(glm::length(a.albedo - b.albedo), 0.03f) << i << " object " << a.object;
      EXPECT_LT(glm::length(a.glow - b.glow), 0.03f * (1 + glm::length(b.glow))) << i;
      EXPECT_LT(glm::length(drawn.reflectance[i] - a.albedo), 0.02f) << i << " object " << a.object;
      EXPECT_GT(dot(glm::normalize(drawn.normal[i]), a.normal), 0.9999f) << i;
      EXPECT_TRUE(!drawn.told[i] || (a.scatters && a.glow == vec3(0))) << i;
      told += drawn.told[i];
      emitting += a.glow.x > 1, dark += a.albedo == vec3(0) && a.object != 0;
      tinted += a.object == 1 && a.albedo.x < 0.97f * 0.6f;
    }
    EXPECT_LT(edges, 40);
    EXPECT_GT(told, 5000);
    EXPECT_GT(emitting, 100);
    EXPECT_GT(dark, 100);  // the sharp metal
    EXPECT_GT(tinted, 100);
    EXPECT_GT(sky, 1000);
  }
}

// Small triangles of one material share look-ups, each with its own place in the picture; others
// beside them, and levels, keep theirs.
TEST(SeePicture, SmallTrianglesSideBySideKeepTheirReflectance) {
  Scene scene = empty_scene();
  Material textured = diffuse(vec3(1)), shiny = plastic(vec3(0.6f, 0.3f, 0.2f), 0.5f);
  textured.base_color_texture.texture = add_texture(scene, checks(64, true));
  shiny.metallic = 0.5f;
  shiny.metallic_roughness_texture.texture = add_texture(scene, checks(16, false));
  Material both = shiny;
  both.base_color_texture = textured.base_color_texture;
  const int materials[] = {add_material(scene, textured), add_material(scene, textured),
                           add_material(scene, both), add_material(scene, shiny),
                           add_material(scene, diffuse(vec3(0.2f, 0.5f, 0.7f)))};
  Rng rng(5);
  constexpr int across = 50, down = 10;
  for (int y = 0; y < down; y++)
    for (int x = 0; x < across; x++) {
      int made =
          add_quad(scene, materials[rng.next() % 5],
                   {0.04f * float(x) - 1, 0.1f * float(y) - 0.5f, -2}, {0.04f, 0, 0}, {0, 0.1f, 0});
      float turns = rng.next() % 3 == 0 ? 0.5f : 0.05f;
      vec2 from(float(rng.next() % 64) / 64, float(rng.next() % 64) / 64);
      for (vec2& uv : scene.meshes[size_t(scene.instances[size_t(made)].mesh)].uv[0])
        uv = from + uv * turns;
    }
  World world(scene);
  VisibilityPass visibility(world, make_lights(world));
  Drawn drawn = draw(visibility, make_view(scene, {0, 0, 0}, 0, 0, 0.55f, 150, 84));
  double off = 0;
  for (size_t i = 0; i < drawn.seen.size(); i++) {
    float differs = glm::length(drawn.reflectance[i] - drawn.seen[i].albedo);
    ASSERT_LT(differs, 0.1f) << i;  // levels are read bilinear in roots
    off += double(differs) / double(drawn.seen.size());
  }
  EXPECT_LT(off, 0.004);
}

TEST(SeePicture, DepthIsAlongTheViewingAxis) {
  Scene scene = empty_scene();
  add_wall(scene, diffuse(vec3(0.5f)), -3, 9, "quad");
  World world(scene);
  Lights lights = make_lights(world);
  VisibilityPass visibility(world, lights);
  Drawn drawn = draw(visibility, make_view(scene, {0, 0, 0}, 0, 0, 1.2f, 64, 48));
  for (float depth : drawn.depth) EXPECT_NEAR(depth, 3, 1e-5f);
}

// Far away a picture becomes its mean, of light and not of codes, and does not sparkle as the eye
// moves.
TEST(SeePicture, PicturesFarAwayAreTheirMean) {
  Scene scene = empty_scene();
  Material m = diffuse(vec3(1));
  m.base_color_texture.texture = add_texture(scene, checks(64, true));
  int made = add_wall(scene, m, -10, 6, "quad");
  for (vec2& uv : scene.meshes[size_t(scene.instances[size_t(made)].mesh)].uv[0]) uv *= 40.0f;
  World world(scene);
  Lights lights = make_lights(world);
  VisibilityPass visibility(world, lights);
  float mean = 0.5f * (decode_srgb(230) + decode_srgb(40));
  for (float x : {0.0f, 0.0137f}) {
    Drawn drawn = draw(visibility, make_view(scene, {double(x), 0, 0}, 0, 0, 1, 64, 64));
    for (size_t i = 0; i < drawn.seen.size(); i++) {
      ASSERT_NEAR(drawn.seen[i].albedo.x, mean, 0.02f);
      ASSERT_NEAR(drawn.reflectance[i].x, mean, 0.02f);
    }
  }
}

// Every pixel once, and of each what a ray sees; there are no edges.
TEST(SeePicture, AnEyeInSolidGlassIsServedByRays) {
  Scene scene = empty_scene();
  scene.environment.radiance = vec3(1, 2, 3);
  add_sphere(scene, glass(1.5f, 0, 1), 1, "ball");
  add_wall(scene, emitter(vec3(5)), -0.5f, 0.2f, "within");
  World world(scene);
  Lights lights = make_lights(world);
  VisibilityPass visibility(world, lights);
  EXPECT_TRUE(visibility.rasterises(make_view(scene, {0, 0, 2}, 0, 0, 1, 8, 8)));
  View view = make_view(scene, {0, 0, 0}, 0.3f, 0.1f, 1, 75, 20);
  ASSERT_FALSE(visibility.rasterises(view));
  vec2 offset(0.3f, 0.8f);
  std::vector<int> calls(75 * 20, 0), lamp = calls;
  auto edges = visibility.see_edges(view, offset, [&](const VisibleRun& run) {
    RunSurface surface;
    uint64_t all = run.count < 64 ? (uint64_t(1) << run.count) - 1 : ~uint64_t(0);
    EXPECT_EQ(run.describe(all, surface), all);  // only see() knows
    for (int i = 0; i < run.count; i++) {
      Ray ray = view_ray(view, float(run.x + i) + offset.x, float(run.y) + offset.y);
      PrimaryHit seen, drawn = run.see(i);
      see(world, lights, std::span(&ray, 1), std::span(&seen, 1));
      size_t pixel = size_t(run.y * 75 + run.x + i);
      calls[pixel]++;
      lamp[pixel] = drawn.glow != vec3(0);
      EXPECT_EQ(run.object[i], seen.object);
      EXPECT_EQ(drawn.distance, seen.distance);
      EXPECT_EQ(drawn.glow, seen.glow);
      EXPECT_NEAR(run.depth[i], seen.distance * dot(ray.direction, view.forward), 1e-5f);
    }
  });
  EXPECT_TRUE(edges.empty());
  for (int count : calls) ASSERT_EQ(count, 1);
  EXPECT_GT(std::count(lamp.begin(), lamp.end(), 1), 100);
  EXPECT_LT(std::count(lamp.begin(), lamp.end(), 1), 75 * 20 / 2);
  int moving = 0;
  visibility.see(
      view, offset, [&](const VisibleRun&) { moving++; }, RasterShows::moving);
  EXPECT_EQ(moving, 0);
}

}  // namespace
}  // namespace wellspring::test
