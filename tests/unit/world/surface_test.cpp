// SPDX-License-Identifier: Apache-2.0
#include "world/surface.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/rng.h"
#include "scenes/build.h"

namespace wellspring::test {
namespace {

vec3 random_direction(Rng& rng) {
  for (;;) {
    float x = rng.uniform(), y = rng.uniform(), z = rng.uniform();
    vec3 v = 2.0f * vec3(x, y, z) - 1.0f;
    if (dot(v, v) > 1e-3f && dot(v, v) < 1) return normalize(v);
  }
}

// The unit square in z = 0, facing +Z, upright picture.
Scene square_scene() {
  Scene scene;
  scene.materials.resize(1);
  Mesh mesh{.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}};
  mesh.normals.assign(4, vec3(0, 0, 1));
  mesh.uv[0] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  scene.meshes.push_back(mesh);
  scene.instances.resize(1);
  scene.instances[0].object = 3;
  scene.objects = {"", "a", "b", "c"};
  return scene;
}

Surface look(const World& world, vec3 origin, vec3 direction) {
  Ray ray{.origin = origin, .direction = normalize(direction)};
  Hit hit = world.intersect(ray);
  EXPECT_TRUE(hit.valid());
  return hit.valid() ? eval_surface(world, ray, hit) : Surface();
}

int add_texel(Scene& scene, std::vector<uint8_t> rgba) {
  return scenes::add_texture(scene, {.width = 1, .height = 1, .texels8 = std::move(rgba)});
}

TEST(Surface, FrontAndBack) {
  Scene scene = square_scene();
  scene.materials[0].emission = vec3(2, 1, 0.5f);
  World world(scene);
  Surface front = look(world, vec3(0.25f, 0.75f, 2), vec3(0, 0, -1));
  EXPECT_TRUE(front.front);
  EXPECT_EQ(front.geometric_normal, vec3(0, 0, 1));
  EXPECT_EQ(front.normal, vec3(0, 0, 1));
  EXPECT_EQ(front.emission, vec3(2, 1, 0.5f));
  EXPECT_EQ(front.object, 3u);
  EXPECT_NEAR(length(front.position - vec3(0.25f, 0.75f, 0)), 0, 1e-6f);
  Surface back = look(world, vec3(0.25f, 0.75f, -2), vec3(0, 0, 1));
  EXPECT_FALSE(back.front);
  EXPECT_EQ(back.geometric_normal, vec3(0, 0, -1));
  EXPECT_EQ(back.normal, vec3(0, 0, -1));
  EXPECT_EQ(back.emission, vec3(0));
  scene.materials[0].double_sided = true;
  EXPECT_EQ(look(world, vec3(0.25f, 0.75f, -2), vec3(0, 0, 1)).emission, vec3(2, 1, 0.5f));
}

TEST(Surface, MirroringKeepsTheFrontInFront) {
  Scene scene = square_scene();
  scene.instances[0].to_world = glm::scale(mat4(1), vec3(-1, 1, 1));
  World world(scene);
  Surface s = look(world, vec3(-0.25f, 0.75f, 2), vec3(0, 0, -1));
  EXPECT_TRUE(s.front);
  EXPECT_EQ(s.normal, vec3(0, 0, 1));
  float area = 0;
  EXPECT_EQ(eval_face(world, 0, 0, &area), vec3(0, 0, 1));
  EXPECT_NEAR(area, 0.5f, 1e-6f);
}

TEST(Surface, NonUniformScaleTurnsNormalsTheRightWay) {
  Scene scene = square_scene();
  scene.meshes[0].normals.assign(4, normalize(vec3(1, 0, 1)));
  scene.instances[0].to_world = glm::scale(mat4(1), vec3(2, 1, 1));
  World world(scene);
  vec3 normal = look(world, vec3(1, 0.5f, 2), vec3(0, 0, -1)).normal;
  EXPECT_NEAR(length(normal - normalize(vec3(0.5f, 0, 1))), 0, 1e-5f);
}

TEST(Surface, MaterialIsFactorTimesTextureTimesVertexColour) {
  Scene scene = square_scene();
  Material& m = scene.materials[0];
  m.base_color = vec4(0.5f, 1, 1, 0.5f);
  m.base_color_texture.texture = add_texel(scene, {255, 127, 255, 255});
  m.metallic = 0.5f;
  m.roughness = 0.8f;
  m.metallic_roughness_texture.texture = add_texel(scene, {255, 51, 102, 255});
  m.transmission = 0.9f;
  m.transmission_texture.texture = add_texel(scene, {51, 255, 255, 255});
  m.thickness = 2;
  m.thickness_texture.texture = add_texel(scene, {0, 51, 0, 0});
  m.emission = vec3(10);
  m.emission_texture.texture = add_texel(scene, {255, 0, 51, 0});
  scene.meshes[0].colors.assign(4, vec4(0.5f, 1, 0.25f, 0.5f));
  World world(scene);
  Surface s = look(world, vec3(0.4f, 0.3f, 2), vec3(0, 0, -1));
  EXPECT_NEAR(length(s.base_color - vec3(0.25f, 127.0f / 255, 0.25f)), 0, 1e-5f);
  EXPECT_NEAR(s.alpha, 0.25f, 1e-5f);
  EXPECT_NEAR(s.roughness, 0.8f * 0.2f, 1e-5f);
  EXPECT_NEAR(s.metallic, 0.5f * 0.4f, 1e-5f);
  EXPECT_NEAR(s.transmission, 0.9f * 0.2f, 1e-5f);
  EXPECT_NEAR(s.thickness, 2 * 0.2f, 1e-5f);
  EXPECT_NEAR(length(s.emission - vec3(10, 0, 2)), 0, 1e-4f);
}

TEST(Surface, TextureTransformAndSecondSetAreUsed) {
  Scene scene = square_scene();
  Image image{.width = 2, .height = 1, .texels8 = {255, 0, 0, 255, 0, 255, 0, 255}};
  TextureRef& reference = scene.materials[0].base_color_texture;
  reference.texture = scenes::add_texture(scene, image, true);
  World world(scene);
  auto red = [&](float x) { return look(world, vec3(x, 0.5f, 2), vec3(0, 0, -1)).base_color.x; };
  EXPECT_EQ(red(0.1f), 1.0f);
  EXPECT_EQ(red(0.9f), 0.0f);
  reference.uv_transform = mat3(1, 0, 0, 0, 1, 0, 0.5f, 0, 1);
  EXPECT_EQ(red(0.1f), 0.0f);
  reference.uv_transform = mat3(1);
  reference.uv_set = 1;
  EXPECT_EQ(red(0.9f), 1.0f);  // a set that is missing reads (0, 0)
  scene.meshes[0].uv[1].assign(4, vec2(0.75f, 0));
  EXPECT_EQ(red(0.1f), 0.0f);
}

// A map that leans to the picture's right must lean along +X, one that leans up along +Y.
TEST(Surface, NormalMapLeansAlongThePicture) {
  for (bool mirrored : {false, true}) {
    Scene scene = square_scene();
    scene.meshes[0].tangents.assign(4, vec4(1, 0, 0, 1));
    int right = add_texel(scene, {218, 128, 218, 255}), up = add_texel(scene, {128, 218, 218, 255});
    if (mirrored) scene.instances[0].to_world = glm::scale(mat4(1), vec3(-1, 1, 1));
    World world(scene);
    float side = mirrored ? -1.0f : 1.0f;
    scene.materials[0].normal_texture.texture = right;
    vec3 n = look(world, vec3(0.5f * side, 0.25f, 2), vec3(0, 0, -1)).normal;
    EXPECT_NEAR(n.x * side, std::sqrt(0.5f), 0.01f);
    EXPECT_NEAR(n.y, 0, 0.01f);
    scene.materials[0].normal_texture.texture = up;
    n = look(world, vec3(0.5f * side, 0.25f, 2), vec3(0, 0, -1)).normal;
    EXPECT_NEAR(n.y, std::sqrt(0.5f), 0.01f);
    EXPECT_NEAR(n.x, 0, 0.01f);
    n = look(world, vec3(0.5f * side, 0.25f, -2), vec3(0, 0, 1))
            .normal;  // from behind: turned over
    EXPECT_NEAR(n.y, -std::sqrt(0.5f), 0.01f);
    EXPECT_LT(n.z, 0);
    scene.materials[0].normal_scale = 0;
    n = look(world, vec3(0.5f * side, 0.25f, 2), vec3(0, 0, -1)).normal;
    EXPECT_NEAR(n.z, 1, 1e-5f);
  }
}

TEST(Surface, ShadingNormalStaysOnTheRaysSide) {
  Scene scene = square_scene();
  Rng rng(3);
  for (int i = 0; i < 200; i++) {
    for (vec3& normal : scene.meshes[0].normals) normal = random_direction(rng);
    World world(scene);
    for (float side : {1.0f, -1.0f}) {
      Surface s = look(world, vec3(0.3f, 0.6f, side), vec3(0, 0, -side));
      EXPECT_NEAR(length(s.normal), 1, 1e-4f);
      EXPECT_GT(dot(s.normal, s.geometric_normal), 0);
      EXPECT_EQ(s.geometric_normal.z, side);
    }
  }
}

TEST(Surface, BadNormalsFallBackToTheFace) {
  Scene scene = square_scene();
  for (vec3 bad : {vec3(0), vec3(std::nanf("")), vec3(INFINITY, 0, 0)}) {
    scene.meshes[0].normals.assign(4, bad);
    EXPECT_EQ(look(World(scene), vec3(0.5f, 0.25f, 1), vec3(0, 0, -1)).normal, vec3(0, 0, 1));
  }
}

// Rays that leave a surface by its own offset origin never meet that surface again.
TEST(Surface, OffsetOriginLeavesTheSurface) {
  Rng rng(17);
  for (float distance : {0.0f, 1.0f, 100.0f, 1e4f})
    for (float size : {0.01f, 1.0f, 300.0f}) {
      Scene scene = square_scene();
      mat4 m = glm::translate(mat4(1), distance * random_direction(rng));
      m = glm::rotate(m, 6 * rng.uniform(), random_direction(rng));
      scene.instances[0].to_world = glm::scale(m, vec3(size));
      World world(scene);
      vec3 normal = eval_face(world, 0, 0);
      int again = 0, tried = 0;
      for (int i = 0; i < 500; i++) {
        float a = rng.uniform(), b = rng.uniform();
        if (a + b > 1) a = 1 - a, b = 1 - b;
        Ray ray;
        vec3 target = eval_position(world, 0, uint32_t(i % 2), vec2(a, b));
        ray.direction = random_direction(rng);
        ray.origin = target - ray.direction * (size * (0.5f + rng.uniform()));
        Hit hit = world.intersect(ray);
        if (!hit.valid() || std::abs(dot(ray.direction, normal)) < 0.05f) continue;
        Surface s = eval_surface(world, ray, hit);
        for (int k = 0; k < 4; k++) {
          Ray leaving{.direction = random_direction(rng)};
          leaving.origin = offset_origin(s, leaving.direction);
          again += world.occluded(leaving);
          tried++;
          float moved = length(leaving.origin - s.position);
          EXPECT_LE(moved, 1e-4f + 2e-4f * (distance + 2 * size));
        }
      }
      EXPECT_GT(tried, 500);
      EXPECT_EQ(again, 0) << "distance " << distance << ", size " << size;
    }
}

TEST(Surface, LayersAreFactorTimesTexture) {
  Scene scene = square_scene();
  Material& m = scene.materials[0];
  int picture = add_texel(scene, {51, 102, 153, 204});
  m.specular = 0.5f;
  m.specular_texture.texture = picture;
  m.specular_color = vec3(2, 1, 0.5f);
  m.specular_color_texture.texture = picture;
  m.clearcoat = 0.5f;
  m.clearcoat_texture.texture = picture;
  m.clearcoat_roughness = 0.5f;
  m.clearcoat_roughness_texture.texture = picture;
  m.sheen_color = vec3(1, 0.5f, 1);
  m.sheen_color_texture.texture = picture;
  m.sheen_roughness = 0.5f;
  m.sheen_roughness_texture.texture = picture;
  World world(scene);
  Surface s = look(world, vec3(0.4f, 0.3f, 2), vec3(0, 0, -1));
  EXPECT_NEAR(s.specular, 0.4f, 1e-6f);
  EXPECT_NEAR(length(s.specular_color - vec3(0.4f, 0.4f, 0.3f)), 0, 1e-6f);
  EXPECT_NEAR(s.clearcoat, 0.1f, 1e-6f);
  EXPECT_NEAR(s.clearcoat_roughness, 0.2f, 1e-6f);
  EXPECT_NEAR(length(s.sheen_color - vec3(0.2f, 0.2f, 0.6f)), 0, 1e-6f);
  EXPECT_NEAR(s.sheen_roughness, 0.4f, 1e-6f);
  EXPECT_EQ(s.anisotropy, 0);
}

// A normal map bends what lies beneath the coat, the coat's own map the coat.
TEST(Surface, TheCoatHasANormalOfItsOwn) {
  Scene scene = square_scene();
  Material& m = scene.materials[0];
  m.clearcoat = 1;
  m.normal_texture.texture = add_texel(scene, {204, 128, 204, 255});
  scene.meshes[0].tangents.assign(4, vec4(1, 0, 0, 1));
  World world(scene);
  Surface s = look(world, vec3(0.4f, 0.3f, 2), vec3(0, 0, -1));
  EXPECT_GT(s.normal.x, 0.5f);
  EXPECT_EQ(s.clearcoat_normal, vec3(0, 0, 1));
  m.clearcoat_normal_texture.texture = add_texel(scene, {128, 204, 204, 255});
  s = look(world, vec3(0.4f, 0.3f, 2), vec3(0, 0, -1));
  EXPECT_GT(s.clearcoat_normal.y, 0.5f);
  m.clearcoat_normal_scale = 0;
  s = look(world, vec3(0.4f, 0.3f, -2), vec3(0, 0, 1));  // from behind
  EXPECT_EQ(s.clearcoat_normal, vec3(0, 0, -1));
}

TEST(Surface, AnisotropyFollowsTheTangentTheAngleAndThePicture) {
  Scene scene = square_scene();
  Material& m = scene.materials[0];
  m.anisotropy = 0.5f;
  World untangled(scene);
  EXPECT_EQ(look(untangled, vec3(0.4f, 0.3f, 2), vec3(0, 0, -1)).anisotropy, 0);  // no direction
  scene.meshes[0].tangents.assign(4, vec4(1, 0, 0, 1));
  World world(scene);
  auto tangent = [&](float side = 2) {
    Surface s = look(world, vec3(0.4f, 0.3f, side), vec3(0, 0, -side));
    EXPECT_GT(s.anisotropy, 0);
    EXPECT_NEAR(length(s.tangent), 1, 1e-6f);
    return s.tangent;
  };
  EXPECT_NEAR(length(tangent() - vec3(1, 0, 0)), 0, 1e-6f);
  m.anisotropy_rotation = pi / 2;  // counter-clockwise
  EXPECT_NEAR(length(tangent() - vec3(0, 1, 0)), 0, 1e-6f);
  EXPECT_NEAR(length(tangent(-2) - vec3(0, 1, 0)), 0, 1e-6f);
  m.anisotropy_texture.texture = add_texel(scene, {128, 255, 102, 255});  // along +v, turned on
  EXPECT_NEAR(length(tangent() - vec3(-1, 0, 0)), 0, 0.01f);
  EXPECT_NEAR(look(world, vec3(0.4f, 0.3f, 2), vec3(0, 0, -1)).anisotropy, 0.2f, 1e-6f);
  scene.meshes[0].tangents.assign(4, vec4(0, 0, 1, 1));  // degenerate: along the normal
  EXPECT_EQ(look(world, vec3(0.4f, 0.3f, 2), vec3(0, 0, -1)).anisotropy, 0);
}

}  // namespace
}  // namespace wellspring::test
