// SPDX-License-Identifier: Apache-2.0
// Light from infinity where it is hard to sample: poles, the seam, one bright texel, texels that
// are no numbers, the sun's disc.
#include "light/sample/environment_light.h"

#include <functional>

#include "light/random/warp.h"
#include "light/sample/light_tables.h"
#include "scenes/scenes.h"
#include "unit/light/statistics.h"

namespace wellspring::test {
namespace {

using namespace scenes;

struct Sky {
  Scene scene;
  EnvironmentLight light;
  Sky(int width, int height, const std::function<vec3(int, int)>& texel, SunDisc sun = {}) {
    Image image{.width = width, .height = height};
    for (int y = 0; y < height; y++)
      for (int x = 0; x < width; x++) image.texels.push_back(vec4(texel(x, y), 1));
    scene.images.push_back(std::move(image));
    scene.environment = {vec3(1), 0, sun};
    light = make_environment_light(scene);
  }
};

// The sphere cut into rows of equal height and columns: counts of samples against the integral of
// the density, and luminance by sampling against luminance by quadrature.
void expect_sampled(const EnvironmentLight& sky, const char* what, int fine = 96) {
  constexpr int rows = 10, columns = 16, count = 40000;
  std::vector<double> counts(rows * columns), expected(rows * columns);
  auto bin_of = [&](vec3 d) {
    float phi = std::atan2(d.z, d.x) + pi;
    return size_t(std::clamp(int((d.y + 1) / 2 * rows), 0, rows - 1) * columns +
                  std::clamp(int(phi / (2 * pi) * columns), 0, columns - 1));
  };
  Sampler sampler(5);
  Mean light;
  for (int i = 0; i < count; i++) {
    EnvironmentSample s = sample_environment(sky, sampler);
    ASSERT_NEAR(length(s.direction), 1, 1e-5f);
    if (!(s.pdf > 0)) continue;
    ASSERT_NEAR(s.pdf, sample_environment_pdf(sky, s.direction), 2e-3f * s.pdf) << what;
    light.add(double(luminance(eval_environment(sky, s.direction)) / s.pdf));
    counts[bin_of(s.direction)]++;
  }
  double exact = 0, solid = 4 * double(pi) / (double(rows) * columns * fine * fine);
  for (int row = 0; row < rows * fine; row++)
    for (int column = 0; column < columns * fine; column++) {
      float y = 2 * (float(row) + 0.5f) / float(rows * fine) - 1;
      float phi = 2 * pi * (float(column) + 0.5f) / float(columns * fine) - pi;
      float r = std::sqrt(1 - y * y);
      vec3 d(r * std::cos(phi), y, r * std::sin(phi));
      double pdf = double(sample_environment_pdf(sky, d));
      expected[size_t(row / fine * columns + column / fine)] += pdf * solid * count;
      double radiance = double(luminance(eval_environment(sky, d)));
      if (radiance > 0) {
        ASSERT_GT(pdf, 0) << what << ": light that is never found";
      }
      exact += radiance * solid;
    }
  // The density is the same all over a cell of the grid: its integral is a sum over cells.
  double total = 0;
  for (int row = 0; row < sky.rows; row++)
    for (int column = 0; column < sky.columns; column++) {
      auto edge = [&](int i) { return std::cos(double(pi) * i / sky.rows); };
      double theta = double(pi) * (row + 0.5) / sky.rows,
             phi = 2 * double(pi) * (column + 0.5) / sky.columns;
      vec3 d(float(std::sin(theta) * std::sin(phi)), float(std::cos(theta)),
             float(-std::sin(theta) * std::cos(phi)));
      total += double(sample_environment_pdf(sky, d)) * (edge(row) - edge(row + 1)) * 2 *
               double(pi) / sky.columns;
    }
  EXPECT_NEAR(total, 1, 1e-4) << what << ": the density is one in all";
  expect_chi_squared(counts, expected, what);
  EXPECT_NEAR(light.mean(), exact, significance_z * light.error() + 2e-3 * exact) << what;
}

TEST(Environment, PolesAndTheSeam) {
  Sky top(32, 16, [](int, int y) { return y == 0 ? vec3(50) : vec3(0.1f); });
  expect_sampled(top.light, "bright top row");
  Sky bottom(32, 16, [](int, int y) { return y == 15 ? vec3(50) : vec3(0); });
  expect_sampled(bottom.light, "bright bottom row alone");
  Sky seam(32, 16, [](int x, int y) { return x == 0 && y > 4 && y < 12 ? vec3(80) : vec3(0.05f); });
  expect_sampled(seam.light, "bright column at the seam");
  Sky tiny(1, 1, [](int, int) { return vec3(2); });
  expect_sampled(tiny.light, "one texel");
}

TEST(Environment, OneTexelAMillionTimesAsBright) {
  Sky sky(64, 32, [](int x, int y) { return x == 20 && y == 9 ? vec3(1e6f) : vec3(1); });
  expect_sampled(sky.light, "one bright texel");
  Mean light;
  Sampler sampler(9);
  for (int i = 0; i < 2000; i++) {
    EnvironmentSample s = sample_environment(sky.light, sampler);
    light.add(double(luminance(eval_environment(sky.light, s.direction)) / s.pdf));
  }
  // Bilinear filtering leaves no more variation than a texel's slope: without importance the
  // standard deviation of one sample is 45 times the mean.
  EXPECT_LT(light.error() * std::sqrt(2000.0), 1.2 * light.mean());
}

TEST(Environment, TexelsThatAreNoNumbersAreDark) {
  float nan = std::nanf(""), infinity = std::numeric_limits<float>::infinity();
  Sky sky(16, 8, [&](int x, int y) {
    return x == 3 ? vec3(nan) : x == 7 ? vec3(infinity) : x == 9 ? vec3(0) : vec3(1 + y);
  });
  for (const AliasTable::Cell& cell : sky.light.cells.cells)
    ASSERT_TRUE(std::isfinite(cell.probability));
  EXPECT_TRUE(std::isfinite(sky.light.mean_luminance));
  Rng rng(2);
  for (int i = 0; i < 2000; i++) {
    vec3 c = eval_environment(sky.light, sample_sphere({rng.uniform(), rng.uniform()}));
    ASSERT_TRUE(is_finite(c));
    ASSERT_GE(std::min({c.x, c.y, c.z}), 0);
  }
  expect_sampled(sky.light, "broken texels");
  Sky broken(8, 4, [&](int, int) { return vec3(nan); });
  EXPECT_FALSE(broken.light.is_sampled());
}

TEST(Environment, TheSunsDiscIsSampledOverItsSolidAngle) {
  SunDisc sun{normalize(vec3(1, 2, -3)), vec3(2e5f), 0.0046f};
  Sky with_sky(
      32, 16, [](int, int y) { return vec3(y < 8 ? 1.0f : 0.2f); }, sun);
  Sky alone(
      1, 1, [](int, int) { return vec3(0); }, sun);
  double solid = 2 * double(pi) * (1 - std::cos(0.0046));
  for (const Sky* sky : {&with_sky, &alone}) {
    Sampler sampler(4);
    Mean sunlight;
    std::vector<double> counts(16), expected(16);
    vec3 tangent, bitangent;
    make_frame_axes(sun.direction, tangent, bitangent);
    double inside = 0;
    for (int i = 0; i < 20000; i++) {
      EnvironmentSample s = sample_environment(sky->light, sampler);
      vec3 away = s.direction - sun.direction;
      bool in_disc = length(away) < 0.0046f;
      sunlight.add(in_disc && s.pdf > 0
                       ? double(luminance(eval_environment(sky->light, s.direction)) / s.pdf)
                       : 0);
      if (!in_disc) continue;
      inside++;
      float radius = length(away) / 0.0046f,
            angle = std::atan2(dot(away, bitangent), dot(away, tangent));
      int ring = std::min(int(radius * radius * 4), 3);
      int sector = std::clamp(int((angle / pi + 1) * 2), 0, 3);
      counts[size_t(ring * 4 + sector)]++;
    }
    for (double& e : expected) e = inside / 16;
    expect_chi_squared(counts, expected, "the disc");
    expect_mean(sunlight, 2e5 * solid + (sky == &with_sky ? solid : 0), "sunlight", 0.02);
  }
  EXPECT_FLOAT_EQ(alone.light.sun_share, 1);
  EXPECT_EQ(luminance(eval_environment(alone.light, normalize(sun.direction + vec3(0.006f, 0, 0)))),
            0);
}

// The floor under a sun of given irradiance, found by light sampling and by scattering alike.
TEST(Environment, AFloorInTheSunIsAsBrightAsTheCosineSays) {
  Scene scene = empty_scene();
  add_floor(scene, 0.5f);
  float radius = 0.3f;  // large, so that scattering finds it too
  scene.environment.sun = {normalize(vec3(1, 1, 0)), vec3(4), radius};
  World world(scene);
  Lights lights = make_lights(world);
  ASSERT_TRUE(lights.tables->environment.is_sampled());
  // A disc wholly above the horizon: its irradiance is L pi sin^2(radius) times the cosine.
  double expected =
      0.5 / double(pi) * 4 * double(pi) * std::pow(std::sin(double(radius)), 2) * std::sqrt(0.5);
  for (const char* technique : {"path", "direct"}) {
    Mean replicates;
    for (uint64_t seed = 1; seed <= 20; seed++)
      replicates.add(
          trace_mean(technique, world, lights, ray_towards({0, 2, 1}, {0, 0, 0}), 400, {}, seed)
              .mean());
    expect_mean(replicates, expected, technique);
  }
}

TEST(EmissionPicture, PlacesFollowBrightnessAndTheDensityIsExact) {
  auto bright = [](vec2 b) {
    return b.x > 0.3f && b.x < 0.5f && b.y < 0.4f ? 20.0f : b.y > 0.8f ? 0.0f : 0.5f;
  };
  EmissionPicture picture = make_emission_picture(900, bright);
  ASSERT_FALSE(picture.cells.cells.empty());
  constexpr int n = 8, count = 40000;
  auto bin_of = [](vec2 b) {
    int i = std::min(int(b.x * n), n - 1), j = std::min(int(b.y * n), n - 1);
    return size_t(j * n + i);
  };
  std::vector<double> counts(n * n), expected(n * n);
  Sampler sampler(3);
  Mean mean;
  for (int i = 0; i < count; i++) {
    PicturePlace place = sample_emission_picture(picture, sampler.next2());
    ASSERT_GE(std::min(place.barycentric.x, place.barycentric.y), 0);
    ASSERT_LE(place.barycentric.x + place.barycentric.y, 1 + 1e-6f);
    ASSERT_GT(place.density, 0);
    mean.add(double(bright(place.barycentric) / place.density));
    counts[bin_of(place.barycentric)]++;
  }
  Rng rng(8);
  double exact = 0;
  constexpr int points = 400000;
  for (int i = 0; i < points; i++) {
    vec2 b = sample_triangle({rng.uniform(), rng.uniform()});
    expected[bin_of(b)] += double(sample_emission_picture_pdf(picture, b)) * count / points;
    exact += double(bright(b)) / points;
  }
  expect_chi_squared(counts, expected, "places on a picture");
  EXPECT_NEAR(mean.mean(), exact, significance_z * mean.error() + 0.01 * exact);
  EXPECT_LT(mean.error() * std::sqrt(double(count)), 0.6 * mean.mean()) << "brightness is followed";
}

TEST(EmissionPicture, OnlyWhereThePictureVaries) {
  EXPECT_TRUE(make_emission_picture(900, [](vec2) { return 3.0f; }).cells.cells.empty());
  EXPECT_TRUE(make_emission_picture(900, [](vec2) { return 0.0f; }).cells.cells.empty());
  EXPECT_TRUE(make_emission_picture(900, [](vec2) { return std::nanf(""); }).cells.cells.empty());
  auto spot = [](vec2 b) { return b.x < 0.1f ? 9.0f : 0.0f; };
  EXPECT_TRUE(make_emission_picture(1, spot).cells.cells.empty()) << "one texel";
  EXPECT_FALSE(make_emission_picture(1e12f, spot).cells.cells.empty());
  EXPECT_LE(make_emission_picture(1e12f, spot).n, most_emission_rows);
}

// A million samples of a value that binary fractions do not have: the mean is still it.
TEST(Accumulation, AMillionSamplesDoNotDrift) {
  Scene scene = empty_scene();
  scene.environment.radiance = vec3(0.1f, 1e-3f, 300.7f);
  World world(scene);
  View view = make_view_towards(scene, {0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 1, 1, 1);
  Frame frame =
      render_still(*find_technique("direct"), world, make_lights(world), view, {.spp = 1'000'000});
  EXPECT_EQ(frame.color[0], scene.environment.radiance);
}

}  // namespace
}  // namespace wellspring::test
