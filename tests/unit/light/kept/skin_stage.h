// SPDX-License-Identifier: Apache-2.0
// Meshes that move, in a scene of nothing else but what is put there before, and the light on them.
#pragma once
#include <algorithm>
#include <memory>
#include <vector>

#include "light/kept/skin/skin_light.h"
#include "scenes/scenes.h"

namespace wellspring::test {

inline constexpr int sphere_rings = 24;

struct SkinStage {
  Scene scene = scenes::empty_scene();
  std::vector<Mesh> moving;
  std::unique_ptr<World> world;
  Lights lights;
  SkinLight skin;
  SkinUpdate update;

  int add_lambert(bool two_sided = false) {
    Material m = scenes::diffuse(vec3(0.5f));
    m.double_sided = two_sided;
    return scenes::add_material(scene, m);
  }
  void begin() {
    scene.objects.push_back("figure");
    world = std::make_unique<World>(
        scene, moving, std::vector<uint32_t>(moving.size(), uint32_t(scene.objects.size() - 1)));
    world->commit();
    lights = make_lights(*world);
    skin = make_skin_light(*world);
  }
  // Does as a show would: some samples and then smoothing, again and again.
  int look(int samples, int times = 1, int cycles = 2) {
    update.samples = samples;
    int traced = 0;
    for (int i = 0; i < times; i++) {
      traced += update_skin(*world, lights, update, skin);
      smooth_skin(*world, skin, cycles);
    }
    return traced;
  }
  View view_from(vec3 eye, vec3 target = vec3(0), int width = 64, int height = 64) const {
    return make_view_towards(scene, dvec3(eye), dvec3(target), {0, 0.1f, 1}, 0.3f, width, height);
  }
  uint32_t place_of(uint32_t vertex, uint32_t mesh = 0) const {
    return skin.front[skin.first_vertex[mesh] + vertex];
  }
  vec3 light_at(uint32_t vertex, uint32_t mesh = 0) const {
    return vec3(skin.light[place_of(vertex, mesh)]);
  }
  vec3 normal_at(uint32_t vertex, uint32_t mesh = 0) const {
    return world->mesh_of(skin.first_instance + mesh).normals[vertex];
  }
  bool is_finite_everywhere() const {
    for (const vec4& light : skin.light)
      if (!is_finite(vec3(light)) || std::min({light.x, light.y, light.z}) < 0) return false;
    return is_finite(skin.mean);
  }
};

inline SkinStage make_sphere_stage(float radius = 0.1f) {
  SkinStage stage;
  stage.moving.push_back(scenes::sphere_mesh(stage.add_lambert(), radius, sphere_rings));
  return stage;
}
inline PunctualLight make_sun(vec3 direction = {0, -1, 0}, float intensity = pi) {
  PunctualLight sun;
  sun.type = PunctualType::directional;
  sun.direction = direction;
  sun.intensity = vec3(intensity);
  return sun;
}

}  // namespace wellspring::test
