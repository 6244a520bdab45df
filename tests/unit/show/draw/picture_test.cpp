// SPDX-License-Identifier: Apache-2.0
// A visitor's pictures where hardly anything can be rasterised.
#include "show/draw/picture.h"

#include <gtest/gtest.h>

#include "unit/show/show_stage.h"

namespace wellspring::test {
namespace {

// The viewpoint's eye in the middle of a cube of solid glass, or of one that is nothing but pale.
Exhibit make_cubed(bool glass) {
  Exhibit exhibit = make_tiny_exhibit();
  exhibit.tours.clear();  // it stands in their way
  Material material{.metallic = 0, .roughness = 0};
  if (glass) material.transmission = 1, material.thickness = 1;
  exhibit.scene.materials.push_back(material);
  Mesh cube{.material = int(exhibit.scene.materials.size()) - 1};
  vec3 corner(-3, 0.6f, 2), x(2, 0, 0), y(0, 2, 0), z(0, 0, 2);
  add_quad(cube, corner, y, x), add_quad(cube, corner + z, x, y);
  add_quad(cube, corner, z, y), add_quad(cube, corner + x, y, z);
  add_quad(cube, corner, x, z), add_quad(cube, corner + y, z, x);
  exhibit.scene.meshes.push_back(cube);
  exhibit.scene.objects.push_back("cube");
  exhibit.scene.instances.push_back({2, mat4(1), 3});
  return exhibit;
}

TEST(Picture, IsRightForAnEyeInSolidGlassToo) {
  for (bool glass : {true, false}) {
    ShowStage stage;  // a visitor of the first viewpoint, after two seconds
    stage.tick_seconds = 0.05;
    stage.begin(make_cubed(glass), settings_for("direct"));
    stage.join(160, 90);
    stage.run(2);
    const View& view = stage.visitor().place.last_view;
    EXPECT_EQ(stage.show->stage.visibility->rasterises(view), !glass);
    Image8 truth = stage.truth(view, 64), shown = stage.last_image();
    ASSERT_EQ(shown.rgb.size(), truth.rgb.size());
    double light = 0, shown_light = 0;
    for (size_t i = 0; i < truth.rgb.size(); i++)
      light += truth.rgb[i], shown_light += shown.rgb[i];
    if (glass) {
      EXPECT_GT(light, 20 * double(truth.rgb.size())) << "else there is nothing to see";
    }
    EXPECT_LT(mean_difference(shown, truth), 7) << glass;
    EXPECT_NEAR(shown_light, light, 0.05 * light) << glass;
  }
}

}  // namespace
}  // namespace wellspring::test
