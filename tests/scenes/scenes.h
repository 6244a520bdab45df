// SPDX-License-Identifier: Apache-2.0
// Scenes whose light is known by formula, or that everybody knows by eye. Metres; +Y up.
#pragma once
#include "scenes/build.h"

namespace wellspring::scenes {

// A closed box, 2 m a side about the origin, emission 1, albedo a: radiance is 1 / (1 - a)
// everywhere.
inline Scene make_furnace(float albedo) {
  Scene scene = empty_scene();
  Material m = diffuse(vec3(albedo));
  m.emission = vec3(1);
  add_mesh(scene, box_mesh(add_material(scene, m), vec3(2), true), "furnace");
  return scene;
}

// One object in light of radiance 1 from everywhere: a surface that loses nothing cannot be seen.
inline Scene make_white_furnace(Material material, bool sphere = true) {
  Scene scene = empty_scene();
  int m = add_material(scene, std::move(material));
  if (sphere) add_mesh(scene, sphere_mesh(m, 1, 64), "sphere");
  else add_quad(scene, m, {-10, 0, 10}, {20, 0, 0}, {0, 0, -20}, "plane");
  scene.environment.radiance = vec3(1);
  return scene;
}

// A Lambertian floor in the plane y = 0, 40 m a side, facing up.
inline void add_floor(Scene& scene, float albedo) {
  add_quad(scene, add_material(scene, diffuse(vec3(albedo))), {-20, 0, 20}, {40, 0, 0}, {0, 0, -40},
           "floor");
}

// A rectangle of the given radiance at height 1 over a floor of albedo 0.5, facing down:
// x in [-0.5, 1], z in [-0.5, 0.5].
inline Scene make_plane_with_rect_light(float radiance) {
  Scene scene = empty_scene();
  add_floor(scene, 0.5f);
  add_quad(scene, add_material(scene, emitter(vec3(radiance))), {-0.5f, 1, -0.5f}, {1.5f, 0, 0},
           {0, 0, 1}, "light");
  return scene;
}
// Irradiance there at point p of the floor by Lambert's formula: E = L/2 sum of edge angles times
// the cosine between the edge plane's normal and the floor's.
inline double rect_light_irradiance(dvec3 p, double radiance) {
  dvec3 corner[4] = {{-0.5, 1, -0.5}, {1, 1, -0.5}, {1, 1, 0.5}, {-0.5, 1, 0.5}};
  double sum = 0;
  for (int i = 0; i < 4; i++) {
    dvec3 a = normalize(corner[i] - p), b = normalize(corner[(i + 1) % 4] - p);
    sum += std::acos(glm::clamp(dot(a, b), -1.0, 1.0)) * normalize(cross(a, b)).y;
  }
  return std::abs(sum) * radiance / 2;
}

// A glowing ball over a floor of albedo 0.5.
inline Scene make_lamp_over_floor(vec3 radiance) {
  Scene scene = empty_scene();
  add_floor(scene, 0.5f);
  add_sphere(scene, emitter(radiance), 0.3f, "ball", at({0, 0.8f, 0}));
  return scene;
}

// Balls in a row on a glossy floor under a blue sky, 1 m from one to the next, the first at x.
inline Scene make_row_of_balls(const std::vector<Material>& balls, float x) {
  Scene scene = empty_scene();
  scene.environment.radiance = {0.2f, 0.3f, 0.5f};
  add_quad(scene, plastic({0.6f, 0.5f, 0.4f}, 0.1f), {-3, -1, 3}, {6, 0, 0}, {0, 0, -6}, "floor");
  for (const Material& ball : balls) add_sphere(scene, ball, 0.45f, "ball", at({x++, 0, -1}));
  return scene;
}

inline Scene make_plane_with_punctual(PunctualLight light, float albedo = 0.5f) {
  Scene scene = empty_scene();
  add_floor(scene, albedo);
  scene.lights.push_back(std::move(light));
  return scene;
}

// The Cornell box in metres (Cornell University's measured layout, colours as linear Rec. 709), its
// open side towards +Z: x in [-0.28, 0.28], y in [0, 0.55], z in [-0.56, 0].
inline Scene make_cornell_box() {
  Scene scene = empty_scene();
  int white = add_material(scene, diffuse({0.73f, 0.73f, 0.73f}));
  int red = add_material(scene, diffuse({0.65f, 0.05f, 0.05f}));
  int green = add_material(scene, diffuse({0.12f, 0.45f, 0.15f}));
  int lamp = add_material(scene, emitter({17, 12, 4}));
  const float w = 0.28f, h = 0.55f, d = 0.56f;
  add_quad(scene, white, {-w, 0, 0}, {2 * w, 0, 0}, {0, 0, -d}, "floor");
  add_quad(scene, white, {-w, h, -d}, {2 * w, 0, 0}, {0, 0, d}, "ceiling");
  add_quad(scene, white, {-w, 0, -d}, {2 * w, 0, 0}, {0, h, 0}, "back wall");
  add_quad(scene, red, {-w, 0, 0}, {0, 0, -d}, {0, h, 0}, "left wall");
  add_quad(scene, green, {w, 0, -d}, {0, 0, d}, {0, h, 0}, "right wall");
  add_quad(scene, lamp, {-0.065f, h - 0.001f, -0.33f}, {0.13f, 0, 0}, {0, 0, 0.105f}, "lamp");
  auto block = [&](const char* name, vec3 size, vec3 position, float angle) {
    add_mesh(scene, box_mesh(white, size), name,
             at(position + vec3(0, size.y / 2, 0)) * glm::rotate(mat4(1), angle, vec3(0, 1, 0)));
  };
  block("short block", {0.165f, 0.165f, 0.165f}, {0.093f, 0, -0.169f}, -0.29f);
  block("tall block", {0.165f, 0.33f, 0.165f}, {-0.09f, 0, -0.351f}, 0.29f);
  return scene;
}
inline View cornell_view(const Scene& scene, int width, int height) {
  return make_view_towards(scene, {0, 0.275, 0.8}, {0, 0.275, 0}, {0, 1, 0}, 0.686f, width, height);
}

}  // namespace wellspring::scenes
