// SPDX-License-Identifier: Apache-2.0
// Guides of the visibility pass are those that rays find.
#include "picture/still/reconstruct_still.h"

#include <gtest/gtest.h>

#include <cmath>

#include "unit/picture/drawn_visit.h"

namespace wellspring::test {
namespace {

using namespace scenes;

TEST(StillGuides, AgreeWithThoseOfRays) {
  const Stage stage(make_row_of_balls(
      {diffuse({0.2f, 0.4f, 0.6f}), metal({0.9f, 0.8f, 0.6f}, 0), metal({0.8f, 0.5f, 0.4f}, 0.7f),
       emitter({3, 0.2f, 0.1f}), glass(1.5f, 0, 1)},
      -2));
  View view = make_view_towards(stage.scene, {0, 0.5, 4}, {0, -0.2, 0}, {0, 1, 0}, 1.0f, 160, 90);
  std::vector<uint8_t> followed;
  GuidePlanes drawn, traced = make_guides(*stage.world, stage.lights, view, 16);
  for (int place = 0; place < guide_places; place++)
    add_still_guides(*stage.world, stage.lights, *stage.visibility, view, RasterShows::all, place,
                     drawn, followed);
  ASSERT_EQ(drawn.albedo.size(), traced.albedo.size());
  double albedo = 0, normal = 0;
  int far = 0;
  for (size_t i = 0; i < traced.albedo.size(); i++) {
    vec3 a = glm::abs(drawn.albedo[i] - traced.albedo[i]);
    vec3 n = glm::abs(drawn.normal[i] - traced.normal[i]);
    ASSERT_TRUE(is_finite(drawn.albedo[i]) && is_finite(drawn.normal[i])) << i;
    albedo += max_component(a), normal += max_component(n);
    far += max_component(a) > 0.2f;
  }
  const double pixels = double(traced.albedo.size());
  EXPECT_LT(albedo / pixels,
            0.03);  // the gloss of Lambertian surfaces is left out, edges are coarser
  EXPECT_LT(normal / pixels, 0.03);
  EXPECT_LT(far / pixels, 0.03);
}

TEST(StillGuides, OfWhatStandsStillLeaveOutWhatMoves) {
  Scene scene = empty_scene();
  scene.environment.radiance = vec3(0.5f);
  add_wall(scene, diffuse({0.1f, 0.6f, 0.1f}), -3);
  int red = add_material(scene, diffuse({0.8f, 0.1f, 0.1f}));
  scene.objects.push_back("moving");
  const Stage stage(std::move(scene), sphere_mesh(red, 1));
  View view = make_view_towards(stage.scene, {0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 1.0f, 65, 65);
  std::vector<uint8_t> followed, others;
  GuidePlanes all, still;
  for (int place = 0; place < guide_places; place++) {
    add_still_guides(*stage.world, stage.lights, *stage.visibility, view, RasterShows::all, place,
                     all, followed);
    add_still_guides(*stage.world, stage.lights, *stage.visibility, view, RasterShows::still, place,
                     still, others);
  }
  const size_t middle = 32 * 65 + 32;
  EXPECT_NEAR(all.albedo[middle].x, 0.8f, 0.05f);
  EXPECT_NEAR(still.albedo[middle].x, 0.1f, 0.05f);
}

}  // namespace
}  // namespace wellspring::test
