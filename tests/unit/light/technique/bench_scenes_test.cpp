// SPDX-License-Identifier: Apache-2.0
// The benchmark's scenes are what its report says they are.
#include <gtest/gtest.h>

#include <filesystem>

#include "light/transport_plan.h"
#include "scenes/scenes.h"
#include "world/load/scene_load.h"

namespace wellspring::test {
namespace {

using enum light::TransportPart;

Scene load(const std::string& name) {
  Scene scene =
      load_scene(std::string(WELLSPRING_SOURCE) + "/tests/benchmark/scenes/" + name + ".glb");
  EXPECT_TRUE(scene.warnings.empty()) << scene.warnings[0];
  EXPECT_EQ(scene.viewpoints.size(), 1u);
  return scene;
}

// Every corner of every triangle, instance by instance, in scene coordinates.
std::vector<vec3> corners(const Scene& scene) {
  std::vector<vec3> all;
  for (const Instance& instance : scene.instances)
    for (uvec3 t : scene.meshes[size_t(instance.mesh)].triangles)
      for (uint32_t v : {t.x, t.y, t.z})
        all.push_back(
            vec3(instance.to_world * vec4(scene.meshes[size_t(instance.mesh)].positions[v], 1)) +
            vec3(scene.origin));
  return all;
}

TEST(BenchScenes, TheCornellBoxIsTheOneInCode) {
  Scene file = load("cornell_box"), code = scenes::make_cornell_box();
  std::vector<vec3> a = corners(file), b = corners(code);
  ASSERT_EQ(a.size(), b.size());
  // Boxes list their faces in their own order: every corner must be one of the other's.
  for (const vec3& p : a) {
    float nearest = 1;
    for (const vec3& q : b) nearest = std::min(nearest, length(p - q));
    EXPECT_LT(nearest, 2e-4f) << p.x << " " << p.y << " " << p.z;
  }
  View view = scenes::cornell_view(code, 100, 100);
  EXPECT_LT(length(vec3(file.viewpoints[0].position - file.origin) - view.position), 1e-5f);
  EXPECT_NEAR(std::tan(file.viewpoints[0].fov / 2), view.tan_half_fov, 1e-5f);
  TransportPlan plan = make_transport_plan(file);
  for (size_t i = 0; i < transport_parts; i++)
    EXPECT_EQ(plan.uses(TransportPart(i)),
              TransportPart(i) == area_lights || TransportPart(i) == kept_light)
        << transport_part_name(TransportPart(i));
}

TEST(BenchScenes, TheHallIsDiffuse) {
  TransportPlan plan = make_transport_plan(load("diffuse_hall"));
  EXPECT_TRUE(plan.uses(area_lights));
  for (TransportPart part : {caustics, panes, refraction, coats, dispersion})
    EXPECT_FALSE(plan.uses(part)) << transport_part_name(part);
}

TEST(BenchScenes, TheTableHasAllKindsOfGlass) {
  TransportPlan plan = make_transport_plan(load("caustics"));
  for (TransportPart part : {caustics, refraction, absorption, dispersion})
    EXPECT_TRUE(plan.uses(part)) << transport_part_name(part);
}

TEST(BenchScenes, TheConferenceRoomHas104Lights) {
  Scene scene = load("conference");
  size_t triangles = 0;
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[size_t(instance.mesh)];
    if (max_component(scene.materials[size_t(mesh.material)].emission) > 0)
      triangles += mesh.triangles.size();
  }
  EXPECT_EQ(triangles, 2u * 104u);
}

}  // namespace
}  // namespace wellspring::test
