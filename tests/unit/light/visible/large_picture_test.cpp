// SPDX-License-Identifier: Apache-2.0
// Very large pictures on walls: drawn and traced alike, at the level of detail that a pixel sees,
// also behind glass, in a mirror and at a slant.
#include <gtest/gtest.h>

#include <cmath>

#include "light/visible/guides.h"
#include "light/visible/visibility.h"
#include "scenes/lit_world.h"
#include "unit/store/address_picture.h"
#include "world/large_texture.h"

namespace wellspring::test {
namespace {

using namespace scenes;

constexpr int64_t side = int64_t(1) << 20;
constexpr float wall = 2;  // metres

Material pictured(Scene& scene) {
  auto large =
      std::make_shared<LargePicture>(shared_store(), std::make_shared<AddressPicture>(side, side));
  Image image{.width = large->coarsest.width, .height = large->coarsest.height, .srgb = true};
  image.texels8 = large->coarsest.bytes;
  image.large = large;
  Material material = diffuse(vec3(1));
  material.base_color_texture.texture = add_texture(scene, image);
  material.large_picture = true;
  return material;
}

// A picture of `wall` metres a side at z = 0, and what else there is.
LitWorld gallery(const std::function<void(Scene&)>& more = {}) {
  Scene scene = empty_scene();
  add_wall(scene, pictured(scene), 0, wall / 2);
  if (more) more(scene);
  scene.environment.radiance = vec3(1);
  return LitWorld(std::move(scene));
}

View view_from(const Scene& scene, dvec3 eye, dvec3 target, int size = 64) {
  return make_view_towards(scene, eye, target, {0, 1, 0}, 0.5f, size, size);
}

// Returns what is in red where `texels` fall on a pixel.
float red_of(double texels) {
  const double level = std::max(std::log2(texels), 0.0);
  const size_t low = size_t(level);
  return glm::mix(srgb_table[low], srgb_table[low + 1], float(level - double(low)));
}

double texels_a_pixel(const View& view, double distance) {
  const double pixel = 2 * double(view.tan_half_fov) / view.height * distance;
  return pixel * double(side) / double(wall);
}

std::vector<vec3> drawn(const LitWorld& lit, const View& view) {
  std::vector<vec3> colors(size_t(view.width) * size_t(view.height));
  VisibilityPass(lit.world, lit.lights).see(view, vec2(0.5f), [&](const VisibleRun& run) {
    RunSurface surface;
    const uint64_t alone = run.describe(~uint64_t(0) >> (64 - run.count), surface);
    for (int i = 0; i < run.count; i++)
      colors[size_t(run.y) * size_t(view.width) + size_t(run.x + i)] =
          alone >> i & 1 ? run.see(i).albedo
                         : vec3(surface.red[i], surface.green[i], surface.blue[i]);
  });
  return colors;
}

// Calls check(drawn, traced) for every pixel, when the pieces are there.
template <class Check>
void compare(const LitWorld& lit, const View& view, const Check& check) {
  fetch_pieces(lit.world, lit.lights, view);
  const std::vector<vec3> raster = drawn(lit, view);
  for (int y = 0; y < view.height; y++)
    for (int x = 0; x < view.width; x++) {
      const Ray ray = view_ray(view, float(x) + 0.5f, float(y) + 0.5f);
      Guide guide;
      eval_guides(lit.world, lit.lights, std::span(&ray, 1), std::span(&guide, 1));
      check(raster[size_t(y) * size_t(view.width) + size_t(x)], guide.albedo);
    }
}

TEST(LargePicture, IsSeenAtTheLevelOfItsPixelsFromEveryDistance) {
  const LitWorld lit = gallery();
  for (double distance : {0.002, 0.013, 0.11, 0.9, 2.5}) {
    const View view = view_from(lit.scene, {0.2, 0.1, distance}, {0.2, 0.1, 0});
    const float expected = red_of(texels_a_pixel(view, distance));
    compare(lit, view, [&](vec3 raster, vec3 ray) {
      EXPECT_NEAR(raster.x, expected, 0.002f) << distance;
      EXPECT_NEAR(raster.x, ray.x, 0.002f) << distance;
    });
  }
}

TEST(LargePicture, IsReadAlongItsSlantUpToSixteenTimes) {
  const LitWorld lit = gallery();
  // Eight times as many texels fall on a pixel upwards as sidewards: the sixteen taps show them.
  const double slope = std::asin(1 / 8.0), distance = 0.5;
  const View view = view_from(
      lit.scene, {0, -distance * std::cos(slope), distance * std::sin(slope)}, {0, 0, 0}, 512);
  const float expected = red_of(texels_a_pixel(view, distance));
  fetch_pieces(lit.world, lit.lights, view);
  const vec3 middle = drawn(lit, view)[size_t(256 * 512 + 256)];
  EXPECT_NEAR(middle.x, expected, 0.08f * expected);
}

TEST(LargePicture, IsAsSharpBehindGlass) {
  const LitWorld bare = gallery(),
                 glazed =
                     gallery([](Scene&scene) { add_wall(scene, glass(1.5f, 0, 0), 0.05f, 2); });
  const View view = view_from(bare.scene, {0.2, 0.1, 0.4}, {0.2, 0.1, 0}, 16);
  fetch_pieces(bare.world, bare.lights, view);
  const std::vector<vec3> plain = drawn(bare, view);
  size_t at = 0;
  compare(glazed, view, [&](vec3 raster, vec3) {
    EXPECT_NEAR(raster.x / plain[at++].x, 0.96f, 0.005f);  // the pane's share
  });
}

TEST(LargePicture, IsAsSharpInAMirrorAsThatFarAway) {
  const LitWorld lit = gallery([](Scene& scene) {
    add_quad(scene, metal(vec3(1), 0), {-1, -1, 1}, {0, 2, 0}, {2, 0, 0}, "mirror");
  });
  const View view = view_from(lit.scene, {0.2, 0.1, 0.5}, {0.2, 0.1, 1}, 128);
  const float expected = red_of(texels_a_pixel(view, 1.5));
  compare(lit, view, [&](vec3, vec3 ray) { EXPECT_NEAR(ray.x, expected, 0.01f * expected); });
}

TEST(LargePicture, ATriangleWithoutAreaIsAnswered) {
  const LitWorld lit = gallery();
  PlacedMesh placed = lit.world.placed(0);
  Mesh mesh = *placed.mesh;
  mesh.positions[1] = mesh.positions[0];
  placed.mesh = &mesh;
  const View view = view_from(lit.scene, {0.2, 0.1, 0.4}, {0.2, 0.1, 0}, 16);
  const PicturedTriangle t = make_pictured_triangle(placed, 0, {}, view.position);
  const PictureFootprint f = PixelToTexture(t, view).at(3, 4, 1, {});
  PictureSampler sampler(*shared_store());
  EXPECT_TRUE(is_finite(sampler.look(*lit.scene.images[0].large, f)));
}

}  // namespace
}  // namespace wellspring::test
