// SPDX-License-Identifier: Apache-2.0
#include "show/storyteller/portrait.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "light/technique/technique.h"
#include "show/moving/figure.h"
#include "world/view.h"

namespace wellspring::show {
namespace {

Material paint(const char* name, vec3 color, float roughness) {
  Material material;
  material.name = name;
  material.base_color = vec4(color, 1);
  material.metallic = 0;
  material.roughness = roughness;
  return material;
}

void add_instance(Scene& scene, Mesh mesh) {
  scene.instances.push_back({.mesh = int(scene.meshes.size())});
  scene.meshes.push_back(std::move(mesh));
}

// A strip of floor that bends up into a wall behind the figure.
Mesh make_sweep(float size) {
  Mesh mesh;
  mesh.name = "sweep";
  constexpr int bend = 24;
  float radius = 0.8f * size, back = -1.2f * size, half = 12 * size;
  std::vector<std::pair<vec2, vec2>> profile{{{9 * size, 0}, {0, 1}}};  // (z, y), normal
  for (int i = 0; i <= bend; i++) {
    float a = 0.5f * pi * float(i) / bend;
    profile.push_back(
        {{back - radius * std::sin(a), radius * (1 - std::cos(a))}, {std::sin(a), std::cos(a)}});
  }
  profile.push_back({{back - radius, 9 * size}, {1, 0}});
  for (auto [p, n] : profile)
    for (float x : {-half, half}) {
      mesh.positions.push_back({x, p.y, p.x});
      mesh.normals.push_back({0, n.y, n.x});
    }
  for (uint32_t i = 0; i + 1 < profile.size(); i++) {
    uint32_t a = 2 * i;
    mesh.triangles.push_back({a, a + 1, a + 3});
    mesh.triangles.push_back({a, a + 3, a + 2});
  }
  return mesh;
}

// A square that emits light towards `at`.
void add_panel(Scene& scene, vec3 place, vec3 at, float side, vec3 radiance) {
  vec3 n = normalize(at - place), u = normalize(cross(vec3(0, 1, 0), n)), v = cross(n, u);
  Material light = paint("panel", vec3(0), 1);
  light.emission = radiance;
  Mesh mesh;
  mesh.name = "panel";
  mesh.material = int(scene.materials.size());
  scene.materials.push_back(light);
  for (vec2 c : {vec2(-1, -1), vec2(1, -1), vec2(1, 1), vec2(-1, 1)}) {
    mesh.positions.push_back(place + 0.5f * side * (c.x * u + c.y * v));
    mesh.normals.push_back(n);
  }
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  add_instance(scene, std::move(mesh));
}

}  // namespace

Frame render_portrait(const Character& character, const Pose& pose, const PortraitShot& shot,
                      std::vector<std::string>& warnings) {
  SkinScratch scratch;
  std::vector<vec3> positions, normals;
  skin(character, pose, mat4(1), scratch, positions, normals);
  vec3 low(INFINITY), high(-INFINITY);
  for (vec3 p : positions) low = glm::min(low, p), high = glm::max(high, p);
  if (shot.exhibit && shot.held.prop >= 0) {
    const ExhibitProp& prop = shot.exhibit->props[size_t(shot.held.prop)];
    for (const Instance& instance : prop.scene.instances)
      for (vec3 p : prop.scene.meshes[size_t(instance.mesh)].positions) {
        p = vec3(shot.held.to_world * prop.to_fist * instance.to_world * vec4(p, 1));
        low = glm::min(low, p), high = glm::max(high, p);
      }
  }
  if (positions.empty()) low = vec3(-0.5f, 0, -0.5f), high = vec3(0.5f, 1.8f, 0.5f);
  float height = std::max({high.y - low.y, high.x - low.x, 0.05f});

  // The camera circles the figure; the lights keep their place before and behind it as seen from
  // there.
  vec3 centre = 0.5f * (low + high);
  float reach = 0.55f * height, fov = 0.42f;
  int skull = find_joint(character, "skullbase");
  if (shot.close && skull >= 0) {
    centre = vec3(scratch.joints[size_t(skull)] * vec4(character.joints[size_t(skull)].center, 1));
    centre += vec3(0, 0.030f, 0.03f) * (height / 1.7f);
    reach = 0.165f * height / 1.7f;
    fov = 0.30f;
  }
  float aspect = float(shot.width) / float(shot.height);
  float across = 0.55f * (high.x - low.x) / aspect;
  if (!shot.close) reach = std::max(reach, across);
  // The portrait scene stands where the figure is.
  vec3 middle(0.5f * (low.x + high.x), 0, 0.5f * (low.z + high.z));
  auto round = [&](vec3 v) { return glm::angleAxis(shot.turn, vec3(0, 1, 0)) * v; };
  vec3 eye = centre + round(vec3(0, 0.02f * height, reach / std::tan(0.5f * fov)));

  Scene scene;
  scene.objects = {""};
  scene.materials.push_back(paint("sweep", vec3(0.42f, 0.41f, 0.40f), 0.75f));
  Mesh sweep = make_sweep(height);
  for (vec3& p : sweep.positions) p = round(p + vec3(0, low.y, 0)) + middle;
  for (vec3& n : sweep.normals) n = round(n);
  add_instance(scene, std::move(sweep));
  float h = height;
  vec3 chest = middle + vec3(0, low.y + 0.75f * h, 0);
  auto panel = [&](vec3 at, float side, vec3 radiance) {
    add_panel(scene, round(at * h) + middle + vec3(0, low.y, 0), chest, side * h, radiance);
  };
  panel({-1.15f, 1.55f, 1.25f}, 0.8f, vec3(7.5f, 7.1f, 6.6f));  // key
  panel({1.5f, 1.1f, 1.0f}, 1.0f, vec3(1.4f, 1.5f, 1.7f));      // fill
  panel({1.0f, 1.7f, -0.9f}, 0.6f, vec3(6.0f, 6.0f, 6.2f));     // rim
  scene.environment.radiance = vec3(0.22f, 0.23f, 0.25f);

  std::vector<Mesh> moving;
  std::vector<uint32_t> objects;
  Figure figure = make_figure(character, scene, moving, objects);
  std::optional<Prop> prop;
  if (shot.exhibit && shot.held.prop >= 0) {
    prop = make_prop(shot.exhibit->props[size_t(shot.held.prop)], scene, moving, objects);
    DynamicLights lights;
    add_held_lights(*shot.exhibit, shot.held, 0, 0, lights);
    for (const DynamicLight& one : lights) scene.lights.push_back(one.light);
  }
  warnings.insert(warnings.end(), scene.warnings.begin(), scene.warnings.end());
  World world(scene, std::move(moving), std::move(objects));
  pose_figure(world, figure, character, pose, mat4(1), scratch);
  if (prop) pose_prop(world, *prop, pose_of(*shot.exhibit, shot.held, shot.held.prop, 0));
  world.commit();
  Lights lights = make_lights(world);
  View view = make_view_towards(scene, dvec3(eye), dvec3(centre), vec3(0, 1, 0), fov, shot.width,
                                shot.height);
  StillSettings settings;
  settings.spp = shot.spp;
  settings.transport.clamp = 8;
  return render_still(*find_technique("path"), world, lights, view, settings);
}

}  // namespace wellspring::show
