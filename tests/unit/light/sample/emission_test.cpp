// SPDX-License-Identifier: Apache-2.0
#include "light/sample/emission.h"

#include "light/sample/environment_light.h"
#include "light/sample/light_tables.h"
#include "light/sample/lights.h"
#include "light/sample/sample_light.h"
#include "scenes/scenes.h"
#include "unit/light/statistics.h"

namespace wellspring::test {
namespace {

using namespace scenes;

// Rays leave a textured lamp where it emits light: as much light as without that choice, less
// scattered.
TEST(Emission, RaysLeaveWhereThePictureShines) {
  Scene scene = make_plane_with_rect_light(1);
  Image image{.width = 16, .height = 16};
  for (int i = 0; i < 256; i++)
    image.texels.push_back(i % 16 < 2 ? vec4(8, 8, 8, 1) : vec4(0, 0, 0, 1));
  scene.materials.back().emission_texture.texture = add_texture(scene, image);
  World world(scene);
  Lights lights = make_lights(world);
  ASSERT_FALSE(lights.tables->pictures.empty());
  auto even = std::make_shared<LightTables>(*lights.tables);
  for (EmitterTriangle& e : even->emitters) e.picture = -1;
  Mean by_picture, evenly;
  auto flux = [&](const LightTables& tables, uint32_t i) {
    Sampler sampler(mix64(i));
    return double(sample_emitted_ray({world, tables}, sampler).flux.x);
  };
  for (uint32_t i = 0; i < 20000; i++) {
    by_picture.add(flux(*lights.tables, i));
    evenly.add(flux(*even, i + 20000));
  }
  expect_same_mean(by_picture, evenly, "flux of a textured lamp");
  EXPECT_GT(evenly.mean(), 0);
  // Half of the variance or less: at 20,000 degrees of freedom no chance would do that.
  EXPECT_LT(std::pow(by_picture.error(), 2), 0.5 * std::pow(evenly.error(), 2));
}

}  // namespace
}  // namespace wellspring::test
