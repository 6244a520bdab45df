// SPDX-License-Identifier: Apache-2.0
#include "light/bsdf.h"

#include <limits>
#include <string>

#include "bsdf_cases.h"
#include "statistics.h"

using namespace wellspring;
using namespace wellspring::scenes;
using namespace wellspring::test;

namespace {

// Everything that has a density, over the range of roughness.
std::vector<Case> rough_cases() {
  std::vector<Case> cases;
  for (float r : {0.3f, 0.6f, 1.0f}) {
    std::string rough = " roughness " + std::to_string(r);
    Material mixed = plastic({0.8f, 0.4f, 0.2f}, r);
    mixed.metallic = 0.5f;
    Material milky = glass(1.4f, r, 1);
    milky.transmission = 0.5f;
    cases.push_back({"metal" + rough, metal({1, 0.8f, 0.3f}, r)});
    cases.push_back({"plastic" + rough, plastic(vec3(0.5f), r)});
    cases.push_back({"half metal" + rough, mixed});
    cases.push_back({"thin glass" + rough, glass(1.5f, r, 0)});
    cases.push_back({"glass" + rough, glass(1.5f, r, 1)});
    cases.push_back({"glass from inside" + rough, glass(1.5f, r, 1), false});
    cases.push_back({"milky glass" + rough, milky});
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

}  // namespace

// Samples fall where the density says: a chi-squared test over the sphere of directions.
TEST(Bsdf, SamplersFollowTheirDensity) {
  constexpr int rows = 24, columns = 12, fine = 30, count = 30000;
  for (const Case& c : rough_cases())
    for (float angle : {0.0f, 40.0f, 75.0f})
      for (Lobes lobes : {Lobes::all, Lobes::specular}) {
        Bsdf bsdf = bsdf_of(c.material, angle, c.front);
        if (lobes == Lobes::specular && (!has_specular(bsdf) || !has_diffuse(bsdf))) continue;
        std::vector<double> counts(rows * columns + 1), expected(rows * columns + 1);
        double total = 0;
        for (int row = 0; row < rows; row++)
          for (int column = 0; column < columns; column++) {
            double sum = 0;
            for (int i = 0; i < fine; i++)
              for (int j = 0; j < fine; j++) {
                float theta = pi * (float(row) + (float(i) + 0.5f) / fine) / rows;
                float phi = 2 * pi * (float(column) + (float(j) + 0.5f) / fine) / columns;
                float r = std::sin(theta);
                vec3 l(r * std::cos(phi), std::cos(theta), r * std::sin(phi));
                sum += double(sample_bsdf_pdf(bsdf, eval_bsdf(bsdf, l), lobes) * r);
              }
            double p = sum / (fine * fine) * 2 * double(pi) * double(pi) / (rows * columns);
            expected[size_t(row * columns + column)] = p * count;
            total += p;
          }
        ASSERT_LE(total, 1.01) << c.name << " at " << angle;
        expected.back() = std::max(0.0, 1 - total) * count;  // directions that end nowhere
        Sampler sampler(3);
        for (int i = 0; i < count; i++) {
          BsdfSample s = sample_bsdf(bsdf, lobes, sampler);
          if (s.pdf <= 0) {
            counts.back()++;
            continue;
          }
          float phi = std::atan2(s.direction.z, s.direction.x);
          if (phi < 0) phi += 2 * pi;
          int row = std::min(int(std::acos(glm::clamp(s.direction.y, -1.0f, 1.0f)) / pi * rows),
                             rows - 1);
          int column = std::min(int(phi / (2 * pi) * columns), columns - 1);
          counts[size_t(row * columns + column)]++;
        }
        std::string what =
            c.name + " at " + std::to_string(angle) + (lobes == Lobes::all ? " all" : " specular");
        expect_chi_squared(counts, expected, what.c_str());
      }
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

TEST(Bsdf, ReflectionIsReciprocal) {
  Material m = plastic({0.9f, 0.5f, 0.2f}, 0.4f);
  for (float from : {10.0f, 50.0f, 80.0f})
    for (float to : {25.0f, 65.0f}) {
      auto direction = [](float degrees) {
        float a = glm::radians(degrees);
        return vec3(std::sin(a), std::cos(a), 0);
      };
      BsdfValue there = eval_bsdf(bsdf_of(m, from), direction(-to));
      BsdfValue back = eval_bsdf(bsdf_of(m, to), direction(-from));
      vec3 f = (there.diffuse + there.specular) / std::cos(glm::radians(to));
      vec3 g = (back.diffuse + back.specular) / std::cos(glm::radians(from));
      EXPECT_NEAR(f.x, g.x, 1e-3f * f.x) << from << " to " << to;
      EXPECT_NEAR(f.z, g.z, 1e-3f * f.z) << from << " to " << to;
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
    if (pass) EXPECT_NEAR(dot(sample.direction, direction), 1, 1e-5f);
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
  for (float roughness : {-1.0f, 0.0f, 1e-4f, 0.0316f, 5.0f, nan})
    for (float ior : {0.0f, 0.5f, 1.0f, 1.0005f, 100.0f})
      for (float angle : {0.0f, 60.0f, 89.99f})
        for (float transmission : {0.0f, 1.0f})
          for (vec3 shading : {vec3(0, 1, 0), vec3(-1, 0.01f, 0), vec3(1, -0.2f, 0)}) {
            Material m = glass(ior, roughness, transmission);
            m.transmission = transmission;
            Bsdf bsdf = bsdf_of(m, angle, true, shading);
            Sampler sampler(4);
            for (int i = 0; i < 50; i++) {
              BsdfSample s = sample_bsdf(bsdf, Lobes::all, sampler);
              ASSERT_TRUE(is_finite(s.weight) && is_finite(s.direction) && std::isfinite(s.pdf))
                  << roughness << " " << ior << " " << angle;
              ASSERT_GE(std::min(s.weight.x, s.pdf), 0);
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
