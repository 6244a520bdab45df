// SPDX-License-Identifier: Apache-2.0
// The published networks, where the launcher has installed their weights.
#include "denoise/denoise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "denoise/tile.h"

namespace wellspring::test {
namespace {

struct Picture {
  int width = 0, height = 0;
  std::vector<vec3> color, albedo, normal;
  Picture(int w, int h) : width(w), height(h) {
    color.resize(size_t(w) * size_t(h), vec3(0));
    albedo.resize(color.size(), vec3(0.5f));
    normal.resize(color.size(), vec3(0, 0, 1));
  }
  DenoiseInput input(float scale = 0) const {
    return {width, height, color, albedo, normal, scale};
  }
};

std::unique_ptr<Denoiser> load(NetSize size) {
  std::string problem;
  auto denoiser = load_denoiser(size, problem, WELLSPRING_WEIGHTS_FOLDER);
  if (!denoiser) std::cerr << "skipped: " << problem << "\n";
  return denoiser;
}

std::vector<vec3> run(Denoiser& denoiser, const Picture& picture, float scale = 0) {
  std::vector<vec3> color(picture.color.size());
  denoiser.run(picture.input(scale), color);
  return color;
}

bool usable(const std::vector<vec3>& picture) {
  for (vec3 c : picture)
    for (int k = 0; k < 3; k++)
      if (!std::isfinite(c[k]) || c[k] < 0) return false;
  return true;
}

// Mean relative difference of a picture to a level.
double error_to(const std::vector<vec3>& picture, const std::function<float(size_t)>& level) {
  double sum = 0;
  for (size_t i = 0; i < picture.size(); i++)
    sum += std::abs(double(luminance(picture[i])) / double(level(i)) - 1);
  return sum / double(picture.size());
}

// Exponentially distributed light around a level: noise as of few samples.
void add_noise(Picture& picture, const std::function<float(size_t)>& level) {
  std::mt19937 random(5);
  std::exponential_distribution<float> light(1);
  for (size_t i = 0; i < picture.color.size(); i++)
    picture.color[i] = vec3(level(i) * light(random));
}

TEST(Transfer, IsItsInverseAndGrows) {
  float before = -1;
  for (float y = 1e-9f; y < 6e4f; y *= 1.3f) {
    float x = encode_radiance(y);
    EXPECT_GT(x, before) << y;
    before = x;
    EXPECT_NEAR(decode_radiance(x), y, 2e-4f * y) << y;
  }
  EXPECT_FLOAT_EQ(encode_radiance(65504), 1);
  EXPECT_EQ(encode_radiance(1e30f), 1);
  EXPECT_EQ(encode_radiance(NAN), 0);
  EXPECT_EQ(encode_radiance(-1), 0);
  EXPECT_EQ(decode_radiance(NAN), 0);
  // Its pieces meet.
  for (float y : {transfer::y0, transfer::y1})
    EXPECT_NEAR(encode_radiance(y * 0.9999f), encode_radiance(y * 1.0001f), 1e-3f);
}

TEST(InputScale, BringsTheGeometricMeanToMiddleGrey) {
  Picture picture(64, 32);
  for (size_t i = 0; i < picture.color.size(); i++)
    picture.color[i] = vec3(i % 64 < 32 ? 0.01f : 100.0f);
  EXPECT_NEAR(input_scale(64, 32, picture.color), 0.18f, 1e-4f);  // sqrt(0.01 * 100) is 1
  for (vec3& c : picture.color) c *= 1e4f;
  EXPECT_NEAR(input_scale(64, 32, picture.color), 0.18e-4f, 1e-8f);
  EXPECT_EQ(input_scale(64, 32, std::vector<vec3>(64 * 32, vec3(0))), 1);
  EXPECT_EQ(input_scale(64, 32, std::vector<vec3>(64 * 32, vec3(NAN))), 1);
  picture.color[5] = vec3(INFINITY);
  EXPECT_TRUE(std::isfinite(input_scale(64, 32, picture.color)));
}

class Networks : public testing::TestWithParam<NetSize> {
 protected:
  void SetUp() override {
    denoiser = load(GetParam());
    if (!denoiser) GTEST_SKIP() << "its weights are not installed, or there is no AVX2";
  }
  std::unique_ptr<Denoiser> denoiser;
};

TEST_P(Networks, TakeNoiseAwayAndKeepLevelAndEdges) {
  Picture picture(192, 96);
  auto level = [](size_t i) { return i % 192 < 96 ? 0.2f : 1.5f; };
  for (size_t i = 0; i < picture.color.size(); i++)
    if (i % 192 >= 96) picture.normal[i] = vec3(1, 0, 0);
  add_noise(picture, level);
  std::vector<vec3> clean = run(*denoiser, picture);
  EXPECT_TRUE(usable(clean));
  EXPECT_GT(error_to(picture.color, level), 0.7);
  EXPECT_LT(error_to(clean, level), 0.08);
}

TEST_P(Networks, AreTheSameWhateverTheUnitOfLight) {
  Picture dim(96, 64);
  add_noise(dim, [](size_t i) { return 0.05f + float(i % 96) / 96; });
  Picture bright = dim;
  for (vec3& c : bright.color) c *= 1000.0f;
  std::vector<vec3> a = run(*denoiser, dim), b = run(*denoiser, bright);
  for (size_t i = 0; i < a.size(); i++)
    ASSERT_NEAR(a[i].x, b[i].x / 1000, 1e-3f + 0.01f * a[i].x) << i;
}

TEST_P(Networks, KeepTextureThatAlbedoTells) {
  Picture picture(128, 128);
  for (size_t i = 0; i < picture.color.size(); i++)
    picture.albedo[i] = vec3((i % 128 / 4 + i / 128 / 4) % 2 ? 0.8f : 0.2f);  // a fine chequer
  add_noise(picture, [&](size_t i) { return 0.5f * picture.albedo[i].x; });
  std::vector<vec3> clean = run(*denoiser, picture);
  double dark = 0, bright = 0, count = 0;
  for (size_t i = 0; i < clean.size(); i++)
    (picture.albedo[i].x > 0.5f ? bright : dark) += double(clean[i].x), count += 0.5;
  EXPECT_NEAR(dark / count, 0.1, 0.03);
  EXPECT_NEAR(bright / count, 0.4, 0.06);
}

TEST_P(Networks, LiveThroughHardInputs) {
  struct Case {
    const char* what;
    int width, height;
    std::function<vec3(size_t)> color;
  };
  const Case cases[] = {
      {"one pixel", 1, 1, [](size_t) { return vec3(3); }},
      {"one row", 37, 1, [](size_t i) { return vec3(float(i)); }},
      {"one column", 1, 53, [](size_t i) { return vec3(float(i)); }},
      {"black", 40, 30, [](size_t) { return vec3(0); }},
      {"10^4 beside 0", 50, 50, [](size_t i) { return vec3(i % 7 ? 0.0f : 1e4f); }},
      {"one spark in black", 64, 64, [](size_t i) { return vec3(i == 2000 ? 1e30f : 0.0f); }},
      {"not a number", 33, 47, [](size_t i) { return vec3(i % 3 ? 0.5f : NAN); }},
      {"infinite", 33, 47, [](size_t i) { return vec3(i % 3 ? 0.5f : INFINITY); }},
      {"negative", 33, 47, [](size_t i) { return vec3(i % 3 ? 0.5f : -2.0f); }},
      {"denormal", 40, 40, [](size_t i) { return vec3(1e-41f * float(i % 5)); }},
  };
  for (const Case& one : cases) {
    SCOPED_TRACE(one.what);
    Picture picture(one.width, one.height);
    for (size_t i = 0; i < picture.color.size(); i++) {
      picture.color[i] = one.color(i);
      if (i % 11 == 0) picture.albedo[i] = vec3(NAN), picture.normal[i] = vec3(INFINITY, 0, NAN);
    }
    EXPECT_TRUE(usable(run(*denoiser, picture)));
  }
}

TEST_P(Networks, LeaveWhatHasNoNoise) {
  Picture picture(96, 96);
  for (size_t i = 0; i < picture.color.size(); i++)
    picture.color[i] = vec3(0.3f + 0.4f * float(i % 96) / 96);
  std::vector<vec3> clean = run(*denoiser, picture);
  EXPECT_LT(error_to(clean, [&](size_t i) { return picture.color[i].x; }), 0.03);
}

INSTANTIATE_TEST_SUITE_P(Sizes, Networks,
                         testing::Values(NetSize::small, NetSize::base, NetSize::large),
                         [](const auto& info) { return net_name(info.param); });

TEST(Denoiser, NeedsLittleMemory) {
  auto denoiser = load(NetSize::small);
  if (!denoiser) GTEST_SKIP() << "its weights are not installed, or there is no AVX2";
  Picture picture(1280, 720);
  for (size_t i = 0; i < picture.color.size(); i++) picture.color[i] = vec3(float(i % 1280));
  denoiser->start(picture.input());
  denoiser->advance(0);
  EXPECT_LT(denoiser->memory_bytes(), 200u << 20);
}

TEST(Denoiser, SaysWhyThereIsNone) {
  std::string problem;
  EXPECT_EQ(load_denoiser(NetSize::base, problem, "/nowhere"), nullptr);
  EXPECT_NE(problem.find(unet_problem() ? unet_problem() : "not installed"), std::string::npos)
      << problem;
  EXPECT_EQ(find_net_size("base"), NetSize::base);
  EXPECT_FALSE(find_net_size("huge"));
}

}  // namespace
}  // namespace wellspring::test
