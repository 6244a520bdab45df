// SPDX-License-Identifier: Apache-2.0
// Metals whose textures cross what tells soft gloss from sharp, and metal from paint.
#include <gtest/gtest.h>

#include <cmath>

#include "unit/picture/drawn_visit.h"

namespace wellspring::test {
namespace {

using namespace scenes;

constexpr int size = 96;

// A golden board under an even sky. Roughness and metallic are those of squares two texels wide,
// in turns: at 96 pixels about one and a half of these.
Scene make_board(vec2 roughness, vec2 metallic) {
  Scene scene = empty_scene();
  scene.environment.radiance = vec3(1);
  Image image{.width = 64, .height = 64, .srgb = false};
  auto level = [](float value) { return uint8_t(value * 255 + 0.5f); };
  for (int i = 0; i < 64 * 64; i++) {
    int odd = (i / 2 + i / 128) % 2;
    for (uint8_t c : {uint8_t(0), level(roughness[odd]), level(metallic[odd]), uint8_t(255)})
      image.texels8.push_back(c);
  }
  Material board = diffuse({0.8f, 0.6f, 0.2f});
  board.metallic = board.roughness = 1;
  board.metallic_roughness_texture.texture = add_texture(scene, image);
  add_wall(scene, board, -4, 1, "board");
  return scene;
}

struct Error {
  float mean = 0, spread = 0;  // signed, and root mean square; over what is wanted
};
Error compare(const Frame& frame, const Frame& truth) {
  double sum = 0, sum2 = 0, wanted = 0;
  int count = 0;
  for (int y = size / 4; y < 3 * size / 4; y++)
    for (int x = size / 4; x < 3 * size / 4; x++) {
      size_t i = size_t(y * size + x);
      double off = double(frame.color[i].x) - double(truth.color[i].x);
      sum += off, sum2 += off * off, wanted += double(truth.color[i].x);
      count++;
    }
  return {float(sum / wanted), float(std::sqrt(sum2 * count) / wanted)};
}

// `most`: of Error::spread.
void expect_board(Scene scene, float most) {
  Stage stage(std::move(scene));
  View view = make_view(stage.scene, {0, 0, 0}, 0, 0, 2 * std::atan(0.3f), size, size);
  Frame truth = stage.truth(view, 256);
  for (PictureOf kind : {PictureOf::moving, PictureOf::still}) {
    DrawnVisit visit;
    for (int i = 0; i < 24; i++) visit.step(stage, view, size * size / 16, kind);
    Error error = compare(visit.frame, truth);
    EXPECT_LT(std::abs(error.mean), 0.03f) << "picture " << int(kind);
    EXPECT_LT(error.spread, most) << "picture " << int(kind);
  }
}

// All of it reflects the same light, whatever side of a threshold its texels are on.
TEST(Metal, LightIsContinuousAcrossRoughness) {
  expect_board(make_board({0.3f, 0.4f}, vec2(1)), 0.1f);
}
TEST(Metal, LightIsContinuousAcrossMetallic) {
  expect_board(make_board(vec2(0.5f), {1, 0.98f}), 0.1f);
}
// One material is part metal, part paint, as compression leaves it.
TEST(Metal, LightIsContinuousBesidePaint) {
  Scene scene = make_board({0.3f, 0.4f}, {0.97f, 1});
  for (size_t i = 0; i < 4 * 64 * 8; i += 4) scene.images.back().texels8[i + 2] = 0;
  expect_board(std::move(scene), 0.2f);
}

// Samples and drawn pictures keep the same reflectance.
TEST(Metal, HasOneReflectanceInSamplesAndDrawnPictures) {
  for (vec2 metallic : {vec2(1), vec2(0.9f, 1), vec2(0, 1), vec2(0.3f, 0.3f)})
    for (vec2 roughness : {vec2(0.05f, 0.1f), vec2(0.25f, 0.3f), vec2(0.5f, 0.9f)}) {
      Stage stage(make_board(roughness, metallic));
      View view = make_view(stage.scene, {0, 0, 0}, 0, 0, 0.06f, 48, 48);  // texels are large
      std::vector<vec3> drawn(48 * 48);
      stage.visibility->see(view, vec2(0.5f), [&](const VisibleRun& run) {
        RunSurface r;
        ASSERT_EQ(run.describe(~uint64_t(0), r), 0u);
        for (int i = 0; i < run.count; i++)
          drawn[size_t(run.y * 48 + run.x + i)] = {r.red[i], r.green[i], r.blue[i]};
      });
      for (const char* technique : {"path", "instant_radiosity"})
        for (int k = 0; k < 48 * 48; k += 97) {
          Request request = pixel_request(view, 1, k % 48, k / 48, 0);
          request.ray = view_ray(view, float(k % 48) + 0.5f, float(k / 48) + 0.5f);
          std::vector<Request> requests{request};
          std::vector<Sample> samples(1);
          std::vector<Ray> rays{request.ray};
          std::vector<PrimaryHit> seen(1);
          see(*stage.world, stage.lights, rays, seen);
          EXPECT_LT(glm::length(seen[0].albedo - drawn[size_t(k)]), 0.02f);
          const Technique& way = *find_technique(technique);
          if (way.begin_pass) way.begin_pass(*stage.world, {}, view, 1, 1, stage.lights);
          trace(way, *stage.world, stage.lights, {}, requests, samples);
          EXPECT_LT(glm::length(samples[0].albedo - seen[0].albedo), 1e-4f)
              << technique << " " << metallic.x << " " << roughness.x;
        }
    }
}

}  // namespace
}  // namespace wellspring::test
