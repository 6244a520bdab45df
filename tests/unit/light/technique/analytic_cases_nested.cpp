// SPDX-License-Identifier: Apache-2.0
// Analytic cases of solids in, on and across each other: liquid in glass as people model it.
#include "unit/light/technique/analytic_cases.h"
#include "unit/light/technique/slabs.h"

namespace wellspring::test {

using namespace scenes;

namespace {

constexpr float water_index = 1.33f, glass_index = 1.5f;
constexpr double water_keeps = 0.3, glass_keeps = 0.6;  // share of light, a metre

Layer water(double thickness) { return {double(water_index), std::pow(water_keeps, thickness)}; }
Layer clear(double thickness) { return {double(glass_index), std::pow(glass_keeps, thickness)}; }

struct Parts {
  Scene scene = empty_scene();
  int glass = add_material(scene, tinted_glass(glass_index, glass_keeps));
  int water = add_material(scene, tinted_glass(water_index, water_keeps));
};

// A lamp of radiance 1 behind it all; everything else is dark.
void add_backdrop(Scene& scene) { add_wall(scene, emitter(vec3(1)), -3, 9, "quad"); }

void add_case(std::vector<AnalyticCase>& cases, const std::string& name, Parts parts,
              const std::vector<Layer>& layers) {
  add_backdrop(parts.scene);
  TransportSettings deep{.max_depth = 100};
  // Through the middle, where the triangles of all faces meet, and beside it.
  for (vec2 p : {vec2(0, 0), vec2(0.1f, 0.23f)})
    cases.push_back({"stacked slabs, " + name, parts.scene,
                     ray_towards({p.x, p.y, 3}, {p.x, p.y, 0}), see_through(1, layers).passes,
                     chains | seen_lights, deep, 512});
}

// The eye in the middle of the inner one of `around` and its mirror image.
void add_inner_eye(std::vector<AnalyticCase>& cases, const std::string& name, Parts parts,
                   double index, double kept, const std::vector<Layer>& around) {
  add_backdrop(parts.scene);
  TransportSettings deep{.max_depth = 100};
  Slab side = see_through(index, around);
  double r = side.reflects * kept * kept, t = side.passes * kept;
  cases.push_back({"stacked slabs, eye within: " + name, parts.scene,
                   ray_towards({0.1f, 0.23f, 0}, {0.1f, 0.23f, -1}),
                   t / (1 - r * r) * index * index, chains | seen_lights, deep, 512});
}

}  // namespace

std::vector<AnalyticCase> nested_glass_cases() {
  std::vector<AnalyticCase> cases;
  Layer air;
  {
    Parts p;
    add_slab(p.scene, p.glass, -0.5f, 0.5f);
    add_slab(p.scene, p.water, -0.2f, 0.2f, 1.5f);
    add_case(cases, "water in glass", p, {clear(0.3), water(0.4), clear(0.3), air});
    add_inner_eye(cases, "water in glass", p, double(water_index), water(0.2).kept,
                  {clear(0.3), air});
  }
  {
    Parts p;
    add_slab(p.scene, p.glass, -0.5f, 0.5f);
    add_slab(p.scene, p.water, -0.3f, 0.3f, 1.5f);
    add_slab(p.scene, p.glass, -0.1f, 0.1f, 1);  // the outer material again
    add_case(cases, "glass in water in glass", p,
             {clear(0.2), water(0.2), clear(0.2), water(0.2), clear(0.2), air});
    add_inner_eye(cases, "glass in water in glass", p, double(glass_index), clear(0.1).kept,
                  {water(0.2), clear(0.2), air});
  }
  {
    Parts p;
    add_slab(p.scene, p.glass, 0.2f, 0.5f);
    add_slab(p.scene, p.glass, -0.5f, -0.2f);
    Parts touching = p, overlapping = p;
    add_slab(p.scene, p.water, -0.1f, 0.1f);
    add_case(cases, "water between panes, air gaps", p,
             {clear(0.3), {1, 1}, water(0.2), {1, 1}, clear(0.3), air});
    add_slab(touching.scene, p.water, -0.2f, 0.2f);
    add_case(cases, "water that touches panes", touching,
             {clear(0.3), water(0.4), clear(0.3), air});
    add_inner_eye(cases, "water that touches panes", touching, double(water_index), water(0.2).kept,
                  {clear(0.3), air});
    // To and fro the overlap belongs to the one or the other: without tint that is all the same.
    for (int m : {p.glass, p.water})
      overlapping.scene.materials[size_t(m)].attenuation_distance =
          std::numeric_limits<float>::infinity();
    add_slab(overlapping.scene, p.water, -0.25f, 0.25f);
    Layer pane{double(glass_index), 1}, liquid{double(water_index), 1};
    add_case(cases, "water that reaches into panes", overlapping, {pane, liquid, pane, air});
  }
  {
    Parts p;  // no boundary where blocks of one matter meet, or lie in each other
    add_slab(p.scene, p.glass, 0, 0.5f);
    add_slab(p.scene, p.glass, -0.5f, 0);
    add_slab(p.scene, p.glass, -0.3f, 0.1f, 1);
    add_slab(p.scene, p.glass, -0.3f, 0.1f, 1);
    add_case(cases, "blocks of the same glass", p, {clear(1), air});
  }
  {
    Parts p;  // a block of glass that lies on a lamp, face in face
    add_slab(p.scene, p.glass, -3, -2.5f);
    double r = std::pow((double(glass_index) - 1) / (double(glass_index) + 1), 2);
    add_case(cases, "block on the lamp", p, {});
    for (size_t i = cases.size() - 2; i < cases.size(); i++)
      cases[i].expected = (1 - r) * clear(0.5).kept / std::pow(double(glass_index), 2);
  }
  mark_variants(cases);
  return cases;
}

}  // namespace wellspring::test
