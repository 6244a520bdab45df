// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <functional>
#include <set>

#include "light/kept/bake_file.h"
#include "unit/light/kept/bake_cases.h"

namespace wellspring::test {
namespace {

using namespace scenes;

// Something of everything that light depends on.
Scene make_lit_hall() {
  Scene scene = make_cornell_box();
  Image image;
  image.width = image.height = 2;
  for (int i = 0; i < 16; i++) image.texels8.push_back(uint8_t(10 * i));
  Image sky;
  sky.width = sky.height = 1;
  sky.texels = {vec4(1)};
  scene.images = {image, sky, image};
  scene.textures.resize(2);
  scene.textures[0].image = 0;
  scene.textures[1].image = 2;
  scene.materials[1].base_color_texture.texture = 0;
  scene.environment.image = 1;
  scene.lights.push_back(test::point_light({0, 0.3f, 0}, vec3(1)));
  scene.lamps.push_back({"panel", {}, {4}});
  return scene;
}

TEST(HashScene, ChangesWithAllThatLightDependsOn) {
  const std::pair<const char*, std::function<void(Scene&)>> changes[] = {
      {"a vertex", [](Scene& s) { s.meshes[2].positions[1].y += 1e-3f; }},
      {"a normal",
       [](Scene& s) {
         s.meshes[2].normals[1] = {0, 1, 0};
       }},
      {"a texture's place", [](Scene& s) { s.meshes[0].uv[0][0].x += 0.1f; }},
      {"a triangle",
       [](Scene& s) { std::swap(s.meshes[0].triangles[0], s.meshes[0].triangles[1]); }},
      {"where a thing stands", [](Scene& s) { s.instances[6].to_world[3].x += 0.01f; }},
      {"another thing", [](Scene& s) { s.instances.push_back(s.instances[6]); }},
      {"a colour", [](Scene& s) { s.materials[2].base_color.x += 0.01f; }},
      {"roughness", [](Scene& s) { s.materials[2].roughness = 0.5f; }},
      {"gloss", [](Scene& s) { s.materials[2].ior = 1.5f; }},
      {"emission", [](Scene& s) { s.materials[4].emission.x += 1; }},
      {"two sides", [](Scene& s) { s.materials[1].double_sided = true; }},
      {"colours that may change", [](Scene& s) { s.materials[1].repaints = true; }},
      {"transparency", [](Scene& s) { s.materials[1].alpha_mode = AlphaMode::blend; }},
      {"a texel", [](Scene& s) { s.images[0].texels8[7]++; }},
      {"a texel of the sky", [](Scene& s) { s.images[1].texels[0].y = 2; }},
      {"which picture", [](Scene& s) { s.textures[0].image = 2; }},
      {"how a picture repeats", [](Scene& s) { s.textures[0].wrap_u = Wrap::clamp; }},
      {"a light's intensity", [](Scene& s) { s.lights[0].intensity.y = 2; }},
      {"a light's place", [](Scene& s) { s.lights[0].position.y += 0.01f; }},
      {"another light", [](Scene& s) { s.lights.push_back(s.lights[0]); }},
      {"the sky", [](Scene& s) { s.environment.radiance.x = 0.5f; }},
      {"the sun", [](Scene& s) { s.environment.sun.radiance = vec3(3); }},
      {"a lamp",
       [](Scene& s) {
         s.lamps.push_back({"bulb", {0}, {}});
       }},
      {"what a lamp switches", [](Scene& s) { s.lamps[0].lights = {0}; }},
      {"no lamp", [](Scene& s) { s.lamps.clear(); }},
  };
  std::set<uint64_t> found{hash_scene(make_lit_hall())};
  EXPECT_EQ(hash_scene(make_lit_hall()), *found.begin());
  for (const auto& [what, change] : changes) {
    Scene scene = make_lit_hall();
    change(scene);
    EXPECT_TRUE(found.insert(hash_scene(scene)).second) << what;
  }
}

// Figures bring materials, pictures and objects along, but nothing that stands still.
TEST(HashScene, DoesNotChangeWithWhatNoInstanceShows) {
  const uint64_t expected = hash_scene(make_lit_hall());
  Scene scene = make_lit_hall();
  scene.materials.push_back(diffuse(vec3(0.2f)));
  scene.materials.back().base_color_texture.texture = 2;
  scene.textures.push_back({});
  scene.textures.back().image = 3;
  scene.images.push_back(scene.images[0]);
  scene.meshes.push_back(box_mesh(int(scene.materials.size()) - 1, vec3(1)));
  scene.objects.push_back("figure");
  EXPECT_EQ(hash_scene(scene), expected);
  scene.materials.back().base_color.x = 0.7f;
  scene.images[2].texels8[3] = 99;
  scene.viewpoints.emplace_back();
  scene.name = scene.objects[1] = scene.materials[1].name = "other";
  EXPECT_EQ(hash_scene(scene), expected);
}

}  // namespace
}  // namespace wellspring::test
