// SPDX-License-Identifier: Apache-2.0
// Analytic cases beyond one reflection: glass, mirrors, and light between rough surfaces.
#include "unit/light/technique/analytic_cases.h"
#include "scenes/lambert.h"
#include "world/mesh_finish.h"

namespace wellspring::test {

using namespace scenes;

namespace {

constexpr double by_pi = 1 / double(pi), gray = 0.5;

Ray at_ground(vec3 p) { return ray_towards(p + vec3(0.3f, 0.5f, 0.8f), p); }

void add_panes(std::vector<AnalyticCase>& cases) {
  TransportSettings two;  // light that the panes mirror back at the floor is left out
  two.max_depth = 2;
  PunctualLight point{.position = {0.5f, 2, 0}, .intensity = vec3(6)};
  for (int count : {1, 3}) {
    Scene scene = make_plane_with_punctual(point);
    Material clear = glass(1.5f, 0, 0);
    clear.base_color = vec4(0.8f, 0.8f, 0.8f, 1);
    int pane = add_material(scene, clear);
    for (int i = 0; i < count; i++)
      add_quad(scene, pane, {-5, 1 + 0.1f * float(i), 5}, {10, 0, 0}, {0, 0, -10}, "pane");
    double c = 2 / std::sqrt(4.25);
    cases.push_back({"point light behind panes: " + std::to_string(count), scene,
                     at_ground({0, 0, 0}),
                     gray * by_pi * 6 * c / 4.25 * std::pow(0.8 * (1 - fresnel(c, 1.5)), count),
                     punctual_light | panes, two});
  }
  Scene scene = make_plane_with_rect_light(10);
  add_quad(scene, glass(1.5f, 0, 0), {-5, 0.7f, 5}, {10, 0, 0}, {0, 0, -10}, "pane");
  double irradiance = 0;  // quadrature over the lamp with each direction's own loss
  constexpr int n = 400;
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      dvec3 q(-0.5 + 1.5 * (i + 0.5) / n, 1, -0.5 + (j + 0.5) / n);
      double d2 = dot(q, q), c = 1 / std::sqrt(d2);
      irradiance += 10 * c * c / d2 * (1 - fresnel(c, 1.5)) * 1.5 / (n * n);
    }
  cases.push_back({"lamp behind a pane", scene, at_ground({0, 0, 0}), irradiance * gray * by_pi,
                   area_light | panes, two, 512});
  // Seen straight through two panes with what lies in front mirrored in them.
  Scene vitrine = empty_scene();
  add_wall(vitrine, glass(1.5f, 0, 0), 0, 5, "quad");
  add_wall(vitrine, emitter(vec3(3)), -4, 9, "quad");
  add_quad(vitrine, emitter(vec3(50)), {-9, 9, 4}, {18, 0, 0}, {0, -18, 0});
  cases.push_back({"a pane's view and mirror image", vitrine, ray_towards({0, 0, 2}, {0, 0, 0}),
                   0.96 * 3 + 0.04 * 50, seen_lights | panes});
}

// A slab of index n seen square on in light of radiance 1: transmitted and reflected series.
void add_slabs(std::vector<AnalyticCase>& cases) {
  for (float index : {1.0f, 1.5f, 2.4f}) {
    Material m = glass(index, 0, 0.5f);
    m.attenuation_color = vec3(0.4f);
    m.attenuation_distance = 0.25f;
    Scene scene = empty_scene();
    add_box(scene, m, {2, 2, 0.5f}, "slab");
    scene.environment.radiance = vec3(1);
    TransportSettings deep{.max_depth = 100};
    double r = std::pow((double(index) - 1) / (double(index) + 1), 2), a = 0.4 * 0.4;
    double through = (1 - r) * (1 - r) * a / (1 - r * r * a * a);
    double back = r + (1 - r) * (1 - r) * r * a * a / (1 - r * r * a * a);
    cases.push_back({"slab that absorbs, index " + std::to_string(index), scene,
                     ray_towards({0.1f, 0.1f, 3}, {0.1f, 0.1f, 0}), through + back, chains, deep,
                     768});  // few samples come back, and bring most of the light
    // The eye is within, half way through: light goes out at this face, or back across the whole
    // slab first. Inside, radiance is denser by the squared index.
    double inside = double(index) * double(index) * (1 - r) * std::sqrt(a) / (1 - r * a);
    cases.push_back({"eye within the slab, index " + std::to_string(index), scene,
                     ray_towards({0.1f, 0.1f, 0}, {0.1f, 0.1f, 1}), inside, chains, deep, 512});
  }
}

void add_mirrors(std::vector<AnalyticCase>& cases) {
  Scene scene = empty_scene();
  int mirror = add_material(scene, metal(vec3(0.9f), 0)),
      lamp = add_material(scene, emitter(vec3(7)));
  add_quad(scene, mirror, {1, -1, 1}, {2, 2, 0}, {0, 0, -2});  // turns +X into +Y
  add_quad(scene, mirror, {1, 5, 1}, {2, -2, 0}, {0, 0, -2});  // turns +Y into -X
  add_quad(scene, lamp, {-3, 3, 1}, {0, 2, 0}, {0, 0, -2});    // faces +X
  for (auto& m : scene.materials) m.double_sided = true;
  double f = 0.9 + 0.1 * std::pow(1 - std::sqrt(0.5), 5);  // Schlick at 45 degrees
  cases.push_back(
      {"two mirrors", scene, ray_towards({-2, 0, 0}, {1, 0, 0}), 7 * f * f, chains | seen_lights});
  // A lamp that faces a perfect mirror overhead: its image lights the floor.
  Scene image = empty_scene();
  add_floor(image, float(gray));
  int perfect = add_material(image, metal(vec3(1), 0)), up = add_material(image, emitter(vec3(9)));
  add_quad(image, perfect, {-30, 2, -30}, {60, 0, 0}, {0, 0, 60}, "mirror");
  add_quad(image, up, {1, 1, 2}, {2, 0, 0}, {0, 0, -4}, "lamp");
  double e =
      polygon_irradiance({0, 0, 0}, {0, 1, 0}, {{1, 3, 2}, {3, 3, 2}, {3, 3, -2}, {1, 3, -2}});
  // Its own back would hide what is nearer or further than this.
  cases.push_back({"a lamp's image in a mirror",
                   image,
                   at_ground({0, 0, 0}),
                   9 * e * gray * by_pi,
                   area_light | caustics,
                   {.max_depth = 3},
                   2560});
}

}  // namespace

std::vector<AnalyticCase> glass_and_mirror_cases() {
  std::vector<AnalyticCase> cases;
  add_panes(cases);
  add_slabs(cases);
  add_mirrors(cases);
  mark_variants(cases);
  return cases;
}

std::vector<AnalyticCase> interreflection_cases() {
  std::vector<AnalyticCase> cases;
  Ray ray = ray_towards({0.1f, 0.2f, -0.3f}, {1, 0.3f, 0.2f});
  for (float a : {0.0f, 0.3f, 0.6f, 0.8f})
    for (bool sphere : {false, true}) {
      if (sphere && a != 0.6f) continue;
      Scene scene = make_furnace(a);
      if (sphere) {
        Mesh mesh = sphere_mesh(scene.meshes[0].material, 1, 12);
        for (uvec3& t : mesh.triangles) std::swap(t.y, t.z);
        make_flat_normals(mesh);  // rounded ones would lose what they send through the facets
        scene.meshes[0] = mesh;
      }
      std::string name =
          (sphere ? "closed sphere of albedo " : "closed box of albedo ") + std::to_string(a);
      TransportSettings settings{.max_depth = 1000};
      cases.push_back({name, scene, ray, 1 / (1 - double(a)), interreflection | area_light,
                       settings,
                       a > 0.7f   ? 3072
                       : a > 0.5f ? 1024
                                  : 256});
      settings.max_depth = 3;
      cases.push_back({name + ", three terms", scene, ray, 1 + double(a) + double(a) * double(a),
                       interreflection | area_light, settings, 256});
      settings.max_depth = 2;
      cases.push_back({name + ", two terms", scene, ray, 1 + double(a), area_light, settings, 256});
    }
  mark_variants(cases);
  return cases;
}

}  // namespace wellspring::test
