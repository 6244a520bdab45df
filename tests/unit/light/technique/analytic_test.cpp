// SPDX-License-Identifier: Apache-2.0
// Every technique on every analytic scene that it claims, judged by t-tests.
#include "unit/light/technique/analytic_cases.h"
#include "unit/light/judge.h"

namespace wellspring::test {
namespace {

using namespace scenes;

bool claims(const Technique& technique, const AnalyticCase& c) {
  const Claim* claim = find_claim(technique.name);
  return claim && (c.needs & ~claim->kinds) == 0;
}

// With as many samples as it takes to find the bias that has to be found, `effort` at most. Each
// trial is drawn anew, and whether it does is told by its spread alone, never by its mean, so the
// t-test keeps its significance (Stein 1945, "A two-sample test for a linear hypothesis whose power
// is independent of the variance").
Estimate estimate_well_enough(const Technique& technique, const World& world, Lights lights,
                              const View& view, const TransportSettings& transport, Effort effort,
                              double expected, size_t family_size) {
  if (technique.prepare) technique.prepare(world, std::span(&view.position, 1), lights);
  Effort trial = effort;
  trial.replicates = effort.replicates / 2;
  for (int share : {16, 6, 2}) {
    trial.spp = std::max(1, effort.spp / share);
    if (trial.spp == effort.spp) break;
    trial.seed = effort.seed + uint64_t(share);
    Estimate e = estimate_prepared(technique, world, lights, view, transport, trial);
    Comparison comparison{"", e, expected, e.error, double(e.replicates - 1)};
    if (!judge(comparison, family_size).weak) return e;
  }
  return estimate_prepared(technique, world, lights, view, transport, effort);
}

void judge_cases(const std::vector<AnalyticCase>& cases) {
  Family family;
  for (const AnalyticCase& c : cases) {
    World world(c.scene);
    Lights lights = make_lights(world);
    for (const Technique& technique : techniques()) {
      bool slow_start = technique.prepare || technique.begin_pass;
      if (!claims(technique, c) || (c.variant && slow_start)) continue;
      View view = view_along(c.ray, technique);
      if (c.tan_half_fov > 0) {
        view.tan_half_fov = c.tan_half_fov;
        view.width = view.height = 16;
      }
      Effort effort{.spp = c.spp};
      // Pixels of a pass do not know of each other: what the eye chooses among is drawn at random,
      // and so is direct light where it is no point lights'.
      const bool by_itself = std::string_view(technique.name) == "multires_splatting";
      if (view.width == 6)
        effort.spp = std::max(1, c.spp / (by_itself ? 8 : c.needs & chains ? 12 : 36));
      TransportSettings transport = c.transport;
      transport.instant.places = 64;  // few pixels, many lights
      transport.instant.photons = 0;  // caustics are not claimed
      std::string what = std::string(technique.name) + ", " + c.name;
      Estimate e = estimate_well_enough(technique, world, lights, view, transport, effort,
                                        c.expected, cases.size() * techniques().size());
      family.add(what, e, c.expected);
    }
    EXPECT_EQ(lights.bad_samples->load(), 0u) << c.name;
  }
  expect_family(family);
}

TEST(Analytic, EveryTechniqueSaysWhatItClaims) {
  for (const Technique& technique : techniques())
    EXPECT_TRUE(find_claim(technique.name))
        << technique.name << " needs a line in the table of claims (analytic_cases.cpp)";
}

TEST(Analytic, DirectLight) { judge_cases(direct_light_cases()); }
TEST(Analytic, GlassAndMirrors) { judge_cases(glass_and_mirror_cases()); }
TEST(Analytic, NestedGlass) { judge_cases(nested_glass_cases()); }
TEST(Analytic, Interreflection) { judge_cases(interreflection_cases()); }

// A technique indeed leaves out light that it does not claim: the table is no excuse.
TEST(Analytic, DirectLeavesOutInterreflection) {
  for (const AnalyticCase& c : interreflection_cases()) {
    if (!(c.needs & interreflection) || c.expected < 1.01) continue;
    World world(c.scene);
    const Technique& direct = *find_technique("direct");
    Estimate e = estimate_radiance(direct, world, make_lights(world), view_along(c.ray, direct),
                                   c.transport, {8, 64, 1});
    EXPECT_LT(e.mean + 5 * e.error, c.expected) << c.name;
  }
}

}  // namespace
}  // namespace wellspring::test
