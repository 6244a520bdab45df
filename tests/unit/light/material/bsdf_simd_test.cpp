// SPDX-License-Identifier: Apache-2.0
// Eight surfaces at once scatter as each does alone.
#include "light/material/bsdf.h"

#include "unit/light/material/bsdf_cases.h"
#include "light/random/warp.h"
#include "scenes/scenes.h"
#include "unit/light/statistics.h"

namespace wellspring::test {
namespace {

using namespace scenes;

// Any opaque surface without coats; some with a mapped normal, brushed, tinted, of infinite index.
Bsdf draw_bsdf(Rng& rng, Material& m) {
  m = rng.uniform() < 0.3f
          ? metal({0.9f, 0.6f, 0.2f}, 0.05f + 0.95f * rng.uniform())
          : plastic({0.3f, 0.5f, 0.8f}, 0.05f + 0.95f * rng.uniform(), 1 + 1.5f * rng.uniform());
  if (rng.uniform() < 0.2f) m.ior = 0;
  if (rng.uniform() < 0.2f) m.ior = 1;
  if (rng.uniform() < 0.3f) m.metallic = rng.uniform();
  if (rng.uniform() < 0.3f) m.specular = rng.uniform();
  if (rng.uniform() < 0.3f) m.specular_color = {1, 0.2f, 2};
  Surface surface = surface_of(m);
  if (rng.uniform() < 0.3f) surface.anisotropy = rng.uniform();
  if (rng.uniform() < 0.5f)
    surface.normal =
        normalize(surface.geometric_normal + 0.3f * sample_sphere({rng.uniform(), rng.uniform()}));
  vec3 view = sample_sphere({rng.uniform(), rng.uniform()});
  if (dot(view, surface.geometric_normal) < 0) view = -view;
  return make_bsdf(surface, m, -view, dielectric_albedo(m.ior, false));
}

TEST(BsdfLanes, EightAtOnceAreEachAlone) {
  Rng rng(3);
  int lit = 0;
  for (int round = 0; round < 2000; round++) {
    Material materials[lane_count];
    Bsdf bsdfs[lane_count];
    BsdfLanes lanes;
    Lanes3 direction;
    vec3 towards[lane_count];
    for (int i = 0; i < lane_count; i++) {
      bsdfs[i] = draw_bsdf(rng, materials[i]);
      ASSERT_TRUE(fits_lanes(bsdfs[i]));
      set_lane(lanes, i, bsdfs[i]);
      vec3 l = towards[i] = sample_sphere({rng.uniform(), rng.uniform()});
      direction.x[i] = l.x, direction.y[i] = l.y, direction.z[i] = l.z;
    }
    BsdfLanesValue value = eval_bsdf_lanes(lanes, direction);
    for (int i = 0; i < lane_count; i++) {
      BsdfValue alone = eval_bsdf(bsdfs[i], towards[i]);
      vec3 diffuse = bsdfs[i].diffuse * value.diffuse[i],
           specular(value.specular.x[i], value.specular.y[i], value.specular.z[i]);
      // Operations in another order: a few hundred roundings, more where facets cancel at grazing.
      float slack = 1e-4f * (1e-3f + max_component(alone.diffuse + alone.specular));
      for (int c = 0; c < 3; c++) {
        ASSERT_NEAR(diffuse[c], alone.diffuse[c], slack) << round << ", lane " << i;
        ASSERT_NEAR(specular[c], alone.specular[c], slack) << round << ", lane " << i;
      }
      lit += max_component(alone.specular) > 0;
    }
  }
  EXPECT_GT(lit, 5000);
}

TEST(BsdfLanes, OneSurfaceAgainstEightDirections) {
  Rng rng(5);
  Material m;
  Bsdf bsdf = draw_bsdf(rng, m);
  BsdfLanes lanes = make_bsdf_lanes(bsdf);
  Lanes3 direction;
  vec3 towards[lane_count];
  for (int i = 0; i < lane_count; i++) {
    vec3 l = towards[i] = sample_sphere({rng.uniform(), rng.uniform()});
    direction.x[i] = l.x, direction.y[i] = l.y, direction.z[i] = l.z;
  }
  BsdfLanesValue value = eval_bsdf_lanes(lanes, direction);
  for (int i = 0; i < lane_count; i++)
    EXPECT_NEAR(value.specular.y[i], eval_bsdf(bsdf, towards[i]).specular.y, 1e-4f);
}

TEST(BsdfLanes, WhatDoesNotFitIsToldApart) {
  for (const Material& m : {glass(1.5f, 0.3f, 1), glass(1.5f, 0, 0), metal(vec3(1), 0)}) {
    Surface surface = surface_of(m);
    EXPECT_FALSE(fits_lanes(make_bsdf(surface, m, -direction_at(30), dielectric_albedo(m.ior))));
  }
  Material coated = plastic(vec3(0.5f), 0.4f);
  coated.clearcoat = 1;
  EXPECT_FALSE(fits_lanes(
      make_bsdf(surface_of(coated), coated, -direction_at(30), dielectric_albedo(1.5f))));
}

}  // namespace
}  // namespace wellspring::test
