// SPDX-License-Identifier: Apache-2.0
#include "visitor_things.h"

#include <cmath>

namespace wellspring::test {

namespace {

int paint(Scene& scene, const char* name, vec3 color, float roughness = 0.9f) {
  Material material;
  material.name = name;
  material.base_color = vec4(color, 1);
  material.metallic = 0;
  material.roughness = roughness;
  material.double_sided = true;
  scene.materials.push_back(material);
  return int(scene.materials.size()) - 1;
}

void add_quad(Mesh& mesh, vec3 at, vec3 u, vec3 v) {
  const uint32_t first = uint32_t(mesh.positions.size());
  for (vec2 c : {vec2(0, 0), vec2(1, 0), vec2(1, 1), vec2(0, 1)}) {
    mesh.positions.push_back(at + c.x * u + c.y * v);
    mesh.normals.push_back(normalize(cross(u, v)));
  }
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

void add_still(Scene& scene, Mesh mesh, int material) {
  mesh.material = material;
  scene.instances.push_back({.mesh = int(scene.meshes.size()), .object = 1});
  scene.meshes.push_back(std::move(mesh));
}

// A surface over (u, v) in 0..1, from a function of them.
template <class Place>
void add_patch(Mesh& mesh, int columns, int rows, const Place& place) {
  const uint32_t first = uint32_t(mesh.positions.size()), row = uint32_t(columns) + 1;
  auto at = [&](float x, float y) { return place(x / float(columns), y / float(rows)); };
  for (int y = 0; y <= rows; y++)
    for (int x = 0; x <= columns; x++) {
      constexpr float h = 0.01f;
      const float fx = float(x), fy = float(y);
      const vec3 n = cross(at(fx + h, fy) - at(fx - h, fy), at(fx, fy + h) - at(fx, fy - h));
      mesh.positions.push_back(at(fx, fy));
      mesh.normals.push_back(dot(n, n) > 0 ? normalize(n) : vec3(0, 0, 1));
    }
  for (uint32_t y = 0; y < uint32_t(rows); y++)
    for (uint32_t x = 0; x < uint32_t(columns); x++) {
      const uint32_t i = first + y * row + x;
      mesh.triangles.push_back({i, i + 1, i + row + 1});
      mesh.triangles.push_back({i, i + row + 1, i + row});
    }
}

// A round bar from a to b, its ends rounded.
void add_bar(Mesh& mesh, vec3 a, vec3 b, float radius) {
  const vec3 along = normalize(b - a);
  const vec3 x = normalize(cross(along, std::abs(along.y) < 0.9f ? vec3(0, 1, 0) : vec3(1, 0, 0)));
  const vec3 y = cross(along, x);
  add_patch(mesh, 12, 12, [&](float u, float v) {
    const float t = glm::clamp(v * 1.4f - 0.2f, 0.f, 1.f), out = 5 * (v * 1.4f - 0.2f - t);
    const float wide = radius * std::sqrt(std::max(0.f, 1 - out * out));
    return glm::mix(a, b, t) + along * (out * radius) +
           wide * (std::cos(2 * pi * u) * x + std::sin(2 * pi * u) * y);
  });
}

Mesh glasses() {
  Mesh mesh;
  constexpr float radius = 0.0022f;
  for (float side : {-1.f, 1.f}) {
    vec3 last(0);
    for (int k = 0; k <= 24; k++) {
      const float a = 2 * pi * float(k) / 24;
      const vec3 p(side * 0.033f + 0.026f * std::cos(a), -0.004f + 0.021f * std::sin(a), 0.016f);
      if (k) add_bar(mesh, last, p, radius);
      last = p;
    }
    add_bar(mesh, {side * 0.059f, 0.004f, 0.015f}, {side * 0.078f, 0.004f, -0.09f}, radius);
  }
  add_bar(mesh, {-0.008f, 0.003f, 0.018f}, {0.008f, 0.003f, 0.018f}, radius);
  return mesh;
}

Mesh hat() {
  Mesh mesh;
  const vec3 middle(0, 0.062f, -0.085f);
  const float widths[] = {0.165f, 0.168f, 0.105f, 0.105f, 0.1f, 0.08f, 0};
  const float heights[] = {-0.006f, 0, 0.004f, 0.05f, 0.09f, 0.108f, 0.112f};
  add_patch(mesh, 40, 6, [&](float u, float v) {
    const float at = glm::clamp(6 * v, 0.f, 5.999f), part = at - std::floor(at);
    const size_t k = size_t(at);
    const float wide = glm::mix(widths[k], widths[k + 1], part);
    return middle + vec3(wide * std::cos(2 * pi * u), glm::mix(heights[k], heights[k + 1], part),
                         1.12f * wide * std::sin(2 * pi * u));
  });
  return mesh;
}

// Half a shell before nose and mouth.
Mesh mask() {
  Mesh mesh;
  add_patch(mesh, 24, 16, [](float u, float v) {
    const float across = 2 * u - 1, up = 2 * v - 1;
    return vec3(0.068f * across, -0.066f + 0.043f * up,
                0.05f - 0.062f * across * across - 0.02f * up * up);
  });
  for (float side : {-1.f, 1.f})
    for (float at : {-0.035f, -0.09f})
      add_bar(mesh, {side * 0.066f, at, -0.02f}, {side * 0.078f, -0.03f, -0.1f}, 0.0015f);
  return mesh;
}

Mesh hand() {
  Mesh mesh;
  const vec3 middle(0, -0.075f, 0.09f);
  add_patch(mesh, 20, 20, [&](float u, float v) {
    const float a = 2 * pi * u, b = pi * v;
    return middle + vec3(0.045f * std::sin(b) * std::cos(a), -0.05f * std::cos(b),
                         0.016f * std::sin(b) * std::sin(a));
  });
  const float lengths[] = {0.065f, 0.078f, 0.072f, 0.055f};
  for (int k = 0; k < 4; k++) {
    const vec3 root = middle + vec3(-0.033f + 0.022f * float(k), 0.035f, 0);
    add_bar(mesh, root, root + vec3(0.004f * float(k - 2), lengths[k], 0), 0.0095f);
  }
  add_bar(mesh, middle + vec3(0.04f, -0.01f, 0), middle + vec3(0.075f, 0.035f, 0), 0.011f);
  add_bar(mesh, middle + vec3(0, -0.05f, 0), middle + vec3(0.02f, -0.25f, 0.02f), 0.029f);
  return mesh;
}

}  // namespace

void add_room(Scene& scene) {
  const int wall = paint(scene, "wall", {0.62f, 0.6f, 0.56f});
  const int floor = paint(scene, "floor", {0.3f, 0.24f, 0.19f});
  const int wood = paint(scene, "wood", {0.2f, 0.13f, 0.08f});
  const int canvas = paint(scene, "canvas", {0.25f, 0.32f, 0.3f});
  Mesh walls, boards, frames, inner;
  add_quad(walls, {-6, -1.6f, 4.5f}, {0, 4, 0}, {12, 0, 0});
  add_quad(boards, {-6, -1.6f, -2}, {0, 0, 6.5f}, {12, 0, 0});
  add_quad(frames, {1, -0.2f, 4.48f}, {0, 1, 0}, {1.3f, 0, 0});
  add_quad(inner, {1.07f, -0.13f, 4.46f}, {0, 0.86f, 0}, {1.16f, 0, 0});
  add_quad(frames, {-6, -1.6f, 4.47f}, {0, 0.14f, 0}, {12, 0, 0});
  add_still(scene, walls, wall);
  add_still(scene, boards, floor);
  add_still(scene, frames, wood);
  add_still(scene, inner, canvas);
}

void add_window(Scene& scene, vec3 radiance) {
  const int light = paint(scene, "window", vec3(0));
  scene.materials[size_t(light)].emission = radiance;
  Mesh panes;
  for (float x : {-1.25f, -0.4f})
    for (float y : {-0.5f, 0.35f}) add_quad(panes, {x, y, 4.495f}, {0, 0.8f, 0}, {0.8f, 0, 0});
  add_still(scene, panes, light);
}

std::vector<Mesh> make_worn(Scene& scene) {
  std::vector<Mesh> all;
  auto add = [&](Mesh mesh, const char* name, int material) {
    mesh.name = name, mesh.material = material;
    all.push_back(std::move(mesh));
  };
  add(glasses(), "glasses", paint(scene, "frame", vec3(0.03f), 0.4f));
  add(hat(), "hat", paint(scene, "felt", {0.05f, 0.045f, 0.04f}));
  add(mask(), "mask", paint(scene, "cloth", {0.55f, 0.68f, 0.75f}));
  add(hand(), "hand", paint(scene, "palm", {0.62f, 0.42f, 0.33f}, 0.6f));
  return all;
}

}  // namespace wellspring::test
