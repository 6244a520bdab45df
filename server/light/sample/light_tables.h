// SPDX-License-Identifier: Apache-2.0
// What make_lights() gathers from a world: the plan of what matters there, and only what that plan
// uses: every emitting triangle in world space with its chance of being picked, punctual lights,
// the environment, and what the shading loop wants to know of each material.
#pragma once
#include <span>
#include <vector>

#include "base/simd.h"
#include "base/vec.h"
#include "light/random/warp.h"
#include "light/sample/environment_light.h"
#include "light/sample/light_tree.h"
#include "light/sample/pane_boxes.h"
#include "light/transport_plan.h"
#include "world/scene.h"
#include "world/world.h"

namespace wellspring::light {

// Which source a ray of light leaves (light/sample/emission.h), chosen by power.

// Sources are numbered: emitting triangles, then punctual lights, then the environment.
struct EmissionChoice {
  AliasTable rays;  // all of them, by power
  AliasTable
      places;  // those that light only a share of a picture's pixels each: see exact_punctual
  AliasTable caustics;         // sources of photons: without a sky that is the same all over
  bool exact_punctual = true;  // few punctual lights: every pixel asks each of them
  vec3 centre{0};              // of a sphere around the scene
  float radius = 1;
};
inline constexpr size_t most_exact_punctual = 4;

// Few punctual lights, side by side as vector units want them: what each does to a place is asked
// of all at once. glTF KHR_lights_punctual.

// A spot light's fall-off: clamp((cosine - outer) * scale), squared.
struct SpotCone {
  float outer = 0, scale = 1;
};
SpotCone make_spot_cone(const PunctualLight& light);

struct FewLights {
  static constexpr int most = 16, groups = most / lane_count;
  // Of a near light its place; of a distant one the direction towards it, and `near` is 0.
  Lanes x[groups], y[groups], z[groups], near[groups];
  Lanes axis_x[groups], axis_y[groups], axis_z[groups];
  Lanes outer[groups], scale[groups];  // all directions are in the cone of what is no spot
  Lanes range2_inverse[groups];        // 0: it reaches everywhere
  Lanes strength[groups];              // luminance; 0 beyond the last light
  bool is_near[most];
  int count = 0;  // 0: there are none, or more than `most`
};
FewLights make_few_lights(std::span<const PunctualLight> lights, std::span<const SpotCone> cones);

// What they do to a surface there, but for shadows; sums over near and distant ones. The floor
// keeps a chance for glossy lobes at grazing angles.
struct LightEffects {
  alignas(Lanes) float effect[FewLights::most];
  float near_sum = 0, distant_sum = 0;
};
// What a surface does with light, as far as the choice among lights asks: a Lambertian part and a
// GGX lobe of reflection. A highlight whose lamp is rarely chosen is a firefly.
struct LobeHint {
  float diffuse = 1, specular = 0;  // reflectances; specular 0: the rest is not set
  vec3 view{0};                     // towards the viewer, unit
  float alpha = 1;                  // squared perceptual roughness, > 0
};
// `through`: light from behind the surface counts too.
void eval_effects(const FewLights& lights, vec3 place, vec3 normal, bool through,
                  const LobeHint& lobe, LightEffects& effects);

}  // namespace wellspring::light

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
