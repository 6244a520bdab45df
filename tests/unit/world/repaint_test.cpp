// SPDX-License-Identifier: Apache-2.0
// Materials of what moves change while a World lives.
#include <gtest/gtest.h>

#include "world/surface.h"

namespace wellspring::test {
namespace {

// Two squares side by side that move and wear one material, one that moves and wears another, and
// one that stands still and wears the first.
struct Stage {
  Scene scene;
  std::vector<Mesh> moving;

  explicit Stage(AlphaMode mode = AlphaMode::opaque) {
    scene.objects = {"", "still", "figure"};
    Image image{
        .width = 2, .height = 1, .srgb = false, .texels = {vec4(1, 0, 0, 1), vec4(0, 1, 0, 1)}};
    scene.images.push_back(image);
    scene.textures.push_back({.image = 0, .nearest = true});
    Material painted{.base_color = vec4(0.5f, 0.5f, 0.5f, 1)};
    painted.base_color_texture.texture = 0;
    painted.alpha_mode = mode;
    painted.metallic = 0;
    painted.repaints = true;
    Material plain = painted;
    plain.repaints = false;
    scene.materials = {painted, plain};
    auto square = [](float x, int material) {
      Mesh mesh{.positions = {{x, 0, 0}, {x + 1, 0, 0}, {x + 1, 1, 0}, {x, 1, 0}}};
      mesh.normals.assign(4, vec3(0, 0, 1));
      mesh.uv[0].assign(4, vec2(0.25f, 0.5f));  // the red texel
      mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
      mesh.material = material;
      return mesh;
    };
    scene.meshes = {square(6, 0)};
    scene.instances = {{0, mat4(1), 1}};
    moving = {square(0, 0), square(2, 0), square(4, 1)};
  }
  World world() { return World(scene, moving, {2, 2, 2}); }
};

Ray ray_at(float x) { return {.origin = {x + 0.6f, 0.3f, 5}, .direction = {0, 0, -1}}; }
Surface look(const World& world, float x) {
  Hit hit = world.intersect(ray_at(x));
  EXPECT_TRUE(hit.valid()) << x;
  return hit.valid() ? eval_surface(world, ray_at(x), hit) : Surface();
}

TEST(Repaint, ChangesWhatMovesAndNothingElse) {
  Stage stage;
  World world = stage.world();
  EXPECT_EQ(look(world, 0).base_color, vec3(0.5f, 0, 0));
  EXPECT_EQ(world.paints(), 0u);
  Repaint change{vec4(0.25f, -0.25f, 9, 0), vec3(2, 0, -1), mat3(0.0f)};
  world.repaint(0, change);
  EXPECT_EQ(world.paints(), 1u);
  for (float x : {0.0f, 2.0f}) {
    EXPECT_EQ(look(world, x).base_color, vec3(0.75f, 0, 0)) << x;
    EXPECT_EQ(look(world, x).emission, vec3(2, 0, 0)) << "never less than none";
  }
  EXPECT_EQ(world.material_of(1).base_color, vec4(0.75f, 0.25f, 1, 1)) << "within its range";
  for (float x : {4.0f, 6.0f}) {
    EXPECT_EQ(look(world, x).base_color, vec3(0.5f, 0, 0)) << x;
    EXPECT_EQ(look(world, x).emission, vec3(0)) << x;
  }
  EXPECT_EQ(stage.scene.materials[0].base_color, vec4(0.5f, 0.5f, 0.5f, 1))
      << "the scene is as it was";
  EXPECT_EQ(world.placed(1).paints, 1u);
  EXPECT_EQ(world.placed(0).paints + world.placed(3).paints, 0u);
  // A change counts from the scene's material, and pictures lie elsewhere.
  Repaint moved;
  moved.uv[2].x = 0.5f;
  world.repaint(0, moved);
  EXPECT_EQ(look(world, 2).base_color, vec3(0, 0.5f, 0)) << "the green texel";
  EXPECT_EQ(look(world, 2).emission, vec3(0));
  world.repaint(1, change);
  EXPECT_EQ(look(world, 4).base_color, vec3(0.5f, 0, 0)) << "it does not repaint";
  EXPECT_EQ(world.paints(), 2u);
  world.repaint(0, {vec4(NAN), vec3(INFINITY), mat3(NAN)});
  EXPECT_EQ(look(world, 2).base_color, vec3(0.5f, 0, 0)) << "what is not finite changes nothing";
  world.repaint(-1, change);
  world.repaint(99, change);
}

// An opaque surface may be seen through later: the ray tracer must have been made for that.
TEST(Repaint, MayLetRaysThrough) {
  for (AlphaMode mode : {AlphaMode::mask, AlphaMode::blend}) {
    Stage stage(mode);
    for (Mesh& mesh : stage.moving) mesh.uv[0].clear();
    stage.scene.materials[0].base_color_texture = {};
    World world = stage.world();
    EXPECT_TRUE(world.intersect(ray_at(0)).valid());
    EXPECT_TRUE(world.occluded(ray_at(0)));
    world.repaint(0, {vec4(0, 0, 0, -1), vec3(0), mat3(0.0f)});
    EXPECT_FALSE(world.intersect(ray_at(0)).valid());
    EXPECT_FALSE(world.occluded(ray_at(2)));
    world.repaint(0, {});
    EXPECT_TRUE(world.intersect(ray_at(0)).valid());
  }
}

}  // namespace
}  // namespace wellspring::test
