// SPDX-License-Identifier: Apache-2.0
// Diffuse light as a function of the surface's direction: against sums over lights.
#include "light/material/light_slope.h"

#include <gtest/gtest.h>

#include "light/random/sampler.h"
#include "light/random/warp.h"

namespace wellspring::test {
namespace {

const vec3 up(0, 1, 0);

vec3 tilted(float angle, float turn) {
  return {std::sin(angle) * std::cos(turn), std::cos(angle), std::sin(angle) * std::sin(turn)};
}

// Light from some directions over the horizon, each as bright.
struct Lit {
  std::vector<vec3> directions;
  float at(vec3 normal) const {
    float sum = 0;
    for (vec3 d : directions) sum += std::max(dot(d, normal), 0.0f);
    return sum;
  }
  vec3 slope() const {
    vec3 sum(0);
    for (vec3 d : directions) sum += dot(d, up) * slope_of(d, up);
    return sum / at(up);
  }
};

// The mean square error over tilts that maps of normals have, over the mean light: with the slope,
// and as if light were the same whatever the direction.
std::pair<double, double> errors(const Lit& lit) {
  double with = 0, without = 0, count = 0;
  for (float angle = 0.05f; angle < 0.7f; angle += 0.05f)
    for (float turn = 0; turn < 6.2f; turn += 0.3f) {
      const vec3 normal = tilted(angle, turn);
      const double wanted = double(lit.at(normal)), mesh = double(lit.at(up));
      const double guess = mesh * double(eval_slope(lit.slope(), up, normal));
      with += (guess - wanted) * (guess - wanted) / (mesh * mesh);
      without += (mesh - wanted) * (mesh - wanted) / (mesh * mesh), count++;
    }
  return {std::sqrt(with / count), std::sqrt(without / count)};
}

TEST(LightSlope, IsExactAtTheMeshsOwnNormal) { EXPECT_EQ(eval_slope({3, -2, 1}, up, up), 1); }

TEST(LightSlope, OfOneLightFollowsItsCosine) {
  for (float angle : {0.0f, 0.4f, 0.8f}) {
    const auto [with, without] = errors({{tilted(angle, 0.7f)}});
    EXPECT_LT(with, 0.05) << angle;
    if (angle > 0) EXPECT_LT(with, 0.2 * without) << angle;
  }
  // Low light ends where a tilt turns away from it, which no straight line follows.
  const auto [with, without] = errors({{tilted(1.35f, 0.7f)}});
  EXPECT_LT(with, 0.45 * without);
}

TEST(LightSlope, OfASkyAndAWindowIsCloserByFar) {
  Lit sky, window;
  for (int i = 0; i < 400; i++) {
    Sampler sampler(7, uint32_t(i));
    vec3 d = sample_sphere(sampler.next2());
    d.y = std::abs(d.y) + 1e-3f;
    sky.directions.push_back(normalize(d));
    if (d.x > 0.5f) window.directions.push_back(normalize(d));
  }
  EXPECT_LT(errors(sky).first, 0.05);
  EXPECT_LT(errors(window).first, 0.35 * errors(window).second);
}

TEST(LightSlope, LightNeverBecomesNegative) { EXPECT_EQ(eval_slope({4, 0, 0}, up, {-1, 0, 0}), 0); }

TEST(LightSlope, IsPackedToAHundredthAndBounded) {
  for (int i = 0; i < 200; i++) {
    Sampler sampler(3, uint32_t(i));
    const vec3 slope =
        most_slope * (2.0f * vec3(sampler.next(), sampler.next(), sampler.next()) - 1.0f);
    EXPECT_LT(max_component(glm::abs(unpack_slope(pack_slope(slope)) - slope)), 0.005f);
  }
  EXPECT_EQ(unpack_slope(pack_slope(vec3(0))), vec3(0));
  EXPECT_EQ(unpack_slope(pack_slope(vec3(NAN, 1, 0))), vec3(0));
  const vec3 cut = unpack_slope(pack_slope({400, -200, 0}));
  EXPECT_LT(length(cut - vec3(most_slope, -0.5f * most_slope, 0)), 0.01f);
  LaneBits codes{};
  for (int k = 0; k < lane_count; k++) codes[k] = pack_slope({0.5f * float(k), -1, 0.25f});
  Lanes x, y, z;
  unpack_slope(codes, x, y, z);
  for (int k = 0; k < lane_count; k++) EXPECT_EQ(vec3(x[k], y[k], z[k]), unpack_slope(codes[k]));
}

}  // namespace
}  // namespace wellspring::test
