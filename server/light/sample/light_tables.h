// SPDX-License-Identifier: Apache-2.0
// What make_lights() gathers from a world: the plan of what matters there, and only what that plan
// uses: every emitting triangle in world space with its chance of being picked, punctual lights,
// the environment, and what the shading loop wants to know of each material.
#pragma once
#include <vector>

#include "light/sample/emission_choice.h"
#include "light/sample/emission_picture.h"
#include "light/sample/environment_light.h"
#include "light/sample/few_lights.h"
#include "light/sample/light_tree.h"
#include "light/sample/material_traits.h"
#include "light/sample/pane_boxes.h"
#include "light/sample/solid_bounds.h"
#include "light/transport_plan.h"
#include "world/world.h"

namespace wellspring::world {
struct Surface;
}

namespace wellspring::light {

inline constexpr uint32_t no_emitter = 0xffffffffu;

struct EmitterTriangle {
  uint32_t instance = 0, triangle = 0;
  vec3 corner{0}, edge1{0}, edge2{0};  // world space; p = corner + b1 edge1 + b2 edge2
  vec3 normal{0, 1, 0};                // towards the side that emits light
  float area = 0, extent = 0;
  vec3 emission{0};     // where uniform
  bool uniform = true;  // neither texture nor alpha: emission is the same all over
  bool double_sided = false;
  int picture = -1;  // index into LightTables::pictures where its brightness varies much
};

// Around a part of what scatters sharply; `weight`: about the share of light that it does so with.
struct CasterSphere {
  vec3 center{0};
  float radius = 0, weight = 0;
};

struct LightTables {
  TransportPlan plan;
  std::vector<EmitterTriangle> emitters;  // whole instances, in order of their triangles
  std::vector<float> emitter_power;       // of each of them
  std::vector<EmissionPicture> pictures;
  size_t picture_cells = 0;             // of all of them
  LightTree emitter_choice;             // by power and place
  std::vector<uint32_t> first_emitter;  // of each instance, or no_emitter
  EnvironmentLight environment;
  std::vector<PunctualLight> punctual;   // those of any power
  std::vector<SpotCone> cones;           // of each of them
  std::vector<uint32_t> punctual_index;  // of each of them, in that list where all lamps are full
  FewLights few_punctual;                // all of them, where they are few
  // Where there are many: the near ones (point, spot) by power and place, the distant ones by
  // power.
  LightTree near_choice, distant_choice;
  Bounds bounds;            // of what stands still
  Bounds lit_bounds;        // of what of it reflects light
  float emitter_share = 0;  // of samples spent on emitters; the rest of area light is environment
  float area_share = 1;     // where one light is sampled: emitters and environment against punctual
  EmissionChoice emission;  // of techniques that follow light from its sources
  std::vector<CasterSphere> casters;  // of caustics, that stand still
  std::vector<MaterialTraits> materials;
  bool any_lambertian = false;  // else no sample asks whether it may take the shortest way
  bool any_pane = false;        // else shadow rays only ask whether anything is in between
  PaneBoxes pane_boxes;         // and elsewhere than in these, too
  bool any_solid = false;       // else walks do not ask what they run in
  bool any_tint = false;        // else what they run in takes no light
  SolidBounds solids;
};

// Radiance a hit surface shows towards the ray: its emission, or its base colour where it is unlit.
vec3 surface_emission(const Surface& surface, const Material& material);

}  // namespace wellspring::light
