// SPDX-License-Identifier: Apache-2.0
// The shortest way through the shading says what the long one says.
#include "light/material/lambert.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/rng.h"
#include "light/material/bsdf.h"

namespace wellspring::test {
namespace {

float signed_unit(Rng& rng) { return 2 * rng.uniform() - 1; }
vec3 in_box(Rng& rng) {
  float x = signed_unit(rng), y = signed_unit(rng), z = signed_unit(rng);
  return {x, y, z};
}

Material lambertian() {
  return Material{.base_color = {0.7f, 0.5f, 0.2f, 1}, .metallic = 0, .ior = 1};
}

// Triangles all over; every second with normals that lean, the others flat. With vertex colours.
Mesh heap(uint64_t seed) {
  Rng rng(seed);
  Mesh mesh;
  for (uint32_t i = 0; i < 200; i++) {
    vec3 centre = in_box(rng), corner[3];
    for (vec3& p : corner) p = centre + 0.4f * in_box(rng);
    vec3 face = normalize(cross(corner[1] - corner[0], corner[2] - corner[0]));
    for (vec3 p : corner) {
      mesh.positions.push_back(p);
      mesh.normals.push_back(i % 2 ? face : normalize(face + 0.9f * in_box(rng)));
      mesh.colors.push_back({rng.uniform(), rng.uniform(), rng.uniform(), 1});
      mesh.uv[0].push_back({rng.uniform(), rng.uniform()});
    }
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

// One heap where it is, one turned, stretched and mirrored.
Scene heaps() {
  Scene scene;
  scene.materials = {lambertian()};
  Image image{.width = 2, .height = 2};
  for (int i = 0; i < 16; i++) image.texels8.push_back(uint8_t(40 + 13 * i));
  scene.images = {image};
  scene.textures.resize(1);
  scene.textures[0].image = 0;
  scene.materials[0].base_color_texture.texture = 0;
  scene.meshes = {heap(1), heap(2)};
  scene.objects = {""};
  scene.instances.resize(2);
  scene.instances[1].mesh = 1;
  scene.instances[1].to_world =
      glm::scale(glm::rotate(glm::translate(mat4(1), vec3(0.3f, 0, 0.2f)), 0.7f, vec3(1, 1, 0)),
                 vec3(-1, 0.6f, 1.3f));
  return scene;
}

template <class See>
int for_each_hit(const World& world, const See& see) {
  Rng rng(5);
  int hits = 0;
  for (int i = 0; i < 4000; i++) {
    Ray ray{.origin = 3.0f * normalize(in_box(rng))};
    ray.direction = normalize(in_box(rng) - ray.origin);
    Hit hit = world.intersect(ray);
    if (!hit.valid()) continue;
    hits++;
    see(ray, hit);
  }
  return hits;
}

TEST(Lambert, SurfacesAreThoseOfTheLongWay) {
  Scene scene = heaps();
  std::vector<Mesh> moving = {heap(3)};
  World world(scene, moving);
  int moved = 0;
  int hits = for_each_hit(world, [&](const Ray& ray, const Hit& hit) {
    Surface all = eval_surface(world, ray, hit);
    LambertSurface few = eval_lambert_surface(world, ray, hit);
    moved += world.is_moving(hit.instance);
    EXPECT_EQ(few.position, all.position);
    EXPECT_EQ(few.extent, all.extent);
    EXPECT_EQ(few.geometric_normal, all.geometric_normal);
    EXPECT_LE(length(few.normal - all.normal), 1e-6f);
    EXPECT_EQ(few.base_color, all.base_color);
    // Both face the ray and are on it, as nearly as a triangle seen along its plane allows.
    float rounding = 1e-6f / std::max(std::abs(dot(few.geometric_normal, ray.direction)), 1e-3f);
    EXPECT_LE(length(few.position - (ray.origin + hit.t * ray.direction)), 10 * rounding);
    EXPECT_LE(dot(few.geometric_normal, ray.direction), 0);
  });
  EXPECT_GT(hits, 2000);
  EXPECT_GT(moved, 100);
}

// A triangle's kept surface and one that is made on the way for a moving mesh are the same.
TEST(Lambert, StillAndMovingMeshesLookTheSame) {
  Scene still = heaps(), empty = heaps();
  still.instances.resize(1);
  empty.instances.clear();
  World kept(still), made(empty, {still.meshes[0]});
  int hits = for_each_hit(kept, [&](const Ray& ray, const Hit& hit) {
    Hit same = made.intersect(ray);
    ASSERT_TRUE(same.valid());
    ASSERT_EQ(same.triangle, hit.triangle);
    LambertSurface a = eval_lambert_surface(kept, ray, hit),
                   b = eval_lambert_surface(made, ray, same);
    EXPECT_LE(length(a.position - b.position), 1e-5f);
    EXPECT_LE(length(a.normal - b.normal), 1e-4f);
    EXPECT_LE(length(a.base_color - b.base_color), 1e-3f);
  });
  EXPECT_GT(hits, 1000);
}

TEST(Lambert, LobesAreThoseOfTheLongWay) {
  Scene scene = heaps();
  World world(scene);
  const Material& material = scene.materials[0];
  const DielectricAlbedo& albedo = dielectric_albedo(material.ior);
  Rng rng(9);
  for_each_hit(world, [&](const Ray& ray, const Hit& hit) {
    Bsdf bsdf = make_bsdf(eval_surface(world, ray, hit), material, ray.direction, albedo);
    LambertLobe lobe = make_lambert(eval_lambert_surface(world, ray, hit), ray.direction);
    vec3 way = normalize(in_box(rng));
    BsdfValue value = eval_bsdf(bsdf, way);
    float pdf = eval_lambert_pdf(lobe, way);
    EXPECT_NEAR(pdf, sample_bsdf_pdf(bsdf, value, Lobes::all), 1e-5f);
    EXPECT_LE(length(lobe.reflectance * pdf - value.diffuse - value.specular), 1e-5f);
    Sampler a(rng.next()), b(a);
    BsdfSample all = sample_bsdf(bsdf, Lobes::all, a);
    b.seek(1);
    BsdfSample few = sample_lambert(lobe, b.next2());
    EXPECT_LE(length(all.weight - few.weight), 1e-5f);
    if (!(all.pdf > 0)) return;
    EXPECT_LE(length(all.direction - few.direction), 1e-4f);
    EXPECT_NEAR(all.pdf, few.pdf, 1e-4f);
  });
}

TEST(Lambert, MaterialsWithMoreToThemAreNot) {
  EXPECT_TRUE(is_lambertian(lambertian()));
  auto is = [](auto change) {
    Material m = lambertian();
    change(m);
    return is_lambertian(m);
  };
  EXPECT_FALSE(is_lambertian(Material()));
  EXPECT_TRUE(is([](Material& m) { m.ior = 1.5f, m.specular = 0; }));
  EXPECT_FALSE(is([](Material& m) { m.ior = 1.5f; }));
  EXPECT_FALSE(is([](Material& m) { m.ior = 0; }));
  EXPECT_FALSE(is([](Material& m) { m.metallic = 0.1f; }));
  EXPECT_FALSE(is([](Material& m) { m.transmission = 0.1f; }));
  EXPECT_FALSE(is([](Material& m) { m.emission = vec3(0, 0, 1); }));
  EXPECT_FALSE(is([](Material& m) { m.unlit = true; }));
  EXPECT_FALSE(is([](Material& m) { m.clearcoat = 0.1f; }));
  EXPECT_FALSE(is([](Material& m) { m.sheen_color = vec3(0.1f); }));
  EXPECT_FALSE(is([](Material& m) { m.normal_texture.texture = 0; }));
}

}  // namespace
}  // namespace wellspring::test
