// SPDX-License-Identifier: Apache-2.0
#include "show/moving/figure.h"

#include <gtest/gtest.h>

namespace wellspring::test {
namespace {

// Two parts that share two vertices; everything follows one joint.
Character make_character() {
  Character character{.name = "Two parts"};
  character.joints.resize(1);
  character.joints[0].name = "humanoid_root";
  character.appearances = {
      {.name = "red", .base_color = {1, 0, 0}, .roughness = 0.3f},
      {.name = "glass", .base_color = {0, 1, 0}, .alpha = 0.5f, .double_sided = true}};
  character.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  character.normals.assign(4, {0, 0, 1});
  character.uv = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
  character.parts = {{.name = "low", .appearance = 0, .triangles = {{0, 1, 2}}},
                     {.name = "high", .appearance = 1, .triangles = {{1, 3, 2}}}};
  character.first_weight = {0, 1, 2, 3, 4};
  character.weights.assign(4, {0, 1});
  return character;
}

TEST(Figure, EachPartHasItsOwnVerticesOnly) {
  Character character = make_character();
  Scene scene;
  scene.materials.resize(3);
  std::vector<Mesh> moving;
  std::vector<uint32_t> objects;
  Figure figure = make_figure(character, scene, moving, objects);
  ASSERT_EQ(moving.size(), 2u);
  ASSERT_EQ(scene.materials.size(), 5u);
  EXPECT_EQ(moving[1].material, 4);
  EXPECT_EQ(scene.materials[4].alpha_mode, AlphaMode::blend);
  EXPECT_TRUE(scene.materials[4].double_sided);
  EXPECT_FLOAT_EQ(scene.materials[3].roughness, 0.3f);
  EXPECT_EQ(moving[0].positions.size(), 3u);
  EXPECT_EQ(moving[1].positions.size(), 3u);
  EXPECT_EQ(moving[1].uv[0][1], vec2(1, 1));
  EXPECT_EQ(figure.parts[1].vertices, (std::vector<uint32_t>{1, 3, 2}));
  EXPECT_EQ(scene.objects[figure.object], "Two parts");
  EXPECT_EQ(objects, (std::vector<uint32_t>{figure.object, figure.object}));
}

TEST(Figure, MovesInTheWorldAndHides) {
  Character character = make_character();
  Scene scene;
  std::vector<Mesh> moving;
  std::vector<uint32_t> objects;
  Figure figure = make_figure(character, scene, moving, objects);
  World world(scene, std::move(moving), std::move(objects));
  SkinScratch scratch;
  Pose pose = make_rest_pose(character);
  pose.translation = {0, 0, 2};
  pose_figure(world, figure, character, pose, glm::translate(mat4(1), vec3(5, 0, 0)), scratch);
  world.commit();
  auto hit_at = [&](float x, float y) {
    return world.intersect({.origin = {x, y, 10}, .direction = {0, 0, -1}});
  };
  for (vec2 p : {vec2(5.2f, 0.2f)}) {
    Hit hit = hit_at(p.x, p.y);
    ASSERT_TRUE(hit.valid());
    EXPECT_NEAR(hit.t, 8, 1e-4f);
    EXPECT_EQ(world.object_of(hit.instance), figure.object);
  }
  EXPECT_FALSE(hit_at(0.2f, 0.2f).valid());
  show_figure(world, figure, false);
  world.commit();
  EXPECT_FALSE(hit_at(5.2f, 0.2f).valid());
  show_figure(world, figure, true);
  world.commit();
  EXPECT_TRUE(hit_at(5.2f, 0.2f).valid());
}

TEST(Figure, AMissingPictureIsAWarningOfTheScene) {
  Character character = make_character();
  character.appearances[0].texture = "/nonexistent/picture.png";
  Scene scene;
  std::vector<Mesh> moving;
  std::vector<uint32_t> objects;
  make_figure(character, scene, moving, objects);
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_NE(scene.warnings[0].find("picture.png"), std::string::npos);
  EXPECT_EQ(scene.materials[0].base_color_texture.texture, -1);
}

}  // namespace
}  // namespace wellspring::test
