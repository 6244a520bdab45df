// SPDX-License-Identifier: Apache-2.0
// Samples of every material fall where its density says, and what must be reciprocal is.
#include <cmath>

#include "base/parallel.h"
#include "unit/light/material/bsdf_cases.h"
#include "unit/light/statistics.h"

namespace wellspring::test {
namespace {

using namespace scenes;

constexpr int rows = 24, columns = 16, fine = 24, draws = 20000;

// Says how surprising the counts are: the chi-squared statistic as a normal deviate (Wilson and
// Hilferty 1931). Bins that expect fewer than five are judged together.
struct Judged {
  double deviate = 0, total = 0;  // integral of the density
};

Judged judge(const Bsdf& bsdf, Lobes lobes, uint64_t seed) {
  std::vector<double> counts(rows * columns + 1), expected(rows * columns + 1);
  Judged judged;
  for (int row = 0; row < rows; row++)
    for (int column = 0; column < columns; column++) {
      // Over the root of the cosine, as densities change fastest near the horizon.
      float sign = row < rows / 2 ? 1.0f : -1.0f;
      auto root = [&](int r) { return std::sqrt(std::abs(std::cos(pi * float(r) / rows))); };
      float from = root(row), to = root(row + 1);
      double sum = 0;
      for (int i = 0; i < fine; i++)
        for (int j = 0; j < fine; j++) {
          float t = glm::mix(from, to, (float(i) + 0.5f) / fine), z = t * t;
          float phi = 2 * pi * (float(column) + (float(j) + 0.5f) / fine) / columns;
          float r = std::sqrt(1 - z * z);
          vec3 l(r * std::cos(phi), sign * z, r * std::sin(phi));
          sum += double(sample_bsdf_pdf(bsdf, eval_bsdf(bsdf, l), lobes) * 2 * t);
        }
      double p = sum / (fine * fine) * double(std::abs(to - from)) * 2 * double(pi) / columns;
      expected[size_t(row * columns + column)] = p * draws;
      judged.total += p;
    }
  expected.back() = std::max(0.0, 1 - judged.total) * draws;  // perfect lobes, and lost
  for (int i = 0; i < draws; i++) {
    Sampler sampler(mix64(seed * draws + uint64_t(i)));  // independent
    BsdfSample s = sample_bsdf(bsdf, lobes, sampler);
    if (s.pdf <= 0) {
      counts.back()++;
      continue;
    }
    float phi = std::atan2(s.direction.z, s.direction.x);
    if (phi < 0) phi += 2 * pi;
    int row = int(std::acos(glm::clamp(s.direction.y, -1.0f, 1.0f)) / pi * rows);
    int column = int(phi / (2 * pi) * columns);
    counts[size_t(std::min(row, rows - 1) * columns + std::min(column, columns - 1))]++;
  }
  double statistic = 0, rare_count = 0, rare = 0;
  int bins = 0;
  for (size_t i = 0; i < counts.size(); i++) {
    if (expected[i] < 5) {
      rare_count += counts[i];
      rare += expected[i];
      continue;
    }
    statistic += (counts[i] - expected[i]) * (counts[i] - expected[i]) / expected[i];
    bins++;
  }
  if (rare_count > 0 || rare >= 5) {
    rare = std::max(rare, 5.0);
    statistic += (rare_count - rare) * (rare_count - rare) / rare * (rare_count > rare);
    bins++;
  }
  double degrees = std::max(bins - 1, 1), t = 2 / (9 * degrees);
  judged.deviate = (std::cbrt(statistic / degrees) - (1 - t)) / std::sqrt(t);
  return judged;
}

vec3 total(const BsdfValue& value) { return value.diffuse + value.specular; }

// All are one test at a significance of 1 %: each at Sidak's share of it.
TEST(BsdfSampling, FollowsTheDensity) {
  struct Place {
    Case material;
    float angle;
    Lobes lobes;
    Judged judged;
  };
  std::vector<Place> places;
  for (float roughness : {0.35f, 0.6f, 1.0f})
    for (const Case& c : white_cases(roughness)) {
      dielectric_albedo(c.material.ior);
      for (float angle : {20.0f, 70.0f})
        places.push_back({c, angle, angle == 70 ? Lobes::specular : Lobes::all, {}});
    }
  mirror_loss();
  parallel_for(int(places.size()), [&](int i) {
    Place& p = places[size_t(i)];
    Bsdf bsdf = bsdf_of(p.material.material, p.angle, p.material.front);
    p.judged = judge(bsdf, p.lobes, uint64_t(i));
  });
  double each = 1 - std::pow(0.99, 1.0 / double(places.size()));
  for (const Place& p : places) {
    double chance = 0.5 * std::erfc(p.judged.deviate / std::sqrt(2.0));
    EXPECT_GE(chance, each) << p.material.name << " at " << p.angle << ": deviate "
                            << p.judged.deviate;
    EXPECT_LE(p.judged.total, 1.005) << p.material.name << " at " << p.angle;
  }
}

// Reflection: f(v, l) = f(l, v). Through a boundary: radiance is eta^2 denser beyond it.
TEST(BsdfSampling, IsReciprocalButForLayersAndBrushing) {
  int compared = 0;
  for (float roughness : {0.15f, 0.4f, 0.8f})
    for (const Case& c : white_cases(roughness)) {
      const Material& m = c.material;
      bool layered = m.clearcoat > 0 || max_component(m.sheen_color) > 0;
      // Seen from within, the opaque share of a solid has no gloss: one side only is compared.
      bool milky = m.transmission == 0.5f && m.thickness > 0;
      double brushed = 0;
      for (float from : {5.0f, 35.0f, 60.0f, 80.0f})
        for (float to : {15.0f, 50.0f, 75.0f, 105.0f, 140.0f, 170.0f}) {
          if (to > 90 && milky) continue;
          vec3 v = direction_at(from, 20), l = direction_at(to, 130);
          Bsdf there = bsdf_seen_from(m, v, c.front);
          if (to > 90 && !(max_component(there.transmit) > 0)) continue;
          Surface s = surface_of(m, to > 90 ? !c.front : c.front);
          if (to > 90) s.geometric_normal = s.normal = s.clearcoat_normal = {0, -1, 0};
          Bsdf back = make_bsdf(s, m, -l, dielectric_albedo(m.ior));
          double f = double(total(eval_bsdf(there, l)).y / std::abs(l.y));
          double g = double(total(eval_bsdf(back, v)).y / std::abs(v.y));
          if (to > 90 && !there.thin) f *= double(there.eta * there.eta);
          if (f < 1e-4 && g < 1e-4) continue;
          double off = std::abs(f - g) / std::max(f, g);
          compared++;
          if (m.anisotropy > 0) brushed = std::max(brushed, std::abs(f - g));
          if (!layered && m.anisotropy == 0) {
            EXPECT_LE(off, 2e-3) << c.name << " from " << from << " to " << to << ": " << f << " "
                                 << g;
          }
        }
      // Brushed: of what a white Lambertian surface scatters into each direction.
      EXPECT_LE(brushed * double(pi), 1) << c.name;
    }
  EXPECT_GT(compared, 500);
}

// Layers dim the base by the viewer's angle alone, which costs reciprocity: the base differs by the
// ratio of what the layers leave to either direction, and by nothing else.
TEST(BsdfSampling, LayersAreNotReciprocalByWhatTheyLeave) {
  for (const Material& m :
       {coated(plastic(vec3(1), 0.5f), 1, 0), coated(metal(vec3(1), 0.5f), 1, 0),
        with_sheen(diffuse(vec3(1)), vec3(1), 0.5f)})
    for (float from : {10.0f, 45.0f, 70.0f})
      for (float to : {30.0f, 60.0f}) {
        vec3 v = direction_at(from), l = direction_at(to, 140);
        Bsdf there = bsdf_seen_from(m, v), back = bsdf_seen_from(m, l);
        Material bare = m;
        bare.clearcoat = 0;
        bare.sheen_color = vec3(0);
        float base = total(eval_bsdf(bsdf_seen_from(bare, v), l)).y / l.y;
        float f = total(eval_bsdf(there, l)).y / l.y, g = total(eval_bsdf(back, v)).y / v.y;
        float expected = base * (there.beneath - back.beneath);
        EXPECT_NEAR(f - g, expected, 2e-3f * base + 1e-5f) << from << " to " << to;
      }
}

}  // namespace
}  // namespace wellspring::test
