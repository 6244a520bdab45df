// SPDX-License-Identifier: Apache-2.0
#include "light/material/bsdf.h"

#include <limits>
#include <string>

#include "unit/light/material/bsdf_cases.h"
#include "unit/light/statistics.h"

namespace wellspring::test {
namespace {

using namespace scenes;

// Everything, over the range of roughness that has a density.
std::vector<Case> rough_cases() {
  std::vector<Case> cases;
  for (float r : {0.3f, 0.6f, 1.0f})
    for (const Case& c : white_cases(r)) {
      cases.push_back(c);
      cases.back().material.base_color = {0.8f, 0.5f, 0.3f, 1};
    }
  cases.push_back({"diffuse", diffuse(vec3(0.7f))});
  return cases;
}

constexpr float view_angles[] = {0, 40, 75, 87};

// Mean weight of sampling: the directional albedo.
Mean albedo_of(const Bsdf& bsdf, Lobes lobes, int count = 40000) {
  Sampler sampler(11);
  Mean mean;
  for (int i = 0; i < count; i++) {
    BsdfSample s = sample_bsdf(bsdf, lobes, sampler);
    float scale = s.bounce == Bounce::refract ? bsdf.eta * bsdf.eta : 1;  // energy, not radiance
    mean.add(double(s.weight.y * scale));
  }
  return mean;
}

TEST(Bsdf, WeightIsValueOverDensity) {
  for (const Case& c : rough_cases())
    for (float angle : view_angles) {
      Bsdf bsdf = bsdf_of(c.material, angle, c.front);
      Sampler sampler(5);
      for (int i = 0; i < 500; i++) {
        BsdfSample s = sample_bsdf(bsdf, Lobes::all, sampler);
        if (s.pdf <= 0) continue;
        ASSERT_NEAR(length(s.direction), 1, 1e-3) << c.name;
        BsdfValue value = eval_bsdf(bsdf, s.direction);
        vec3 expected = (value.diffuse + value.specular) / sample_bsdf_pdf(bsdf, value, Lobes::all);
        ASSERT_NEAR(s.weight.x, expected.x, 1e-3f * (1 + expected.x)) << c.name;
        ASSERT_TRUE(is_finite(s.weight)) << c.name;
      }
    }
}

TEST(Bsdf, ColoredMaterialsReflectLessThanTheyReceive) {
  for (const Case& c : rough_cases())
    for (float angle : view_angles) {
      Mean albedo = albedo_of(bsdf_of(c.material, angle, c.front), Lobes::all, 5000);
      EXPECT_LE(albedo.mean(), 1.015 + 4 * albedo.error()) << c.name << " at " << angle;
      EXPECT_GT(albedo.mean(), 0.05) << c.name << " at " << angle;
    }
}

TEST(Bsdf, LambertReflectsItsAlbedoAtEveryAngle) {
  for (float angle : view_angles) {
    Mean albedo = albedo_of(bsdf_of(diffuse(vec3(0.3f)), angle), Lobes::all);
    EXPECT_NEAR(albedo.mean(), 0.3, 1e-4) << angle;
  }
}

TEST(Bsdf, SmoothMirrorAndGlassObeySnellAndFresnel) {
  Sampler sampler(1);
  BsdfSample s = sample_bsdf(bsdf_of(metal(vec3(0.9f), 0), 30), Lobes::all, sampler);
  EXPECT_NEAR(s.direction.x, -0.5f, 1e-5f);
  EXPECT_EQ(s.pdf, 0);
  EXPECT_GT(s.weight.x, 0.9f);
  Bsdf bsdf = bsdf_of(glass(1.5f, 0, 1), 0);
  Mean reflected;
  for (int i = 0; i < 20000; i++) {
    s = sample_bsdf(bsdf, Lobes::all, sampler);
    reflected.add(s.bounce == Bounce::reflect);
  }
  expect_mean(reflected, 0.04, "normal reflectance of glass", 0.1);
  bsdf = bsdf_of(glass(1.5f, 0, 1), 60);
  do s = sample_bsdf(bsdf, Lobes::all, sampler);
  while (s.bounce != Bounce::refract);
  EXPECT_NEAR(-s.direction.x, std::sin(glm::radians(60.0f)) / 1.5f, 1e-5f);
  bsdf = bsdf_of(glass(1.5f, 0, 1), 60, false);  // from inside, beyond the critical angle
  for (int i = 0; i < 100; i++)
    EXPECT_EQ(sample_bsdf(bsdf, Lobes::all, sampler).bounce, Bounce::reflect);
}

TEST(Bsdf, PaneAgreesWithItsTransmittance) {
  Material m = glass(1.5f, 0, 0);
  m.base_color = {0.9f, 0.6f, 0.3f, 1};
  Surface s;
  s.base_color = vec3(m.base_color);
  s.roughness = 0;
  s.transmission = 0.7f;
  ASSERT_TRUE(is_pane(s, m));
  vec3 direction = normalize(vec3(0.5f, -1, 0.2f));
  Bsdf bsdf = make_bsdf(s, m, direction, dielectric_albedo(1.5f));
  Sampler sampler(9);
  Mean passed;
  for (int i = 0; i < 40000; i++) {
    BsdfSample sample = sample_bsdf(bsdf, Lobes::all, sampler);
    bool pass = sample.bounce == Bounce::pass;
    if (pass) {
      EXPECT_NEAR(dot(sample.direction, direction), 1, 1e-5f);
    }
    passed.add(pass ? double(sample.weight.y) : 0);
  }
  expect_mean(passed, double(pane_transmittance(s, m, direction).y), "pane");
  s.roughness = 0.3f;
  EXPECT_FALSE(is_pane(s, m));
  m.thickness = 0.01f;
  s.roughness = 0;
  EXPECT_FALSE(is_pane(s, m));
}

TEST(Bsdf, EqualIndicesLetLightGoStraightOnHoweverRough) {
  for (float roughness : {0.0f, 0.5f, 1.0f}) {
    Bsdf bsdf = bsdf_of(glass(1, roughness, 1), 50);
    Sampler sampler(2);
    for (int i = 0; i < 100; i++) {
      BsdfSample s = sample_bsdf(bsdf, Lobes::all, sampler);
      ASSERT_EQ(s.bounce, Bounce::refract);
      EXPECT_NEAR(s.direction.y, -std::cos(glm::radians(50.0f)), 1e-5f);
      EXPECT_NEAR(s.weight.x, 1, 1e-5f);
    }
  }
}

TEST(Bsdf, OddValuesGiveFiniteAnswers) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  for (float odd : {-1.0f, 0.0f, 1e-4f, 0.0316f, 1.0f, 5.0f, nan})
    for (float ior : {0.0f, 0.5f, 1.0f, 1.0005f, 100.0f})
      for (float angle : {0.0f, 60.0f, 89.99f})
        for (float transmission : {0.0f, 1.0f})
          for (int layers = 0; layers < 8; layers++)
            for (vec3 shading : {vec3(0, 1, 0), vec3(-1, 0.01f, 0), vec3(1, -0.2f, 0)}) {
              Material m = glass(ior, odd, transmission);
              m.transmission = transmission;
              Surface s = surface_of(m, angle < 60);
              s.normal = s.clearcoat_normal = normalize(shading);
              if (layers & 1) {
                s.clearcoat = 1;
                s.clearcoat_roughness = odd;
                s.specular = odd;
                s.specular_color = vec3(odd, 3, 0);
              }
              if (layers & 2) {
                s.sheen_color = vec3(1, odd, 0.5f);
                s.sheen_roughness = odd;
              }
              if (layers & 4) {  // brushed along the normal, along nothing, and along no number
                s.anisotropy = odd != 1 ? odd : 0.5f;
                s.tangent = odd > 1 ? s.normal : odd > 0 ? vec3(0) : vec3(nan, 0, 1);
              }
              Bsdf bsdf = make_bsdf(s, m, -direction_at(angle), dielectric_albedo(ior));
              for (uint32_t i = 0; i < 24; i++) {
                Sampler sampler(4, i);
                BsdfSample sample = sample_bsdf(bsdf, Lobes::all, sampler);
                ASSERT_TRUE(is_finite(sample.weight) && is_finite(sample.direction) &&
                            std::isfinite(sample.pdf))
                    << odd << " " << ior << " " << angle << " layers " << layers;
                vec3 w = sample.weight;
                ASSERT_GE(std::min({w.x, w.y, w.z, sample.pdf}), 0)
                    << odd << " " << ior << " " << angle << " layers " << layers;
              }
            }
}

TEST(Bsdf, NothingLeaksThroughAnOpaqueSurface) {
  for (vec3 shading : {vec3(0, 1, 0), vec3(1, 0.3f, 0), vec3(-2, 0.3f, 1)})
    for (const Material& m : {plastic(vec3(0.8f), 0.3f), metal(vec3(0.8f), 0.2f)}) {
      Bsdf bsdf = bsdf_of(m, 70, true, shading);
      Sampler sampler(8);
      int alive = 0;
      for (int i = 0; i < 2000; i++) {
        BsdfSample s = sample_bsdf(bsdf, Lobes::all, sampler);
        if (max_component(s.weight) <= 0) continue;
        alive++;
        ASSERT_GT(s.direction.y, 0);
      }
      EXPECT_GT(alive, 200);
      BsdfValue below = eval_bsdf(bsdf, normalize(vec3(0.1f, -1, 0)));
      EXPECT_EQ(below.diffuse + below.specular, vec3(0));
    }
}

}  // namespace
}  // namespace wellspring::test
