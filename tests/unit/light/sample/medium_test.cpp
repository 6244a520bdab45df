// SPDX-License-Identifier: Apache-2.0
// What rays run in: the stack itself, where it begins, and light that takes the same way backwards.
#include "light/sample/medium.h"

#include "unit/light/judge.h"
#include "light/walk/light_walk.h"
#include "light/sample/lights.h"
#include "unit/light/technique/slabs.h"
#include "unit/light/statistics.h"

namespace wellspring::test {
namespace {

using namespace scenes;

std::vector<int> listed(const MediumStack& stack) {
  return {stack.material, stack.material + stack.count};
}

// Spheres of two materials in each other: 1 of radius 3 and 1, 2 of radius 2.
Scene make_onion() {
  Scene scene = empty_scene();
  int glass = add_material(scene, tinted_glass(1.5f, 0.6)),
      water = add_material(scene, tinted_glass(1.33f, 0.3));
  add_mesh(scene, sphere_mesh(glass, 3), "outer");
  add_mesh(scene, sphere_mesh(water, 2), "middle");
  add_mesh(scene, sphere_mesh(glass, 1), "core");
  scene.environment.radiance = vec3(1);
  return scene;
}

TEST(Media, TheLatestOfAMaterialIsLeft) {
  MediumStack stack;
  EXPECT_EQ(stack.innermost(), -1);
  leave_solid(stack, 7);
  EXPECT_EQ(stack.count, 0);
  for (int m : {1, 2, 1}) enter_solid(stack, m);
  leave_solid(stack, 1);
  EXPECT_EQ(listed(stack), (std::vector<int>{1, 2}));
  leave_solid(stack, 1);
  EXPECT_EQ(listed(stack), (std::vector<int>{2}));
  for (int m : {3, 4, 5, 6}) enter_solid(stack, m);
  EXPECT_EQ(listed(stack), (std::vector<int>{3, 4, 5, 6})) << "the outermost is forgotten";
}

TEST(Media, APlaceKnowsWhatIsAroundIt) {
  Scene scene = make_onion();
  add_quad(scene, 1, {-20, 5, -20}, {40, 0, 0}, {0, 0, 40}, "open, seen from behind");
  World world(scene);
  Lights lights = make_lights(world);
  Transport transport{world, *lights.tables};
  for (int again = 0; again < 2; again++) {
    EXPECT_EQ(listed(find_media(transport, {0.2f, 0.1f, -0.1f})), (std::vector<int>{1, 2, 1}));
    EXPECT_EQ(listed(find_media(transport, {1.4f, 0.2f, 0.1f})), (std::vector<int>{1, 2}));
    EXPECT_EQ(listed(find_media(transport, {0, 0.1f, 2.4f})), (std::vector<int>{1}));
    EXPECT_EQ(listed(find_media(transport, {2.9f, 2.9f, 2.9f})), (std::vector<int>{}));
    EXPECT_EQ(listed(find_media(transport, {0, -9, 0})), (std::vector<int>{}));
  }
  Scene other = empty_scene();
  add_sphere(other, tinted_glass(1.2f, 0.5), 3, "alone");
  World second(other);
  Lights tables = make_lights(second);
  EXPECT_EQ(listed(find_media({second, *tables.tables}, {0, -9, 0})), (std::vector<int>{}));
  EXPECT_EQ(listed(find_media({second, *tables.tables}, {0.2f, 0.1f, -0.1f})),
            (std::vector<int>{1}));
}

// From under the block the eye leaves water through glass that touches it, whichever of the
// coincident faces the tree finds first.
TEST(Media, CoincidentFacesAreOneBoundary) {
  Scene scene = empty_scene();
  int glass = add_material(scene, tinted_glass(1.5f, 0.6)),
      water = add_material(scene, tinted_glass(1.33f, 0.3));
  add_slab(scene, glass, 0, 1);
  add_slab(scene, water, -1, 0);
  World world(scene);
  Lights lights = make_lights(world);
  Transport transport{world, *lights.tables};
  Sampler sampler(1, 0);
  for (int i = 0; i < 200; i++) {
    vec2 p = 1.9f * sampler.next2() - vec2(0.95f);
    bool down = i % 2;
    Ray ray = ray_towards({p.x, p.y, down ? 0.5f : -0.5f}, {0.3f * p.x, p.x, 0});
    Media media;
    enter_solid(media.here, down ? glass : water);
    Hit hit = world.intersect(ray);
    meet_surface(transport, ray, hit, media);
    ASSERT_EQ(listed(media.here), (std::vector<int>{down ? glass : water}));
    ASSERT_EQ(listed(media.beyond), (std::vector<int>{down ? water : glass}));
  }
}

// A body within another of the same index changes no picture.
TEST(Media, EqualIndicesAreInvisible) {
  auto picture = [](bool nested) {
    Scene scene = empty_scene();
    for (int i = 0; i < 6; i++)  // stripes
      add_quad(scene, emitter(vec3(1 + float(i % 3))), {-3 + float(i), -3, -2}, {1, 0, 0},
               {0, 6, 0}, "backdrop");
    scene.environment.radiance = vec3(0.5f);
    int outer = add_material(scene, glass(1.5f, 0, 1)),
        inner = add_material(scene, glass(1.5f, 0, 1));
    add_mesh(scene, sphere_mesh(outer, 0.16f), "outer", at({0, 0.3f, -0.2f}));
    if (nested) add_mesh(scene, sphere_mesh(inner, 0.1f), "inner", at({0.03f, 0.3f, -0.2f}));
    return scene;
  };
  Scene with = picture(true), without = picture(false);
  Family family;
  const Technique& path = *find_technique("path");
  TransportSettings deep{.max_depth = 40};
  auto estimate = [&](const Scene& scene, vec3 target, uint64_t seed) {
    World world(scene);
    View view = make_view_towards(scene, {0, 0.3, 0.5}, dvec3(target), {0, 1, 0}, 0.08f, 8, 8);
    return estimate_radiance(path, world, make_lights(world), view, deep, {16, 64, seed});
  };
  for (vec3 target : {vec3(0, 0.3f, -0.2f), vec3(0.09f, 0.36f, -0.2f), vec3(0.13f, 0.3f, -0.2f)})
    family.add_same("through the ball", estimate(with, target, 1), estimate(without, target, 2));
  expect_family(family);
}

// Flux that passes a stack of slabs is the share of radiance that does, from either side, from
// outside and from a lamp in the middle.
TEST(Media, LightPassesStacksAsTheEyeDoes) {
  Scene scene = empty_scene();
  int glass = add_material(scene, tinted_glass(1.5f, 0.6)),
      water = add_material(scene, tinted_glass(1.33f, 0.3));
  add_slab(scene, glass, -0.5f, 0.5f);
  add_slab(scene, water, -0.2f, 0.3f, 1.5f);
  int dark = add_material(scene, emitter(vec3(1)));
  for (float z : {-3.0f, 3.0f}) add_wall(scene, dark, z, 9, "quad");
  World world(scene);
  Lights lights = make_lights(world);
  Transport transport{world, *lights.tables};
  Layer above{1.5, std::pow(0.6, 0.2)}, middle{1.33, std::pow(0.3, 0.5)},
      below{1.5, std::pow(0.6, 0.3)}, air;
  double through = see_through(1, std::vector<Layer>{above, middle, below, air}).passes;
  double half = std::pow(0.3, 0.25);
  Slab up = see_through(1.33, std::vector<Layer>{above, air}),
       down = see_through(1.33, std::vector<Layer>{below, air});
  double echo = 1 - up.reflects * down.reflects * std::pow(half, 4);
  struct Start {
    float from, towards, ends;
    double expected;
  };
  Family family;
  for (const Start& start :
       {Start{2, -1, -3, through}, Start{-2, 1, 3, through},
        Start{0.05f, -1, -3, down.passes * half / echo},
        Start{0.05f, 1, -3, up.reflects * half * half * down.passes * half / echo}}) {
    std::vector<double> replicates(16);
    parallel_for(int(replicates.size()), [&](int replicate) {
      size_t k = size_t(replicate);
      constexpr int walks = 2048;
      for (int i = 0; i < walks; i++) {
        Sampler sampler(mix64(k + 77), uint32_t(i));
        LightWalk walk;
        walk.ray.origin = {0.1f, 0.23f, start.from};
        walk.ray.direction = {0, 0, start.towards};
        walk.flux = vec3(1);
        Arrival arrival;
        while (arrive(transport, walk, arrival)) {
          if (arrival.surface.material == dark) {
            if (arrival.surface.position.z * start.ends > 0)
              replicates[k] += double(walk.flux.x) / walks;
            break;
          }
          BsdfSample scattered = sample_bsdf(arrival.bsdf, Lobes::all, sampler);
          if (!scatter(walk, arrival, scattered, sampler)) break;
        }
      }
    });
    family.add("light from " + std::to_string(start.from), make_estimate(replicates),
               start.expected);
  }
  expect_family(family, 0.15);
}

}  // namespace
}  // namespace wellspring::test
