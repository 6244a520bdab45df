// SPDX-License-Identifier: Apache-2.0
// Light parted by wavelength: no energy made or lost, hues in order, and clusters of wavelengths
// agree with one wavelength at a time.
#include "light/material/dispersion.h"

#include "unit/light/material/bsdf_cases.h"
#include "light/random/warp.h"
#include "scenes/lit_world.h"
#include "unit/light/statistics.h"

namespace wellspring::test {
namespace {

using namespace scenes;

Material flint(float roughness) {
  Material m = glass(1.6f, roughness, 1);
  m.dispersion = 2;  // an Abbe number of 10
  return m;
}

// Radiance of one ray, the mean of replicates of well spread samples, channel by channel.
struct ColorMean {
  Mean channel[3];
};
ColorMean trace_color(const World& world, const Lights& lights, Ray ray, int replicates = 24,
                      uint32_t count = 256) {
  ColorMean mean;
  const Technique& technique = *find_technique("path");
  TransportSettings settings;
  settings.max_depth = 100;  // light that is caught in the glass finds its way out
  for (int r = 0; r < replicates; r++) {
    vec3 sum(0);
    for (uint32_t i = 0; i < count; i++) {
      Request request{.ray = ray, .seed = mix64(uint64_t(r) + 17), .index = i};
      vec3 radiance = technique.trace(world, lights, settings, request).radiance();
      EXPECT_TRUE(is_finite(radiance));
      EXPECT_GE(std::min({radiance.x, radiance.y, radiance.z}), 0);
      sum += radiance / float(count);
    }
    for (int c = 0; c < 3; c++) mean.channel[c].add(double(sum[c]));
  }
  return mean;
}

const SpectralTables& tables = *plain_spectral_tables();
vec3 shown_at(float place) { return tables.shown[nanometre_of(wavelength_at(tables, place))]; }

TEST(Dispersion, WhiteStaysWhiteAndNothingIsNegative) {
  glm::dvec3 sum(0);
  for (size_t i = 0; i < spectrum_size; i++) {
    const vec3 shown = tables.shown[i];
    EXPECT_GE(std::min({shown.x, shown.y, shown.z}), 0);
    sum += glm::dvec3(shown) * double(tables.below[i + 1] - tables.below[i]);
  }
  for (int c = 0; c < 3; c++) EXPECT_NEAR(sum[c], 1, 1e-4);
  float last = 0;
  for (int i = 0; i <= 100; i++) {
    float wavelength = wavelength_at(tables, float(i) / 100);
    EXPECT_GT(wavelength, last);
    last = wavelength;
  }
}

TEST(Dispersion, IndexFollowsTheAbbeNumber) {
  Material m = flint(0);
  EXPECT_NEAR(index_at(tables, m, 587.6f), m.ior, 1e-4f);
  float spread = index_at(tables, m, 486.1f) - index_at(tables, m, 656.3f);
  EXPECT_NEAR((m.ior - 1) / spread, 10, 0.02f);
  m.dispersion = 1e3f;
  EXPECT_GE(index_at(tables, m, 730), 1);
}

// A glass sphere in light from everywhere: what parts the colours may not change the whole.
TEST(Dispersion, FurnaceStaysWhite) {
  for (float roughness : {0.0f, 0.3f}) {
    auto [scene, world, lights] = LitWorld(make_white_furnace(flint(roughness)));
    for (float height : {0.2f, 0.8f}) {
      Ray ray = ray_towards({0, height, 3}, {0, height, 0});
      ColorMean mean = trace_color(world, lights, ray);
      for (const Mean& channel : mean.channel)
        EXPECT_NEAR(channel.mean(), 1, 0.01 + significance_z * channel.error())
            << roughness << " at " << height << " +- " << channel.error();
    }
  }
}

// The cluster's estimate of light through a rough dispersive surface against the same with each
// wavelength on its own, by a t-test.
TEST(Dispersion, ClustersAgreeWithSingleWavelengths) {
  Material m = flint(0.35f);
  Surface surface = surface_of(m);
  vec3 viewer = direction_at(50), towards = normalize(vec3(-0.45f, -1, 0.1f));
  const DielectricAlbedo& albedo = dielectric_albedo(m.ior);
  // A smooth bump of light about `towards`, from below.
  auto light = [&](vec3 l) { return std::exp(60 * (dot(l, towards) - 1)); };
  Mean single[3], cluster[3], lit[3];
  for (int r = 0; r < 48; r++) {
    vec3 one(0), cluster_of(0), eval(0);
    constexpr uint32_t count = 512;
    for (uint32_t i = 0; i < count; i++) {
      Sampler a(mix64(uint64_t(r)), i), b(mix64(uint64_t(r) + 1000), i);
      float place = a.next();
      Bsdf bsdf =
          make_bsdf(surface, m, -viewer, albedo, index_at(tables, m, wavelength_at(tables, place)));
      BsdfSample s = sample_bsdf(bsdf, Lobes::all, a);
      one += s.weight * shown_at(place) * light(s.direction) / float(count);

      std::optional<WavelengthSpread> spread;
      Wavelengths carried;
      Bsdf hero;
      spread_wavelengths(tables, surface, m, -viewer, albedo, carried, b.next(), hero, spread);
      s = sample_bsdf(hero, Lobes::all, b);
      carry_wavelengths(*spread, hero, Lobes::all, s, carried);
      cluster_of += s.weight * tint_of(tables, carried) * light(s.direction) / float(count);

      // The same light is sampled in uniform directions.
      vec3 l = sample_sphere(b.next2());
      eval += eval_bsdf(hero, l).specular * light(l) * (4 * pi) / float(count);
    }
    for (int c = 0; c < 3; c++) {
      single[c].add(double(one[c]));
      cluster[c].add(double(cluster_of[c]));
      lit[c].add(double(eval[c]));
    }
  }
  for (int c = 0; c < 3; c++) {
    expect_same_mean(single[c], cluster[c], "cluster against one wavelength at a time");
    expect_same_mean(single[c], lit[c], "value of the cluster");
  }
  EXPECT_GT(std::abs(cluster[0].mean() - cluster[2].mean()),
            significance_z * cluster[0].error());  // colours part
}

// An eye's walk and a light's walk of one hue each are, in the mean over the light's hues, one walk
// of the eye's: each has coloured what it brings, and the colour counts once. If either has all
// colours, nothing changes.
TEST(Dispersion, HuesThatMeetCountOnce) {
  constexpr int steps = 8192;
  for (float eye : {0.0f, 0.01f, 0.3f, 0.5f, 0.97f}) {
    glm::dvec3 mean(0);
    int colored[3] = {0, 0, 0}, within = 0;
    for (int i = 0; i < steps; i++) {
      float light = (float(i) + 0.5f) / steps;
      vec3 response = shown_at(light), both = meet_hues(tables, eye, light) * response;
      mean += glm::dvec3(both) / double(steps);
      if (std::abs(eye - light) > hue_bandwidth / 2) {
        EXPECT_EQ(both, vec3(0));
        continue;
      }
      within++;
      for (int c = 0; c < 3; c++) colored[c] += response[c] > 0;
    }
    ASSERT_GT(within, steps / 20);
    // A channel without response at some of the hues cannot bring those.
    for (int c = 0; c < 3; c++)
      EXPECT_NEAR(mean[c], double(colored[c]) / within, 2.0 / within) << eye << ", channel " << c;
  }
  EXPECT_EQ(meet_hues(tables, -1, 0.4f), vec3(1));
  EXPECT_EQ(meet_hues(tables, 0.4f, -1), vec3(1));
}

// White light from one side through a prism: the shorter the wavelength, the farther it is bent.
TEST(Dispersion, APrismSpreadsItsHuesInOrder) {
  Material m = flint(0);
  const DielectricAlbedo& albedo = dielectric_albedo(m.ior);
  Surface surface = surface_of(m);
  vec3 viewer = direction_at(60);
  double bent[3] = {0, 0, 0}, weight[3] = {0, 0, 0};
  for (uint32_t i = 0; i < 4096; i++) {
    Sampler sampler(7, i);
    std::optional<WavelengthSpread> spread;
    Wavelengths carried;
    Bsdf hero;
    spread_wavelengths(tables, surface, m, -viewer, albedo, carried, sampler.next(), hero, spread);
    BsdfSample s = sample_bsdf(hero, Lobes::all, sampler);
    carry_wavelengths(*spread, hero, Lobes::all, s, carried);
    if (s.bounce != Bounce::refract) {
      EXPECT_EQ(carried.carried, wavelength_count);  // a mirror image keeps its colours together
      continue;
    }
    EXPECT_EQ(carried.carried, 1);
    for (int c = 0; c < 3; c++) {
      const double brought = double((s.weight * tint_of(tables, carried))[c]);
      bent[c] += brought * double(-s.direction.x);
      weight[c] += brought;
    }
  }
  double red = bent[0] / weight[0], green = bent[1] / weight[1], blue = bent[2] / weight[2];
  EXPECT_GT(red, green + 0.005);  // sine of the refracted angle
  EXPECT_GT(green, blue + 0.005);
}

// A scene in which nothing is dispersive draws the same numbers as before.
TEST(Dispersion, WithoutItNothingIsDrawn) {
  auto [scene, world, lights] = LitWorld(make_white_furnace(glass(1.6f, 0, 1)));
  Ray ray = ray_towards({0, 0.3f, 3}, {0, 0.3f, 0});
  ColorMean mean = trace_color(world, lights, ray, 2, 64);
  EXPECT_EQ(mean.channel[0].mean(), mean.channel[2].mean());
}

}  // namespace
}  // namespace wellspring::test
