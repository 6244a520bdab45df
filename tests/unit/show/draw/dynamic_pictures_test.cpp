// SPDX-License-Identifier: Apache-2.0
// Lights that move are seen in the pictures of who walks and of who rests, as if they stood where
// they are; what is kept of light does not know them.
#include <gtest/gtest.h>

#include "light/technique/technique.h"
#include "show/state/renderer.h"
#include "show/state/lamps.h"
#include "show/state/visitor_picture.h"
#include "unit/folder.h"
#include "unit/show/show_stage.h"

namespace wellspring::test {
namespace {

// A torch that is carried to and fro, ten metres in as many seconds.
ChangingLight torch() {
  ChangingLight light{.name = "torch"};
  light.light.intensity = vec3(14, 9, 4);
  light.light.position = {-1, 1.5f, 2};
  light.track = {{0, {-1, 1.5f, 2}}, {4, {1, 2.2f, 1}}, {8, {-1, 1.5f, 2}}};
  return light;
}

struct DynamicPictures : testing::Test, ShowStage {
  test::Folder folder;
  void begin_with(std::vector<ChangingLight> lights) {
    begin_with(std::move(lights), settings_for("direct", 50));
  }
  void begin_with(std::vector<ChangingLight> lights, const ShowSettings& settings) {
    Exhibit exhibit = make_tiny_exhibit();
    exhibit.lights = std::move(lights);
    begin(std::move(exhibit), settings);
    join(96, 64);
  }
  // Returns the picture with the light that the lights add at a time, straight and scattered once.
  Image8 lit_truth(double time) {
    const View& view = visitor().place.last_view;
    StillSettings settings{.spp = 64};
    settings.transport = show->settings.transport;
    Frame sum = render_still(*show->stage.still_technique, *show->stage.world, show->stage.lights,
                             view, settings);
    Scene scene = show->stage.exhibit.scene;
    for (Material& material : scene.materials) material.emission = vec3(0);
    for (const DynamicLight& one : dynamic_lights_of(*show, visitor(), time))
      scene.lights.push_back(one.light);
    World world(scene);
    settings.transport.max_depth = 3;
    const Frame added =
        render_still(*find_technique("path"), world, make_lights(world), view, settings);
    for (size_t i = 0; i < sum.color.size(); i++) sum.color[i] += added.color[i];
    Image8 picture;
    tonemap(sum, Tonemap{show->stage.exhibit.exposure}, picture);
    return picture;
  }
  Image8 dark_truth() { return truth(visitor().place.last_view, 64); }
  void expect_lit(double most) {
    const Image8 shown = last_image();
    EXPECT_LT(mean_difference(shown, lit_truth(show->time)), most);
    EXPECT_GT(mean_difference(shown, dark_truth()), 3 * most);
  }
};

TEST_F(DynamicPictures, AreLitAtRest) {
  begin_with({torch()});
  run(6);
  EXPECT_TRUE(last_header().flags & packet_still);
  EXPECT_TRUE(visitor().picture->backdrop);
  expect_lit(4);
  // The picture that stays does not know it.
  Image8 still;
  const Keyframe& keyframe = visitor().picture->keyframe;
  still.width = keyframe.view.width, still.height = keyframe.view.height;
  for (int i = 0; i < still.width * still.height; i++)
    for (int c : {0, 8, 16}) still.rgb.push_back(uint8_t(keyframe.color[size_t(i)] >> c));
  EXPECT_LT(mean_difference(still, dark_truth()), 4);
}

TEST_F(DynamicPictures, FollowTheLight) {
  begin_with({torch()});
  run(6);
  const size_t before = pictures().size();
  const Image8 earlier = last_image();
  run(1.5);
  EXPECT_GT(pictures().size(), before + 15) << "pictures come while it moves";
  EXPECT_GT(mean_difference(earlier, last_image()), 3);
  expect_lit(4);
}

// The bounce of a light that stays as it is becomes better from picture to picture.
TEST_F(DynamicPictures, GatherTheBounceOfALightThatStays) {
  ChangingLight stays = torch();
  stays.track.clear();
  begin_with({stays});
  run(5);
  const int passes = visitor().picture->settled.passes;
  EXPECT_GT(passes, 3);
  run(6);
  EXPECT_GT(visitor().picture->settled.passes, passes);
  expect_lit(4);
  begin_with({torch()});
  run(5);
  EXPECT_EQ(visitor().picture->settled.passes, 0) << "it never stays";
}

TEST_F(DynamicPictures, AreLitOnTheWay) {
  begin_with({torch()});
  for (int i = 0; i < 100; i++) turn(0.01), step();
  EXPECT_FALSE(last_header().flags & packet_still);
  expect_lit(8);
}

// The maps' own light, found at the start, is off by some codes.
TEST_F(DynamicPictures, AreLitOverIlluminationMaps) {
  ShowSettings settings = settings_for("gather", 50);
  settings.cache = folder.path.string();
  begin_with({torch()}, settings);
  ASSERT_TRUE(show->stage.lights.maps);
  for (int i = 0; i < 100; i++) turn(0.01), step();
  EXPECT_FALSE(last_header().flags & packet_still);
  expect_lit(9);
  run(6);
  EXPECT_TRUE(last_header().flags & packet_still);
  expect_lit(9);
}

// When it goes out the picture is again what stands still.
TEST_F(DynamicPictures, BecomeDarkAgain) {
  ChangingLight ends = torch();
  ends.loop = false;
  ends.track = {{0, {-1, 1.5f, 2}}, {3, {-1, 1.5f, 2}}, {3.5, {-1, 1.5f, 2}, {0, 0, -1}, 0}};
  begin_with({ends});
  run(2.5);
  expect_lit(4);
  run(4);
  EXPECT_TRUE(visitor().dynamic.empty());
  EXPECT_LT(mean_difference(last_image(), dark_truth()), 4);
  const size_t before = pictures().size();
  run(1);
  EXPECT_LT(pictures().size(), before + 15) << "nothing moves any more";
}

// One of a reach is not computed for pictures that it does not touch.
TEST_F(DynamicPictures, PayNothingForLightOutOfReach) {
  ChangingLight near = torch(), behind = torch();
  near.track.clear(), behind.track.clear();
  near.flicker = behind.flicker = {0.5f, 4};
  near.light.range = behind.light.range = 1.5f;
  behind.light.position = {-2, 1.6f, 5.5f};
  behind.name = "behind";
  begin_with({near, behind});  // the visitor stands at (-2, 1.6, 3) and looks down -z
  run(2);
  ASSERT_EQ(visitor().dynamic.size(), 1u);
  EXPECT_EQ(visitor().dynamic[0].id, first_changing_light);
  begin_with({behind});
  run(3);
  EXPECT_TRUE(visitor().dynamic.empty());
  EXPECT_EQ(memory_bytes(show->drawing->renderer.work.dynamic), 0u);
}

// Without such lights nothing of them is computed, and no memory is held for them.
TEST_F(DynamicPictures, CostNothingWhereThereAreNone) {
  begin_with({});
  run(1);
  for (int i = 0; i < 20; i++) turn(0.01), step();
  EXPECT_EQ(memory_bytes(show->drawing->renderer.work.dynamic), 0u);
  begin_with({torch()});
  run(1);
  EXPECT_GT(memory_bytes(show->drawing->renderer.work.dynamic), 0u);
}

}  // namespace
}  // namespace wellspring::test
