// SPDX-License-Identifier: Apache-2.0
// The judge is judged: it lets right techniques pass as often as it says, and finds a bias of 1 %.
#include "judge.h"

#include <boost/math/distributions/students_t.hpp>

#include "scenes/lit_world.h"
#include "statistics.h"

namespace wellspring::test {
namespace {

using namespace scenes;

template <int thousandths>
Sample trace_biased(const World& world, const Lights& lights, const TransportSettings& settings,
                    const Request& request) {
  Sample s = find_technique("path")->trace(world, lights, settings, request);
  s.smooth *= 1 + 0.001f * thousandths;
  s.rest *= 1 + 0.001f * thousandths;
  return s;
}
constexpr Technique too_bright{"too bright", "path and 1 % more", trace_biased<10>},
    too_dark{"too dark", "path and 1 % less", trace_biased<-10>};

Ray lit_ray() { return ray_towards({0.1f, 0.5f, 0.8f}, {0, 0, 0}); }
double lit_radiance() { return rect_light_irradiance({0, 0, 0}, 10) * 0.5 / double(pi); }

TEST(Judge, FindsABiasOfOnePercent) {
  auto [scene, world, lights] = LitWorld(make_plane_with_rect_light(10));
  for (const Technique* technique : {&too_bright, &too_dark}) {
    for (uint64_t seed = 1; seed <= 20; seed++) {
      Estimate e = estimate_radiance(*technique, world, lights, view_along(lit_ray(), *technique),
                                     {}, {16, 512, seed});
      Family family;
      // A large family has so many comparisons: the bias must be found in spite of them.
      for (int i = 0; i < 50; i++) family.add("biased", e, lit_radiance());
      Verdict verdict = judge(family.comparisons[0], family.comparisons.size());
      EXPECT_TRUE(verdict.refuted) << technique->name << ", seed " << seed << ": t = " << verdict.t;
      EXPECT_FALSE(verdict.weak);
    }
  }
}

TEST(Judge, NamesATestThatIsTooNoisyToTell) {
  auto [scene, world, lights] = LitWorld(make_plane_with_rect_light(10));
  Estimate e = estimate_radiance(*find_technique("path"), world, lights,
                                 view_along(lit_ray(), *find_technique("path")), {}, {16, 1});
  Family family;
  family.add("one sample", e, lit_radiance());
  Verdict verdict = judge(family.comparisons[0], 1);
  EXPECT_FALSE(verdict.refuted);
  EXPECT_TRUE(verdict.weak);
}

// If a technique is right, t follows Student's distribution: its deciles are equally filled.
// Samples of one seed would fail this: their spread is no measure of their error.
TEST(Judge, RightTechniquesPassAsOftenAsStated) {
  auto [scene, world, lights] = LitWorld(make_plane_with_rect_light(10));
  const Technique& path = *find_technique("path");
  constexpr int trials = 1000;
  std::vector<double> counts(10), expected(10, trials / 10.0);
  boost::math::students_t_distribution<double> student(7);
  for (int i = 0; i < trials; i++) {
    Estimate e = estimate_radiance(path, world, lights, view_along(lit_ray(), path), {},
                                   {8, 16, uint64_t(i) + 100});
    double p = cdf(student, (e.mean - lit_radiance()) / e.error);
    counts[size_t(std::min(9, int(10 * p)))]++;
  }
  expect_chi_squared(counts, expected, "deciles of t");
}

TEST(Judge, DarknessIsExact) {
  Family family;
  family.add("dark", {0, 0, 16}, 0);
  family.add("not dark", {1e-9, 0, 16}, 0);
  EXPECT_FALSE(judge(family.comparisons[0], 2).refuted);
  EXPECT_TRUE(judge(family.comparisons[1], 2).refuted);
  family.add("no number", {std::nan(""), std::nan(""), 16}, 1);
  EXPECT_TRUE(judge(family.comparisons[2], 3).refuted);
}

}  // namespace
}  // namespace wellspring::test
