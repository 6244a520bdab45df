// SPDX-License-Identifier: Apache-2.0
// Every material that absorbs nothing reflects and transmits all light, at every roughness and
// angle: half a per cent is the most that tables may be off, beyond what the samples' own error
// explains at the significance of statistics.h.
#include "base/parallel.h"
#include "unit/light/material/bsdf_cases.h"
#include "unit/light/statistics.h"

namespace wellspring::test {
namespace {

using namespace scenes;

constexpr float roughnesses[] = {0, 0.05f, 0.1f, 0.18f, 0.3f, 0.45f, 0.65f, 1};
constexpr float angles[] = {0, 30, 60, 80, 88};
constexpr double allowed = 0.005;

// Directional albedo; its error bar comes from independent replicates of well spread samples.
Mean furnace_albedo(const Bsdf& bsdf, uint64_t seed) {
  constexpr int replicates = 12, count = 1024;
  Mean mean;
  for (int r = 0; r < replicates; r++) {
    double sum = 0;
    for (uint32_t i = 0; i < count; i++) {
      Sampler sampler(mix64(seed * replicates + uint64_t(r)), i);
      sum += energy_of(bsdf, sample_bsdf(bsdf, Lobes::all, sampler));
    }
    mean.add(sum / count);
  }
  return mean;
}

struct Place {
  Case material;
  float angle;
  Mean albedo;
};

void measure(std::vector<Place>& places) {
  mirror_loss();  // made here once, not by all threads waiting for one
  for (const Place& p : places) dielectric_albedo(p.material.material.ior);
  parallel_for(int(places.size()), [&](int i) {
    Place& p = places[size_t(i)];
    Bsdf bsdf = bsdf_of(p.material.material, p.angle, p.material.front);
    p.albedo = furnace_albedo(bsdf, uint64_t(i));
  });
}

TEST(BsdfFurnace, WhiteMaterialsKeepAllLight) {
  std::vector<Place> places;
  for (float roughness : roughnesses)
    for (const Case& c : white_cases(roughness))
      for (float angle : angles) places.push_back({c, angle, {}});
  measure(places);
  double sum = 0;
  for (const Place& p : places) {
    double off = std::abs(p.albedo.mean() - 1);
    EXPECT_LE(off, allowed + significance_z * p.albedo.error())
        << p.material.name << " at " << p.angle << ": " << p.albedo.mean() << " +- "
        << p.albedo.error();
    EXPECT_LE(p.albedo.error(), 2 * allowed)
        << p.material.name << " at " << p.angle << ": too noisy";
    sum += p.albedo.mean() - 1;
  }
  EXPECT_LE(std::abs(sum / double(places.size())), 1e-3);  // nor do they lose or gain on the whole
}

// Grey ones reflect what their colour says, or what the coupling of their layers makes of it: a
// share of light meets the colour once or more, so the albedo lies between its powers.
TEST(BsdfFurnace, AbsorbingMaterialsNeverGain) {
  std::vector<Place> places;
  for (float roughness : {0.05f, 0.3f, 1.0f})
    for (Case c : white_cases(roughness)) {
      c.material.base_color = vec4(0.5f, 0.5f, 0.5f, 1);
      for (float angle : angles) places.push_back({c, angle, {}});
    }
  measure(places);
  for (const Place& p : places) {
    EXPECT_LE(p.albedo.mean(), 1 + allowed + significance_z * p.albedo.error())
        << p.material.name << " at " << p.angle;
    EXPECT_GE(p.albedo.mean(), 0.2) << p.material.name << " at " << p.angle;
  }
}

// KHR_materials_specular: where the reflection is tinted, the layer beneath gets what the strongest
// channel leaves, so every channel but that one loses what its own reflection is weaker by.
TEST(BsdfFurnace, TintedReflectionOverWhite) {
  for (float roughness : {0.1f, 0.5f}) {
    Material m = with_specular(plastic(vec3(1), roughness), 1, {1, 0.5f, 4});
    Material bare = m;
    bare.base_color = vec4(0, 0, 0, 1);
    for (float angle : {0.0f, 60.0f}) {
      Bsdf bsdf = bsdf_of(m, angle), gloss = bsdf_of(bare, angle);
      vec3 all(0), reflected(0);
      constexpr uint32_t count = 16384;
      for (uint32_t i = 0; i < count; i++) {
        Sampler a(5, i), b(6, i);
        all += sample_bsdf(bsdf, Lobes::all, a).weight / float(count);
        reflected += sample_bsdf(gloss, Lobes::all, b).weight / float(count);
      }
      for (int c = 0; c < 3; c++)
        EXPECT_NEAR(all[c], 1 - reflected.z + reflected[c], allowed) << c << " at " << angle;
      EXPECT_NEAR(all.z, 1, allowed);
      EXPECT_LT(reflected.y, reflected.x);
      EXPECT_LT(reflected.x, reflected.z);
    }
  }
}

}  // namespace
}  // namespace wellspring::test
